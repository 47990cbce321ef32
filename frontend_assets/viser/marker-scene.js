/** @import { Door } from "./door.js" */
/** @import { Vector } from "../lib/vectors.js" */
/** @import { Pose, Sight, Turn } from "./handle-drag.js" */
/** @import { Hit, Material, Matrix4, Message, Object3D, Pointing, Vector3 } from "./viser.d.ts" */

import {
  about,
  after,
  back,
  composed,
  FIXED,
  facing,
  Mode,
  turned,
  VIEW_FACING,
} from "./handle-drag.js";
import { groupName } from "./live-nodes.js";
import { rayThrough } from "./picking.js";
import { placeOf } from "./screen.js";
import { dot, times } from "../lib/vectors.js";

/** @typedef {{ number: number, mode: number, facing: number, wxyz: Turn, independent: boolean, always_visible: boolean, description: string }} Control */
/** @typedef {{ number: number, name: string, description: string, scale: number, controls: Control[], menu: readonly { id: number }[] }} Marker */
/** @typedef {{ display: string, visual_aids: boolean, markers: Marker[] }} Markers of one display */
/** A marker, and the name of its reference frame in the scene. @typedef {{ root: string, display: string, aids: boolean, marker: Marker }} Known */
/** What the mouse is over; `control` null: the title. @typedef {{ known: Known, control: Control | null, node: string, distance: number, point: Vector3 }} Handle */
/** Where this browser has a marker; `until`: ms, when the studio's word counts again. @typedef {{ pose: Pose, until: number }} Own */

/** The name of the reference frame of a marker. @param {string} display @param {number} marker */
export const referenceOf = (display, marker) => groupName(display, `m${marker}`);
/** That, `-<part>`, then the shape: `c<control>-...`. */
const NAME = /^(\/live\/[^/]+\/m\d+)-[a-z]+\d*\/(?:c(\d+)-)?/;
const NEAR = { Points: { threshold: 0.02 }, Line: { threshold: 0.02 }, Line2: { threshold: 6 } };

/**
 * Interactive markers as they stand in the scene of this browser: where each is, what faces the eye,
 * what lights up, and which control is under the mouse. A marker that is dragged here stands where it
 * is dragged, whatever the studio says meanwhile.
 */
export class MarkerScene {
  /** Whether all controls are seen; else only those that always are. */
  all = true;
  /** The one marker whose controls are seen, while it is dragged; null: all. @type {string | null} */
  only = null;
  /** By the name of their reference frame. @type {Map<string, Known>} */
  known = new Map();
  /** The control that lights up, and how much. @type {{ handle: Handle, strength: number } | null} */
  lit = null;
  /** Nodes of shapes and their controls, by the reference frame of their marker. @type {Map<string, Map<string, number | null>>} */
  #shapes = new Map();
  /** @type {Map<string, Own>} */
  #own = new Map();
  /** How far controls were turned about their axes here, by their reference frame and number. @type {Map<string, Map<number, number>>} */
  #rads = new Map();
  /** @type {WeakMap<Material, Material>} */
  #twins = new WeakMap();
  /** @type {[Object3D, Material | Material[]][]} */
  #exchanged = [];
  #door;
  #robotAt;

