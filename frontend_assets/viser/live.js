/** @import { Door } from "./door.js" */
/** @import { Camera, Material, Message, Object3D } from "./viser.d.ts" */

import { depthOf, pixelAt } from "./orthographic.js";

const ROOT = "/live/";
const NEAREST = 1003;
const CUSTOM_BLENDING = 5;
const ONE = 201;
const ONE_MINUS_ALPHA = 205;
/** Words of constant size on the screen. */
const SCREEN_FONT_PX = 14;
/** More words in colours than this are left to viser, which writes them black on white. */
const TEXTS_MAX = 500;
const BEFORE_ALL = -10;
const OVER_ALL = 9;

const VISER_POINT = "vec4(col, 1.0)";
const OUR_POINT = "vec4(col, studioOpacity)";
const VISER_POINT_SIZE = "(scale / -world_pos.z)";
const OUR_POINT_SIZE =
  "(studioPixels > 0.0 ? studioPixels : max(scale * (studioByZ > 0.0 ? abs(position.z) : 1.0) / gl_Position.w, studioLeastPixels))";
/** Of points with a size in metres: from afar they would be too small to be seen. */
const LEAST_POINT_PX = 3;

/**
 * How a node of a display is to look, beyond what viser knows.
 * @typedef {object} Look
 * @property {string} kind the type of the message that made the node
 * @property {number} opacity
 * @property {boolean} sharp pixels of a picture are squares
 * @property {boolean} behind drawn before all else
 * @property {"screen" | "scene" | null} words in colour, and what their size is measured in
 * @property {number} point_px size of points on the screen; 0: they have one in the scene
 * @property {boolean} by_z the size of a point is for each metre of its z
 */

/**
 * What viser lacks for the displays' shapes, in one place: see-through points, lines, arrows, axes and
 * meshes, sharp pixels, pictures behind everything, and words in colours.
 *
 * viser makes materials anew as it likes, so each picture begins with a look at those of our nodes.
 */
export class Live {
  /** By node. @type {Map<string, Look>} */
  #looks = new Map();
  /** Nodes of points. @type {Set<string>} */
  #clouds = new Set();
  /** By what makes two of them different programs. @type {Map<string, Material>} */
  #kept = new Map();
  #texts = 0;
  /** As viser made it. @type {WeakMap<Material, { opacity: number, transparent: boolean, depthWrite: boolean }>} */
  #made = new WeakMap();
  #door;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage((message) => this.#read(message));
    door.onPicture(() => this.#finishAll());
  }

