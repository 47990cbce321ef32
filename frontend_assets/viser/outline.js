/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Theme } from "./theme.js" */
/** @import { Material, Object3D, Shader } from "./viser.d.ts" */

/** After everything else of the picture. */
const LAST = 1_000_000;
/** How far the outline reaches beyond the link, px: its edge, then the line that lies on it. */
const EDGE_PX = 4;
const LINE_PX = 2.5;
const DIRECTIONS = 8;
/** A link of more corners than this is drawn in half as many directions. */
const FINE_MAX = 150_000;
/** In multiples of the nearest distance that is drawn: what hides the outline inside of the link lies before it. */
const HIDING = 1.001;
const SHOWN = 1.01;

const PROJECT = "#include <project_vertex>";
const LAST_OF_FRAGMENT = "#include <dithering_fragment>";
/**
 * As far as the nearest plane, whichever way depth is counted, and moved on the screen.
 * `studioDepth` is negative: the camera looks along -z.
 */
const MOVED = `${PROJECT}
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
      stroke.see(canvas, camera.near, stroke.isEdge ? edge : accent);
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

  /** @param {HTMLCanvasElement} canvas @param {number} near m @param {string} color `#rrggbb` */
  see(canvas, near, color) {
    const wide = canvas.clientWidth || 1;
    const high = canvas.clientHeight || 1;
    this.shift.value = [(2 * this.x_px) / wide, (2 * this.y_px) / high];
    this.depth.value = -near * (this.hides ? HIDING : SHOWN);
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
    const moved = shader.vertexShader.replace(PROJECT, MOVED);
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
