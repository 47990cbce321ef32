/** @import { Door } from "./door.js" */
/** @import { Theme } from "./theme.js" */
/** @import { Camera, Color, Material, Object3D, Shader } from "./viser.d.ts" */
/** @import { RobotView } from "./robot.js" */

import { nearestOf } from "./orthographic.js";
import { RobotView } from "./robot.js";

const HOVER = { tint: 0.3, glow: 0.2 };
const CHANGED = { tint: 0.5, glow: 0.35 };
const MOVED = { tint: 0.22, glow: 0.14 };
const NONE = { tint: 0, glow: 0 };
/** How much faster than the accent comes the own hue goes. */
const PALER = 1.5;

/**
 * What this browser alone sees differently: links hidden, see-through, hovered, outlined or lit.
 * Materials are exchanged for the time of one picture, so that nothing that viser or the server
 * does in between can be in the way, and no reload can lose it.
 */
export class Looks {
  /** @type {string | null} */
  hovered = null;
  /** @type {Map<string, number>} */
  #opacity = new Map();
  /** Links that a property shapes, and how much they light up. @type {Map<string, typeof NONE>} */
  #lit = new Map();
  /** @type {Set<string>} */
  #hidden = new Set();
  /** @type {WeakMap<Material, Material>} */
  #twins = new WeakMap();
  /** @type {[Object3D, Material | Material[]][]} */
  #exchanged = [];
  #door;
  #robot;
  #theme;
  #outline;