  /** @param {Message} message */
  #read(message) {
    const { name, props, updates } = message;
    if (!name?.startsWith(ROOT)) return;
    if (message.type === "RemoveSceneNodeMessage") this.#forget(name);
    else if (props) this.#begin(message, name, props);
    else if (updates) this.#change(message, name, updates);
  }

  /** @param {string} name */
  #forget(name) {
    if (this.#looks.get(name)?.words) this.#texts -= 1;
    this.#looks.delete(name);
    this.#clouds.delete(name);
  }

  /** @param {Message} message @param {string} name @param {Record<string, unknown>} props */
  #begin(message, name, props) {
    this.#forget(name);
    if (message.type === "PointCloudMessage") this.#clouds.add(name);
    const look = lookOf(message.type, props);
    if (look.words && this.#texts >= TEXTS_MAX) return;
    if (look.words) this.#write(message, props);
    if (isPlain(look)) return;
    if (look.words) this.#texts += 1;
    this.#looks.set(name, look);
  }

  /** @param {Message} message @param {string} name @param {Record<string, unknown>} updates */
  #change(message, name, updates) {
    const old = this.#looks.get(name);
    const look = lookOf(old?.kind ?? "", updates);
    if (old?.words) message.updates = pictureOf(updates);
    // One that became plain is kept: its materials must become as viser made them.
    if (old) this.#looks.set(name, { ...look, words: old.words && look.words });
    else if (!look.words && !isPlain(look)) this.#looks.set(name, { ...look, kind: kindOf(name) });
  }

  /** Words in a colour become a picture that faces the eye. @param {Message} message @param {Record<string, unknown>} props */
  #write(message, props) {
    const written = { type: "ImageMessage", props: pictureOf(props) };
    // What was there before us is not changed under viser's hands.
    if (messageOf(message.name ?? "") === message) this.#door.inject({ ...message, ...written });
    else Object.assign(message, written);
  }

  #finishAll() {
    const { camera, height } = this.#eye();
    for (const [name, look] of this.#looks) {
      const node = this.#door.node(name);
      if (!node) continue;
      if (look.words && camera) this.#turnToEye(node, camera, look.words, height);
      node.traverse((object) => {
        for (const material of [object.material ?? []].flat()) this.#finish(object, material, look);
      });
    }
    for (const name of this.#clouds)
      this.#door.node(name)?.traverse((object) => {
        this.#dressCloud(object, this.#looks.get(name) ?? PLAIN);
        this.#keepProgram(object);
      });
  }

  /** @param {Object3D} object @param {Look} look */
  #dressCloud({ isPoints, material }, look) {
    if (!isPoints || !material || Array.isArray(material)) return;
    dressPoints(material, look, this.#pixelRatio());
  }

  /**
   * viser makes the material of a cloud anew with each message. The one before was the last that used
   * its program, which would be thrown away and compiled again, ten times a second: one stays.
   * @param {Object3D} object
   */
  #keepProgram({ isPoints, material }) {
    if (!isPoints || !material || Array.isArray(material)) return;
    const { vertexColors, transparent, fragmentShader } = material;
    const variant = `${vertexColors} ${transparent} ${fragmentShader.length}`;
    if (this.#kept.has(variant)) return;
    this.#kept.set(variant, material);
    material.dispose = () => undefined;
  }

  /** @param {Object3D} object @param {Material} material @param {Look} look */
  #finish(object, material, look) {
    if (object.isPoints) return; // see #dressCloud
    if (material.isLineMaterial) {
      if (look.kind !== "CameraFrustumMessage") fadeLines(object, material, look.opacity);
    } else {
      this.#fade(material, look);
      if (look.sharp) sharpen(material);
      if (look.behind) putBehind(object, material);
      if (look.words === "screen") putOver(object, material);
    }
  }

  /** @param {Material} material @param {Look} look */
  #fade(material, { opacity, behind, words }) {
    let made = this.#made.get(material);
    if (!made) {
      const { transparent, depthWrite } = material;
      made = { opacity: material.opacity, transparent, depthWrite };
      this.#made.set(material, made);
    }
    material.opacity = made.opacity * opacity;
    // What is transparent is drawn after all that is not, whatever its order: not if it is behind.
    setTransparent(material, !behind && (made.transparent || opacity < 1));
    material.depthWrite = made.depthWrite && opacity >= 1 && !behind && !words;
  }

  #eye() {
    const { camera, canvas } = this.#door.mutable ?? {};
    return { camera, height: canvas?.clientHeight ?? 1 };
  }

  /**
   * Have words face another eye.
   * @param {Camera} camera @param {number} height of its picture, px of the page
   * @returns {() => void} back to that of the person
   */
  faceEye(camera, height) {
    this.#turnWords(camera, height);
    const eye = this.#eye();
    return () => eye.camera && this.#turnWords(eye.camera, eye.height);
  }

  /** @param {Camera} camera @param {number} height */
  #turnWords(camera, height) {
    for (const [name, { words }] of this.#looks) {
      const node = words && this.#door.node(name);
      if (node) this.#turnToEye(node, camera, words, height);
    }
  }

  /** @param {Object3D} node @param {Camera} camera @param {"screen" | "scene"} size @param {number} height */
  #turnToEye(node, camera, size, height) {
    const eye = camera.getWorldQuaternion(node.quaternion.clone());
    const parent = node.parent?.getWorldQuaternion(node.quaternion.clone()) ?? eye.clone();
    // A picture of viser's lies on its face: half a turn about x.
    const half = node.quaternion.clone().set(1, 0, 0, 0);
    node.quaternion.copy(parent.invert()).multiply(eye).multiply(half);
    if (size === "screen") node.scale.set(1, 1, 1).multiplyScalar(pixelOf(node, camera, height));
    node.updateMatrix();
    node.updateWorldMatrix(false, true);
  }

  /** How many pixels of the picture one of the page is wide. */
  #pixelRatio() {
    const canvas = this.#door.mutable?.canvas;
    return canvas?.clientWidth ? canvas.width / canvas.clientWidth : 1;
  }
}