  /** @param {Door} door @param {(x: number, y: number) => Vector3 | null} robotAt what of the robot is seen at a place */
  constructor(door, robotAt) {
    this.#door = door;
    this.#robotAt = robotAt;
    door.onMessage((message) => this.#read(message));
    door.onPicture(
      () => this.#dress(),
      () => this.#undress(),
    );
  }

  /** @param {readonly Markers[]} displays */
  set(displays) {
    this.known.clear();
    for (const { display, visual_aids: aids, markers } of displays)
      for (const marker of markers) {
        const root = referenceOf(display, marker.number);
        this.known.set(root, { root, display, aids, marker });
      }
    for (const kept of [this.#own, this.#rads])
      for (const root of kept.keys()) if (!this.known.has(root)) kept.delete(root);
    this.#door.redraw();
  }

  /** Where a marker is in its reference frame. @param {Known} known @returns {Pose} */
  poseOf({ root }) {
    return (
      this.#own.get(root)?.pose ?? composed(inverse(this.#told(root)), this.#told(`${root}-body`))
    );
  }

  /** How far a control was turned about its axis. @param {Known} known @param {Control} control */
  radOf({ root }, control) {
    const kept = this.#rads.get(root)?.get(control.number);
    if (kept !== undefined || control.facing !== FIXED) return kept ?? 0;
    // Somebody else may have turned it.
    const [w, ...xyz] = after(
      back(this.#told(root).turn),
      this.#told(`${root}-f${control.number}`).turn,
    );
    return 2 * Math.atan2(dot(xyz, turned(control.wxyz, [1, 0, 0])), w);
  }

  /** A marker stands here from now on. @param {Known} known @param {Pose} pose @param {Control | null} control @param {number} rad */
  keep({ root }, pose, control, rad) {
    const rads = this.#rads.get(root) ?? new Map();
    if (control && control.facing !== 0) this.#rads.set(root, rads.set(control.number, rad));
    this.#own.set(root, { pose, until: Number.POSITIVE_INFINITY });
    this.#door.redraw();
  }

  /** The studio's word counts again after so long. @param {string} root @param {number} ms */
  release(root, ms) {
    const own = this.#own.get(root);
    if (!own) return;
    own.until = performance.now() + ms;
    setTimeout(() => this.#door.redraw(), ms + 20);
  }

  /** The studio's word counts at once. @param {string} root */
  giveBack(root) {
    this.#own.delete(root);
    for (const { facing: how, number } of this.known.get(root)?.marker.controls ?? [])
      if (how === FIXED) this.#rads.get(root)?.delete(number);
    for (const name of this.#groupsOf(root)) this.#stand(name, this.#told(name));
    this.#door.redraw();
  }

  /** The control that is seen at a place of the window; null: none, or the robot is before it.
   * @param {number} x @param {number} y @returns {Handle | null} */
  pick(x, y) {
    const ray = rayThrough(this.#door, x, y);
    const camera = this.#door.mutable?.camera;
    if (!ray || !camera) return null;
    /** @type {Pointing} */
    const pointing = { ray, near: 0, far: Number.POSITIVE_INFINITY, camera, params: NEAR };
    /** @type {Handle | null} */
    let nearest = null;
    for (const [known, control, node] of this.#meant())
      for (const { distance } of this.#hits(node, pointing)) {
        if (nearest && distance >= nearest.distance) continue;
        // Its own point is said in the axes of the mesh where that is of many bodies.
        const point = ray.origin.clone().addScaledVector(ray.direction, distance);
        nearest = { known, control, node, distance, point };
      }
    const found = /** @type {Handle | null} */ (nearest);
    const before = found && this.#robotAt(x, y);
    return found && before && before.distanceTo(ray.origin) < found.distance ? null : found;
  }

  /** What a drag needs of the picture, in the reference frame of a marker as it is then. @param {Known} known @returns {Sight} */
  sightFrom({ root }) {
    const matrix = () => this.#door.node(root)?.matrixWorld;
    return {
      rayAt: (x, y) => {
        const ray = rayThrough(this.#door, x, y);
        const inside = matrix()?.clone().invert();
        if (!ray || !inside) return null;
        return {
          origin: triple(ray.origin.applyMatrix4(inside)),
          direction: triple(ray.direction.transformDirection(inside)),
        };
      },
      placeOf: (point) => {
        const vector = this.#door.mutable?.camera?.position.clone();
        const world = matrix();
        return world && vector ? placeOf(this.#door, vector.set(...point).applyMatrix4(world)) : null;
      },
      axes: () => this.#eyeIn(matrix()) ?? { forward: [1, 0, 0], up: [0, 0, 1], right: [0, -1, 0] },
    };
  }

  /** A point of the scene in the reference frame of a marker. @param {Known} known @param {Vector3} point @returns {Vector | null} */
  toReference({ root }, point) {
    const world = this.#door.node(root)?.matrixWorld;
    return world ? triple(point.clone().applyMatrix4(world.clone().invert())) : null;
  }

  /** @param {Message} message */
  #read({ type, name = "", props }) {
    const found = name.startsWith("/live/") ? NAME.exec(name) : null;
    const root = found?.[1];
    if (!found || !root) return;
    const shapes = this.#shapes.get(root) ?? new Map();
    if (type === "RemoveSceneNodeMessage") shapes.delete(name);
    else if (props) shapes.set(name, found[2] === undefined ? null : Number(found[2]));
    if (shapes.size > 0) this.#shapes.set(root, shapes);
    else this.#shapes.delete(root);
  }

  /** Shapes with which something can be done. @returns {Generator<[Known, Control | null, string]>} */
  *#meant() {
    for (const known of this.known.values()) {
      const { controls, menu } = known.marker;
      const byNumber = new Map(controls.map((one) => [one.number, one]));
      for (const [node, number] of this.#shapes.get(known.root) ?? []) {
        const control = number === null ? null : (byNumber.get(number) ?? null);
        if (menu.length > 0 || (control && control.mode !== Mode.NONE)) yield [known, control, node];
      }
    }
  }

  /** @param {string} name @param {Pointing} pointing @returns {Hit[]} */
  #hits(name, pointing) {
    /** @type {Hit[]} */
    const hits = [];
    this.#door.node(name)?.traverseVisible((object) => {
      const { geometry } = object;
      if (!geometry) return;
      if (!geometry.boundingBox) geometry.computeBoundingBox();
      object.raycast(pointing, hits);
    });
    return hits;
  }

  /** Where the studio has a group, in the fixed frame. @param {string} name @returns {Pose} */
  #told(name) {
    const pose = this.#door.mutable?.nodePoseData[name];
    if (!pose) return { turn: [1, 0, 0, 0], place: [0, 0, 0] };
    return { turn: [...pose.wxyz], place: [...pose.position] };
  }

  /** @param {string} root @returns {string[]} */
  #groupsOf(root) {
    const shapes = [...(this.#shapes.get(root)?.keys() ?? [])];
    return [...new Set(shapes.map((name) => name.slice(0, name.indexOf("/", root.length))))];
  }

  /** @param {string} name @param {Pose} pose */
  #stand(name, { turn: [w, x, y, z], place }) {
    const node = this.#door.node(name);
    if (!node) return;
    node.quaternion.set(x, y, z, w);
    node.position.set(...place);
    node.updateMatrix();
    node.updateWorldMatrix(false, true);
  }

  #dress() {
    const now = performance.now();
    for (const [root, { until }] of this.#own) if (now > until) this.giveBack(root);
    for (const known of this.known.values()) {
      this.#place(known);
      this.#show(known);
    }
    if (this.lit) this.#light(this.lit.handle, this.lit.strength);
  }

  /** What is dragged here, and what faces the eye. @param {Known} known */
  #place(known) {
    const { root, marker } = known;
    const reference = this.#told(root);
    const own = this.#own.get(root);
    const here = own && composed(reference, own.pose);
    const eye = this.#eyeIn(this.#door.node(root)?.parent?.matrixWorld);
    if (here) this.#stand(`${root}-body`, here);
    if (!eye) return;
    const placeOfPart = (/** @type {string} */ part) => here?.place ?? this.#told(part).place;
    for (const control of marker.controls) {
      const part = `${root}-${control.facing === FIXED ? "f" : "v"}${control.number}`;
      const turn = this.#turnOf(known, control, eye, reference, here);
      if (turn) this.#stand(part, { turn, place: placeOfPart(part) });
    }
    const title = `${root}-title`;
    this.#stand(title, { turn: facing([1, 0, 0, 0], eye, 0), place: placeOfPart(title) });
  }

  /** How a control stands that this browser sees to; null: as the studio says.
   * @param {Known} known @param {Control} control @param {{ forward: Vector, up: Vector }} eye
   * @param {Pose} reference @param {Pose | undefined} here @returns {Turn | null} */
  #turnOf(known, control, eye, reference, here) {
    const rad = control.facing === 0 ? 0 : this.radOf(known, control);
    if (control.facing === VIEW_FACING && !control.independent)
      return facing(control.wxyz, eye, rad);
    if (!here || control.facing === 0) return null;
    if (control.facing === VIEW_FACING) return here.turn;
    return after(reference.turn, about(turned(control.wxyz, [1, 0, 0]), rad));
  }

  /** Hidden while another tool is chosen or another marker is dragged, unless it is always visible.
   * @param {Known} known */
  #show({ root, marker }) {
    const isActive = this.all && (this.only ?? root) === root;
    const hidden = new Set(
      isActive ? [] : marker.controls.filter((one) => !one.always_visible).map((one) => one.number),
    );
    for (const [name, number] of this.#shapes.get(root) ?? []) {
      const node = this.#door.node(name);
      if (node && number !== null) node.visible = !hidden.has(number);
    }
  }

  /** Axes of the camera in another frame, each of length 1. @param {Matrix4 | undefined} frame
   * @returns {{ forward: Vector, up: Vector, right: Vector } | null} */
  #eyeIn(frame) {
    const camera = this.#door.mutable?.camera?.matrixWorld;
    if (!camera || !frame) return null;
    const inside = frame.clone().invert().multiply(camera).elements;
    const column = (/** @type {number} */ at) => {
      const [x = 0, y = 0, z = 0] = inside.slice(4 * at, 4 * at + 3);
      const size = Math.hypot(x, y, z) || 1;
      return /** @type {Vector} */ ([x / size, y / size, z / size]);
    };
    return { forward: times(column(2), -1), up: column(1), right: column(0) };
  }

