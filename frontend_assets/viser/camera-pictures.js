/** @import { Door } from "./door.js" */
/** @import { Live } from "./live.js" */
/** @import { Camera, Message, Object3D, Renderer } from "./viser.d.ts" */

const ROOT = "/live/";
const FRUSTUM = "CameraFrustumMessage";
const FAREST_M = 1e7;
/** A view is drawn so often at most, beside the pictures of the whole scene. */
const EVERY_MS = 33;
/** React makes what a message brings, such as points, a picture or two later. */
const SETTLES_MS = 500;

/**
 * What the studio sends of a camera: see `CameraView` of displays/drawing.py.
 * @typedef {object} CameraView
 * @property {readonly [number, number, number, number, number, number] | null} lens fx, fy, cx, cy as shares of the picture, and where the eye is beside the frame, m
 * @property {"background" | "overlay" | "background and overlay"} rendering
 * @property {number} overlay_alpha
 * @property {number} zoom
 * @property {number} near_m
 * @property {number} far_m
 * @property {readonly string[]} hidden ids of displays, and `robot` and `grid`
 */

/** @typedef {{ width: number, height: number }} Size px */

/**
 * @typedef {object} Sight a view in a panel
 * @property {string} display
 * @property {HTMLCanvasElement} canvas as large as it is to be drawn
 * @property {(seen: boolean) => void} told whether the scene is drawn over the picture
 */

/** One camera: its view, its picture, and whether a message changed it since it was drawn. */
class Shown {
  /** @type {CameraView} */
  view;
  /** @type {ImageBitmap | null} */
  picture = null;
  #number = 0;

  /** @param {CameraView} view */
  constructor(view) {
    this.view = view;
  }

  /** @param {Uint8Array<ArrayBuffer>} jpeg @param {() => void} done */
  async decode(jpeg, done) {
    this.#number += 1;
    const number = this.#number;
    const picture = await pictureOf(jpeg);
    if (!picture || number !== this.#number) return picture?.close(); // a newer one came meanwhile
    this.picture?.close();
    this.picture = picture;
    return done();
  }

  forget() {
    this.#number += 1;
    this.picture?.close();
  }
}

/**
 * The scene as cameras of the robot see it, over their pictures, in panels: rendered by viser's own
 * renderer into a part of its canvas, just before it draws the scene for the eye of the person.
 *
 * It costs nothing while no panel shows one; then a view is drawn when a message came, not when
 * only the eye of the person moved.
 */
export class CameraPictures {
  #door;
  #live;
  /** By display. @type {Map<string, Shown>} */
  #shown = new Map();
  /** @type {Map<Sight, boolean>} whether something changed since it was drawn */
  #sights = new Map();
  /** Frustums in the scene, which would stand before the eye of a camera. @type {Set<string>} */
  #frustums = new Set();
  #drawn_ms = -EVERY_MS;
  #changed_ms = -SETTLES_MS;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #later;