/** How large a pixel is at a node, m. @param {Object3D} node @param {Camera} camera @param {number} height of the picture, px */
function pixelOf(node, camera, height) {
  const place = node.position.clone().setFromMatrixPosition(node.matrixWorld);
  return pixelAt(camera, Math.max(depthOf(camera, place), camera.near), height);
}

/** As viser makes it. @type {Readonly<Look>} */
const PLAIN = { kind: "", opacity: 1, sharp: false, behind: false, words: null, point_px: 0, by_z: false };

/** @param {string} kind @param {Record<string, unknown>} props @returns {Look} */
export function lookOf(kind, props) {
  const { studio_opacity: opacity, studio_rgb: rgb, studio_point_px: px } = props;
  return {
    kind,
    opacity: typeof opacity === "number" ? Math.min(Math.max(opacity, 0), 1) : 1,
    sharp: props.studio_sharp === true,
    behind: props.studio_behind === true,
    words: Array.isArray(rgb) ? (props.font_size_mode === "screen" ? "screen" : "scene") : null,
    point_px: typeof px === "number" ? px : 0,
    by_z: props.studio_size_by_z === true,
  };
}

/** @param {Look} look */
export const isPlain = ({ opacity, sharp, behind, words, point_px: px, by_z: byZ }) =>
  opacity >= 1 && !sharp && !behind && !words && px <= 0 && !byZ;

/** @param {string} name @returns {Message | undefined} */
const messageOf = (name) => window.__viserSceneTree?.getState()[name]?.message;

/** @param {string} name */
const kindOf = (name) => messageOf(name)?.type ?? "";

/** Properties of a picture of words, from those of a label. @param {Record<string, unknown>} props */
function pictureOf(props) {
  const { text, studio_rgb: rgb, font_size_mode: mode, font_scene_height: height } = props;
  const picture = textPicture(String(text), /** @type {number[]} */ (rgb));
  const unit = (mode === "screen" ? SCREEN_FONT_PX : Number(height)) / FONT_PX;
  return {
    ...props,
    ...{ _format: "png", _data: picture.data, scale: 1, cast_shadow: false, receive_shadow: false },
    ...{ render_width: picture.width * unit, render_height: picture.height * unit },
  };
}

/** @param {Material} material @param {Look} look @param {number} ratio of the picture's pixels to the page's */
function dressPoints(material, { opacity, point_px: px, by_z: byZ }, ratio) {
  const { uniforms } = material;
  if (!uniforms.studioOpacity) {
    const [points, sizes] = [material.fragmentShader, material.vertexShader];
    material.fragmentShader = `uniform float studioOpacity;\n${points.replace(VISER_POINT, OUR_POINT)}`;
    material.vertexShader = `uniform float studioPixels;\nuniform float studioLeastPixels;\nuniform float studioByZ;\n${sizes.replace(VISER_POINT_SIZE, OUR_POINT_SIZE)}`;
    material.needsUpdate = true;
  }
  uniforms.studioOpacity = { value: opacity };
  uniforms.studioPixels = { value: px * ratio };
  uniforms.studioByZ = { value: byZ ? 1 : 0 };
  uniforms.studioLeastPixels = { value: LEAST_POINT_PX * ratio };
  setTransparent(material, opacity < 1);
  material.depthWrite = opacity >= 1;
}

/**
 * viser draws a line twice, hard and with a soft edge: see-through, the soft one is the whole line.
 * @param {Object3D} object @param {Material} material @param {number} opacity
 */