  /** @param {Door} door @param {RobotView} robot @param {Theme} theme */
  constructor(door, robot, theme) {
    this.#door = door;
    this.#robot = robot;
    this.#theme = theme;
    this.#outline = new Outline(door, robot, theme);
    door.onMessage((message) => this.#hideAnew(message));
    door.onPicture(
      () => this.#dress(),
      () => this.#undress(),
    );
  }

  /** @param {string} link @param {boolean} visible */
  setVisible(link, visible) {
    if (visible) this.#hidden.delete(link);
    else this.#hidden.add(link);
    this.#door.inject(visibility(link, visible));
  }

  /** @param {string} link @param {number} opacity */
  setOpacity(link, opacity) {
    if (opacity >= 1) this.#opacity.delete(link);
    else this.#opacity.set(link, Math.max(0, opacity));
    this.#door.redraw();
  }

  /** @param {string | null} link */
  setHovered(link) {
    if (link === this.hovered) return;
    this.hovered = link;
    this.#door.redraw();
  }

  /** @param {string | null} link */
  setSelected(link) {
    if (link === this.#outline.link) return;
    this.#outline.link = link;
    this.#door.redraw();
  }

  /** @param {readonly string[]} changed @param {readonly string[]} moved */
  setLit(changed, moved) {
    if (this.#lit.size + changed.length + moved.length === 0) return;
    this.#lit = new Map(moved.map((link) => [link, MOVED]));
    for (const link of changed) this.#lit.set(link, CHANGED);
    this.#door.redraw();
  }

  /** A link that was made anew comes visible. @param {import("./viser.d.ts").Message} message */
  #hideAnew(message) {
    if (message.type !== "FrameMessage" || this.#hidden.size === 0) return;
    for (const link of this.#hidden) {
      if (message.name !== RobotView.nodeName(link)) continue;
      // After what the server says of it in this same batch.
      queueMicrotask(() => this.#door.inject(visibility(link, false)));
    }
  }

  #dress() {
    const links = this.#robot.opacity < 1 ? this.#robot.drawn : new Set([...this.#opacity.keys()]);
    for (const link of links) this.#dressLink(link);
    for (const link of new Set([this.hovered, ...this.#lit.keys()]))
      if (link && !links.has(link)) this.#dressLink(link);
  }

  /** @param {string} link */
  #dressLink(link) {
    const opacity = this.#robot.opacity * (this.#opacity.get(link) ?? 1);
    const shine = this.#shineOf(link);
    this.#robot.eachMesh(link, (mesh) => {
      if (!mesh.material) return;
      this.#exchanged.push([mesh, mesh.material]);
      mesh.material = Array.isArray(mesh.material)
        ? mesh.material.map((material) => this.#twin(material, opacity, shine))
        : this.#twin(mesh.material, opacity, shine);
    });
  }

  /** @param {string} link */
  #shineOf(link) {
    const lit = this.#lit.get(link) ?? NONE;
    return link === this.hovered && lit.tint < HOVER.tint ? HOVER : lit;
  }

  #undress() {
    for (const [mesh, material] of this.#exchanged) mesh.material = material;
    this.#exchanged = [];
  }

  /** @param {Material} material @param {number} opacity @param {{ tint: number, glow: number }} shine */
  #twin(material, opacity, shine) {
    let twin = this.#twins.get(material);
    if (!twin) {
      twin = material.clone();
      const made = twin;
      material.addEventListener("dispose", () => made.dispose());
      this.#twins.set(material, twin);
    }
    const wasTransparent = twin.transparent;
    twin.copy(material);
    twin.opacity = material.opacity * opacity;
    twin.transparent = material.transparent || opacity < 1;
    twin.depthWrite = twin.opacity > 0.5;
    twin.needsUpdate = wasTransparent !== twin.transparent;
    if (shine.tint > 0) this.#light(twin, shine);
    return twin;
  }

  /** @param {Material} twin @param {{ tint: number, glow: number }} shine */
  #light(twin, shine) {
    const accent = twin.color?.clone().set(this.#theme.accent);
    if (!accent) return;
    twin.color?.lerp(greyOf(twin.color), Math.min(1, PALER * shine.tint)).lerp(accent, shine.tint);
    if (!twin.emissive) return;
    twin.emissive.copy(accent);
    twin.emissiveIntensity = shine.glow;
  }
}

/** As bright, without a hue: yellow that turns blue would pass through purple. @param {Color} color @returns {Color} */
function greyOf(color) {
  const brightness = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
  return Object.assign(color.clone(), { r: brightness, g: brightness, b: brightness });
}

/** @param {string} link @param {boolean} visible */
function visibility(link, visible) {
  return {
    type: "SetSceneNodeVisibilityMessage",
    name: RobotView.nodeName(link),
    owner: "",
    visible,
  };
}

/** After everything else of the picture. */
const LAST = 1_000_000;
/** How far the outline reaches beyond the link, px: its edge, then the line that lies on it. */
const EDGE_PX = 4;
const LINE_PX = 2.5;
const DIRECTIONS = 8;
/** A link of more corners than this is drawn in half as many directions. */
const FINE_MAX = 150_000;
/** From the nearest that is drawn: what hides the outline inside of the link lies before it. */
const HIDING = 1.001;
const SHOWN = 1.01;

const PROJECT = "#include <project_vertex>";
const LAST_OF_FRAGMENT = "#include <dithering_fragment>";
/**
 * As far as the nearest plane, whichever way depth is counted, and moved on the screen.
 * The camera looks along -z, and `studioDepth` is the z.
 */
const MOVED_LINE = `${PROJECT}
  vec4 studioNear = projectionMatrix * vec4(0.0, 0.0, studioDepth, 1.0);
  gl_Position.z = studioNear.z / studioNear.w * gl_Position.w;
  gl_Position.xy += studioShift * gl_Position.w;`;

/**
 * The selected link, outlined by a line with an edge of another brightness: seen on every colour, and
 * through what is in front. Copies of its meshes, each moved by a few pixels, are added for the time of
 * one picture; the link itself, drawn first and nearest, hides all of them but what sticks out.
 */
export class Outline {
  /** @type {string | null} */
  link = null;
  /** What all copies have in common, by their place in the order. @type {Stroke[]} */
  #strokes = [];
  /** By mesh: its copies. @type {WeakMap<Object3D, { material: unknown, copies: Object3D[] }>} */
  #copies = new WeakMap();
  /** @type {Object3D[]} */
  #added = [];
  #door;
  #robot;
  #theme;

  /** @param {Door} door @param {RobotView} robot @param {Theme} theme */
  constructor(door, robot, theme) {
    this.#door = door;
    this.#robot = robot;
    this.#theme = theme;
    door.onPicture(
      () => this.#add(),
      () => this.#remove(),
    );
  }

  #add() {
    const { scene, canvas, camera } = this.#door.mutable ?? {};
    if (!this.link || !scene || !canvas || !camera) return;
    if (this.#strokes.length === 0) this.#strokes = strokes();
    const { accent, edge } = this.#theme;
    for (const stroke of this.#strokes)
      stroke.see(canvas, camera, stroke.isEdge ? edge : accent);
    this.#robot.eachMesh(this.link, (mesh) => this.#added.push(...this.#copiesOf(mesh)));
    scene.children.push(...this.#added);
  }

  #remove() {
    if (this.#added.length === 0) return;
    const added = new Set(this.#added);
    const scene = this.#door.mutable?.scene;
    if (scene) scene.children = scene.children.filter((one) => !added.has(one));
    this.#added = [];
  }

  /** @param {Object3D} mesh @returns {Object3D[]} */
  #copiesOf(mesh) {
    const material = [mesh.material ?? []].flat()[0];
    if (!material || mesh.isInstancedMesh) return [];
    let known = this.#copies.get(mesh);
    if (known?.material !== material) {
      known = { material, copies: copiesOf(mesh, material, this.#strokes) };
      this.#copies.set(mesh, known);
    }
    for (const copy of known.copies) {
      if (mesh.geometry) copy.geometry = mesh.geometry;
      copy.matrixWorld.copy(mesh.matrixWorld);
    }
    return known.copies;
  }
}

/** One of the ways in which a mesh is drawn for its outline. */
class Stroke {
  /** Uniforms of its program. */
  shift = { value: [0, 0] };
  depth = { value: 0 };
  color = { value: [0, 0, 0] };

  /** @param {number} order @param {number} reach_px 0: the link itself, which hides @param {number} turn rad */
  constructor(order, reach_px, turn) {
    this.order = order;
    this.hides = reach_px === 0;
    this.isEdge = reach_px === EDGE_PX;
    this.fine = order % 2 === 1;
    this.x_px = reach_px * Math.cos(turn);
    this.y_px = reach_px * Math.sin(turn);
  }

  /** @param {HTMLCanvasElement} canvas @param {Camera} camera @param {string} color `#rrggbb` */
  see(canvas, camera, color) {
    const wide = canvas.clientWidth || 1;
    const high = canvas.clientHeight || 1;
    this.shift.value = [(2 * this.x_px) / wide, (2 * this.y_px) / high];
    this.depth.value = -nearestOf(camera, this.hides ? HIDING : SHOWN);
    this.color.value = [1, 3, 5].map((at) => Number.parseInt(color.slice(at, at + 2), 16) / 255);
  }

  /** @param {Material} like of which viser made the mesh @returns {Material} */
  material(like) {
    const made = like.clone();
    Object.assign(made, { transparent: true, opacity: 1, map: null, alphaTest: 0, fog: false });
    Object.assign(made, { depthTest: true, depthWrite: this.hides, colorWrite: !this.hides });
    made.side = BOTH_SIDES;
    made.onBeforeCompile = (shader) => this.#write(shader);
    made.customProgramCacheKey = () => "studio outline";
    like.addEventListener("dispose", () => made.dispose());
    return made;
  }

  /** @param {Shader} shader */
  #write(shader) {
    Object.assign(shader.uniforms, {
      studioShift: this.shift,
      studioDepth: this.depth,
      studioColor: this.color,
    });
    const moved = shader.vertexShader.replace(PROJECT, MOVED_LINE);
    shader.vertexShader = `uniform vec2 studioShift;\nuniform float studioDepth;\n${moved}`;
    const flat = `${LAST_OF_FRAGMENT}\n  gl_FragColor = vec4(studioColor, 1.0);`;
    const painted = shader.fragmentShader.replace(LAST_OF_FRAGMENT, flat);
    shader.fragmentShader = `uniform vec3 studioColor;\n${painted}`;
  }
}

/** three.js calls it DoubleSide. */
const BOTH_SIDES = 2;

/** First what hides, then the edge all around, then the line. */
function strokes() {
  const turns = Array.from({ length: DIRECTIONS }, (_, n) => (2 * Math.PI * n) / DIRECTIONS);
  const ways = [[0, 0], ...[EDGE_PX, LINE_PX].flatMap((px) => turns.map((turn) => [px, turn]))];
  return ways.map(([px = 0, turn = 0], order) => new Stroke(order, px, turn));
}

/** @param {Object3D} mesh @param {Material} material @param {readonly Stroke[]} all @returns {Object3D[]} */
function copiesOf(mesh, material, all) {
  const corners = mesh.geometry?.attributes?.position?.count ?? 0;
  return all
    .filter((stroke) => stroke.hides || stroke.fine || corners <= FINE_MAX)
    .map((stroke) => {
      const copy = mesh.clone(false);
      Object.assign(copy, { castShadow: false, receiveShadow: false, frustumCulled: false });
      Object.assign(copy, { matrixAutoUpdate: false, matrixWorldAutoUpdate: false });
      copy.material = stroke.material(material);
      copy.renderOrder = LAST + stroke.order;
      return copy;
    });
}