  /** @param {Door} door @param {Pick<Live, "faceEye">} live */
  constructor(door, live) {
    this.#door = door;
    this.#live = live;
    door.onMessage((message) => this.#read(message));
    door.onPicture((renderer) => this.#drawAll(renderer));
  }

  /** Draw what a camera sees onto a canvas from now on. @param {Sight} sight */
  show(sight) {
    this.#sights.set(sight, true);
    this.#door.redraw();
    return {
      /** The canvas has another size, or was emptied. */
      renew: () => {
        if (!this.#sights.has(sight)) return;
        this.#sights.set(sight, true);
        this.#door.redraw();
      },
      leave: () => {
        this.#sights.delete(sight);
      },
    };
  }

  /** @param {Message} message */
  #read(message) {
    const { type, name } = message;
    this.#changed_ms = performance.now();
    for (const sight of this.#sights.keys()) this.#sights.set(sight, true);
    if (!name?.startsWith(ROOT)) return;
    if (type === "RemoveSceneNodeMessage") this.#forget(name);
    const values = message.props ?? message.updates;
    if (type === FRUSTUM) this.#frustums.add(name);
    if (values?.studio_camera) this.#take(name, values);
  }

  /** @param {string} name */
  #forget(name) {
    this.#frustums.delete(name);
    const display = displayOf(name);
    if (name !== nodeOf(display)) return;
    this.#shown.get(display)?.forget();
    this.#shown.delete(display);
  }

  /** The picture is taken out of the message: viser would make a texture of it. @param {string} name @param {Record<string, unknown>} values */
  #take(name, values) {
    const display = displayOf(name);
    const view = /** @type {CameraView} */ (values.studio_camera);
    const shown = this.#shown.get(display) ?? new Shown(view);
    shown.view = view;
    this.#shown.set(display, shown);
    const jpeg = /** @type {Uint8Array<ArrayBuffer> | null | undefined} */ (values._image_data);
    if (!jpeg) return;
    values._image_data = null;
    // Copied: the buffer is shared with all that came in one frame.
    shown.decode(new Uint8Array(jpeg), () => this.#renew(display));
  }

  /** @param {string} display */
  #renew(display) {
    for (const sight of this.#sights.keys())
      if (sight.display === display) {
        this.#sights.set(sight, true);
        this.#door.redraw();
      }
  }

  /** @param {Renderer} renderer */
  #drawAll(renderer) {
    if (this.#sights.size === 0) return;
    const now_ms = performance.now();
    const isSettling = now_ms - this.#changed_ms < SETTLES_MS;
    const waiting = [...this.#sights]
      .filter(([, isDue]) => isDue || isSettling)
      .map(([sight]) => sight);
    if (waiting.length === 0) return;
    const left_ms = this.#drawn_ms + EVERY_MS - now_ms;
    if (left_ms > 0) {
      // What only settles is drawn with a picture of the scene that comes by itself, or not at all.
      if ([...this.#sights.values()].includes(true))
        this.#later ??= setTimeout(() => this.#drawLater(), left_ms);
      return;
    }
    this.#drawn_ms = now_ms;
    for (const sight of waiting) {
      this.#sights.set(sight, false);
      this.#draw(renderer, sight);
    }
  }

  #drawLater() {
    this.#later = undefined;
    this.#door.redraw();
  }

  /** @param {Renderer} renderer @param {Sight} sight */
  #draw(renderer, { display, canvas, told }) {
    const paint = canvas.getContext("2d");
    if (!paint) return;
    paint.clearRect(0, 0, canvas.width, canvas.height);
    const shown = this.#shown.get(display);
    const picture = shown?.picture;
    if (!shown || !picture) return told(false);
    const { view } = shown;
    const place = placeOfPicture(view, picture, canvas);
    /** @param {number} alpha */
    const paste = (alpha) => {
      paint.globalAlpha = alpha;
      paint.drawImage(picture, place.x, place.y, place.width, place.height);
      paint.globalAlpha = 1;
    };
    const frame = this.#frameOf(display);
    const seen = view.lens !== null && frame !== null;
    if (view.rendering !== "overlay" || !seen) paste(1);
    if (seen) {
      this.#renderScene(renderer, view, frame, picture, canvas, paint);
      if (view.rendering !== "background") paste(view.overlay_alpha);
    }
    return told(seen);
  }

  /** Where the camera is; null: it has no place in the scene. @param {string} display @returns {Object3D | null} */
  #frameOf(display) {
    const group = this.#door.node(`${ROOT}${display}/camera`);
    const root = this.#door.node(`${ROOT}${display}`);
    return group?.visible && root?.visible ? group : null;
  }

  /**
   * @param {Renderer} renderer @param {CameraView} view @param {Object3D} frame
   * @param {Size} picture @param {HTMLCanvasElement} canvas @param {CanvasRenderingContext2D} paint
   */
  #renderScene(renderer, view, frame, picture, canvas, paint) {
    const { canvas: whole, scene, camera: eye } = this.#door.mutable ?? {};
    if (!whole || !scene || !eye) return;
    const ratio = renderer.getPixelRatio();
    const share = Math.min(1, whole.width / canvas.width, whole.height / canvas.height);
    const [width, height] = [Math.floor(canvas.width * share), Math.floor(canvas.height * share)];
    const camera = /** @type {Camera} */ (eye.clone(false));
    aim(camera, view, frame);
    project(camera, view, picture, canvas, renderer.capabilities.reversedDepthBuffer);
    const size = { focal: camera.projectionMatrix.elements[5] ?? 1, height };
    const restore = this.#prepare(view, size, whole, scene, eye);
    const turnBack = this.#live.faceEye(camera, canvas.height / ratio);
    const { onBeforeRender, onAfterRender } = scene;
    const before = { x: 0, y: 0, z: 0, w: 0 };
    renderer.getViewport({
      copy: (of) => Object.assign(before, { x: of.x, y: of.y, z: of.z, w: of.w }),
    });
    const shadows = renderer.shadowMap.autoUpdate;
    try {
      Object.assign(scene, { onBeforeRender: nothing, onAfterRender: nothing });
      renderer.shadowMap.autoUpdate = false;
      renderer.setViewport(0, 0, width / ratio, height / ratio);
      renderer.render(scene, camera);
      const top = whole.height - height;
      paint.drawImage(whole, 0, top, width, height, 0, 0, canvas.width, canvas.height);
    } finally {
      Object.assign(scene, { onBeforeRender, onAfterRender });
      renderer.shadowMap.autoUpdate = shadows;
      renderer.setViewport(before.x, before.y, before.z, before.w);
      turnBack();
      restore();
    }
  }

  /**
   * Hide what is not to be seen, and have points and names as large as this lens shows them.
   * @param {CameraView} view @param {{ focal: number, height: number }} size of this view: element 5 of its projection, and px
   * @param {HTMLCanvasElement} whole @param {Object3D} scene @param {Camera} eye
   */
  #prepare(view, { focal, height }, whole, scene, eye) {
    const names = view.hidden.map((one) => (one === "robot" || one === "grid" ? `/${one}` : `${ROOT}${one}`));
    const hidden = [...names, ...this.#frustums]
      .map((name) => this.#door.node(name))
      .filter((node) => node?.visible);
    for (const node of hidden) if (node) node.visible = false;
    // By its angle: a view without perspective has another matrix.
    const factor = (focal * height * Math.tan((eye.fov * Math.PI) / 360)) / whole.height;
    /** As they were; those of names are shared. @type {Map<{ value: unknown }, unknown>} */
    const before = new Map();
    /** @param {{ value: unknown } | undefined} uniform @param {(value: number) => number} changed */
    const change = (uniform, changed) => {
      if (!uniform || before.has(uniform)) return;
      before.set(uniform, uniform.value);
      uniform.value = changed(Number(uniform.value));
    };
    scene.traverse(({ isPoints, material }) => {
      const uniforms = Array.isArray(material) ? null : material?.uniforms;
      if (!uniforms) return;
      if (isPoints) change(uniforms.scale, (scale) => scale * factor);
      change(uniforms.uFovScale, () => 1 / focal);
      change(uniforms.uIsOrtho, () => 0);
      change(uniforms.uViewportHeight, (all) => (all * height) / whole.height);
    });
    return () => {
      for (const node of hidden) if (node) node.visible = true;
      for (const [uniform, value] of before) uniform.value = value;
    };
  }
}

const nothing = () => undefined;

/** @param {Uint8Array<ArrayBuffer>} jpeg @returns {Promise<ImageBitmap | null>} null: it is none */
async function pictureOf(jpeg) {
  try {
    return await createImageBitmap(new Blob([jpeg], { type: "image/jpeg" }));
  } catch {
    return null;
  }
}

/** @param {string} name of a node @returns {string} the display that it belongs to */
const displayOf = (name) => decodeURIComponent(name.slice(ROOT.length).split("/")[0] ?? "");

/** @param {string} display */
const nodeOf = (display) => `${ROOT}${display}/camera/view.camera`;

/**
 * A camera of three.js looks along -z with y up, that of a robot along z with y down.
 * @param {Camera} camera @param {CameraView} view @param {Object3D} frame
 */
function aim(camera, view, frame) {
  const [, , , , x_m, y_m] = view.lens ?? [0, 0, 0, 0, 0, 0];
  frame.updateWorldMatrix(true, false);
  camera.position.set(x_m, y_m, 0).applyMatrix4(frame.matrixWorld);
  const half = camera.quaternion.clone().set(1, 0, 0, 0);
  frame.getWorldQuaternion(camera.quaternion).multiply(half);
  camera.updateMatrix();
}

/**
 * @param {Camera} camera its projection is replaced, and stays: three.js would work out its own as
 *   soon as it notices that depths are reversed
 * @param {CameraView} view @param {Size} picture @param {Size} canvas @param {boolean} isReversed near is 1 and far is 0
 */
function project(camera, view, picture, canvas, isReversed) {
  const [x, y, left, up] = projectionOf(view, picture, canvas);
  const [scale, shift] = depthsOf(view.near_m, Math.min(view.far_m, FAREST_M), isReversed);
  const { elements } = camera.projectionMatrix;
  elements.fill(0);
  Object.assign(elements, { 0: x, 5: y, 8: left, 9: up, 10: scale, 11: -1, 14: shift });
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.updateProjectionMatrix = nothing;
}

/**
 * The two numbers of a projection that make depths of distances, elements 10 and 14.
 * @param {number} near @param {number} far m @param {boolean} isReversed @returns {[number, number]}
 */
export function depthsOf(near, far, isReversed) {
  const span = far - near;
  return isReversed ? [near / span, (far * near) / span] : [-(far + near) / span, (-2 * far * near) / span];
}

/**
 * The four numbers of a projection that a pinhole gives, as RViz has them.
 * @param {CameraView} view @param {Size} picture @param {Size} canvas
 * @returns {[number, number, number, number]} elements 0, 5, 8 and 9 of the matrix
 */
export function projectionOf(view, picture, canvas) {
  const [fx, fy, cx, cy] = view.lens ?? [1, 1, 0.5, 0.5];
  const zoom = zoomOf(view, picture, canvas);
  return [2 * fx * zoom.x, 2 * fy * zoom.y, (1 - 2 * cx) * zoom.x, (2 * cy - 1) * zoom.y];
}

/** How much of the canvas the picture fills along x and y. @param {CameraView} view @param {Size} picture @param {Size} canvas */
function zoomOf({ lens, zoom }, picture, canvas) {
  const aspect = lens ? lens[1] / lens[0] : picture.width / picture.height;
  const room = canvas.width / canvas.height;
  return aspect > room ? { x: zoom, y: (zoom / aspect) * room } : { x: (zoom / room) * aspect, y: zoom };
}

/** Where the picture lies on the canvas, px. @param {CameraView} view @param {Size} picture @param {Size} canvas */
export function placeOfPicture(view, picture, canvas) {
  const zoom = zoomOf(view, picture, canvas);
  const [width, height] = [canvas.width * zoom.x, canvas.height * zoom.y];
  return { x: (canvas.width - width) / 2, y: (canvas.height - height) / 2, width, height };
}