  /** A control lights up in this picture. @param {Handle} handle @param {number} strength */
  #light({ known, control }, strength) {
    for (const [name, number] of this.#shapes.get(known.root) ?? []) {
      if (number !== (control?.number ?? null)) continue;
      this.#door.node(name)?.traverse((object) => {
        if (!object.material) return;
        this.#exchanged.push([object, object.material]);
        object.material = Array.isArray(object.material)
          ? object.material.map((one) => this.#brighter(one, strength))
          : this.#brighter(object.material, strength);
      });
    }
  }

  #undress() {
    for (const [object, material] of this.#exchanged) object.material = material;
    this.#exchanged = [];
  }

  /** @param {Material} material @param {number} strength */
  #brighter(material, strength) {
    if (!material.emissive && !material.color) return material;
    let twin = this.#twins.get(material);
    if (!twin) {
      const made = material.clone();
      material.addEventListener("dispose", () => made.dispose());
      this.#twins.set(material, made);
      twin = made;
    }
    twin.copy(material);
    if (twin.emissive) {
      twin.emissive.set(0xffffff);
      twin.emissiveIntensity = strength;
    } else if (twin.color) twin.color.lerp(twin.color.clone().set(0xffffff), strength);
    return twin;
  }
}

/** @param {Pose} pose @returns {Pose} */
function inverse({ turn, place }) {
  const there = back(turn);
  return { turn: there, place: times(turned(there, place), -1) };
}

/** @param {Vector3} vector @returns {Vector} */
const triple = ({ x, y, z }) => [x, y, z];