function fadeLines(object, material, opacity) {
  const isSoft = material.defines?.VISER_LINE_FRINGE !== undefined;
  if (material.worldUnits && !isSoft) object.visible = opacity >= 1;
  material.opacity = opacity;
  setTransparent(material, isSoft || opacity < 1);
  material.depthWrite = !isSoft && opacity >= 1;
}

/** @param {Material} material @param {boolean} transparent */
function setTransparent(material, transparent) {
  if (material.transparent === transparent) return;
  material.transparent = transparent;
  material.needsUpdate = true;
}

/** Once for each picture that came: a material that had none is made anew with it. @param {Material} material */
function sharpen(material) {
  const { map } = material;
  if (!map || map.magFilter === NEAREST) return;
  map.magFilter = NEAREST;
  map.needsUpdate = true;
  material.needsUpdate = true;
}

/** First of all, but blended. @param {Object3D} object @param {Material} material */
function putBehind(object, material) {
  object.renderOrder = BEFORE_ALL;
  const blended = { blending: CUSTOM_BLENDING, blendSrcAlpha: ONE, blendDstAlpha: ONE_MINUS_ALPHA };
  Object.assign(material, blended);
}

/** @param {Object3D} object @param {Material} material */
function putOver(object, material) {
  material.depthTest = false;
  object.renderOrder = OVER_ALL;
}

/** Of the letters in the picture: enough for words that fill a third of the window. */
const FONT_PX = 48;
const FONT = `600 ${FONT_PX}px system-ui, sans-serif`;
const LINE = 1.25;
const MARGIN_PX = 6;
const OUTLINE_PX = 5;
const WIDEST_PX = 4096;
const LINES_MAX = 12;
const KEPT = 200;

/** @typedef {{ data: Uint8Array, width: number, height: number }} Written a PNG and its size in pixels */

/** @type {Map<string, Written>} */
const kept = new Map();

/** Words in a colour on nothing, with an edge that sets them off. @param {string} text @param {readonly number[]} rgb 0 to 255 @returns {Written} */
function textPicture(text, rgb) {
  const key = `${rgb.join()} ${text}`;
  const found = kept.get(key) ?? write(text, rgb);
  kept.delete(key);
  kept.set(key, found);
  for (const oldest of kept.keys()) {
    if (kept.size <= KEPT) break;
    kept.delete(oldest);
  }
  return found;
}

/** @param {string} text @param {readonly number[]} rgb @returns {Written} */
function write(text, rgb) {
  const lines = text.split("\n").slice(0, LINES_MAX);
  const canvas = document.createElement("canvas");
  const paint = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  paint.font = FONT;
  const wanted = Math.max(...lines.map((line) => paint.measureText(line).width)) + 2 * MARGIN_PX;
  canvas.width = Math.ceil(Math.min(Math.max(wanted, 1), WIDEST_PX));
  canvas.height = Math.ceil(lines.length * LINE * FONT_PX + 2 * MARGIN_PX);
  Object.assign(paint, { font: FONT, textAlign: "center", textBaseline: "middle" });
  Object.assign(paint, { lineJoin: "round", lineWidth: OUTLINE_PX });
  paint.fillStyle = `rgb(${rgb.join(" ")})`;
  paint.strokeStyle = edgeOf(rgb);
  lines.forEach((line, at) => {
    const y = MARGIN_PX + (at + 0.5) * LINE * FONT_PX;
    paint.strokeText(line, canvas.width / 2, y, canvas.width - 2 * MARGIN_PX);
    paint.fillText(line, canvas.width / 2, y, canvas.width - 2 * MARGIN_PX);
  });
  return { data: bytesOf(canvas), width: canvas.width, height: canvas.height };
}

/** Dark around bright letters and bright around dark ones. @param {readonly number[]} rgb */
export function edgeOf([red = 0, green = 0, blue = 0]) {
  const brightness = (0.2126 * red + 0.7152 * green + 0.0722 * blue) / 255;
  return brightness > 0.4 ? "rgb(0 0 0 / 55%)" : "rgb(255 255 255 / 65%)";
}

/** @param {HTMLCanvasElement} canvas */
function bytesOf(canvas) {
  const encoded = canvas.toDataURL("image/png").split(",")[1] ?? "";
  return Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
}
