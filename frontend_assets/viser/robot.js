/** @import { Door } from "./door.js" */
/** @import { Box3, JointView, Object3D, RobotState, Vector3 } from "./viser.d.ts" */

const ROOT = "/robot";
const GHOST = "/ghost";

/** The robot as the page told it, and where its links stand in the scene. */
export class RobotView {
  /** Links that the server has drawn. @type {Set<string>} */
  drawn = new Set();
  /** Of the whole robot, as the server set it. */
  opacity = 1;
  /** @type {Map<string, number>} */
  positions = new Map();
  /** @type {Map<string, JointView>} */
  #joints = new Map();
  /** @type {Map<string, JointView>} */
  #jointOfChild = new Map();
  #door;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage((message) => this.#read(message));
  }

  /** @param {RobotState} state */
  set(state) {
    this.#joints = new Map(state.joints.map((joint) => [joint.name, joint]));
    this.#jointOfChild = new Map(state.joints.map((joint) => [joint.child, joint]));
  }

  /** By name. @returns {ReadonlyMap<string, JointView>} */
  get joints() {
    return this.#joints;
  }

  /** @param {string} link */
  static nodeName(link) {
    return `${ROOT}/${encodeURIComponent(link)}`;
  }

  /** @param {string} link */
  node(link) {
    return this.#door.node(RobotView.nodeName(link));
  }

  /** What of a link can be seen and picked: its visuals, or its collisions where those are shown.
   * @param {string} link @returns {Object3D[]} */
  surfaces(link) {
    const name = RobotView.nodeName(link);
    const found = [];
    for (const layer of ["visual", "collision"]) {
      const object = this.#door.node(`${name}/${layer}`);
      if (object?.visible && this.node(link)?.visible) found.push(object);
    }
    return found;
  }

  /** Meshes of a link that are shown now. @param {string} link @param {(mesh: Object3D) => void} visit */
  eachMesh(link, visit) {
    for (const surface of this.surfaces(link)) {
      surface.traverseVisible((object) => {
        if (object.isMesh && object.geometry) visit(object);
      });
    }
  }

  /** Corners of the boxes of all meshes of links, in the axes of three.js.
   * @param {Iterable<string>} [links] without: of all there is to see, the ghost included
   * @returns {Vector3[]} */
  corners(links) {
    /** @type {Vector3[]} */
    const found = [];
    const add = (/** @type {Object3D} */ mesh) => found.push(...boxCorners(mesh));
    for (const link of links ?? this.drawn) {
      this.node(link)?.updateWorldMatrix(true, true);
      this.eachMesh(link, add);
    }
    if (!links) this.#eachGhostMesh(add);
    return found.filter(({ x, y, z }) => Number.isFinite(x + y + z));
  }

  /** Meshes of the robot that this one is compared with. @param {(mesh: Object3D) => void} visit */
  #eachGhostMesh(visit) {
    const ghost = this.#door.node(GHOST);
    ghost?.updateWorldMatrix(true, true);
    ghost?.traverseVisible((object) => {
      if (object.isMesh && object.geometry) visit(object);
    });
  }

  /** How many meshes stand in the scene: grows while they arrive. */
  meshCount() {
    let count = 0;
    for (const link of this.drawn) this.eachMesh(link, () => count++);
    return count;
  }

  /**
   * The joint that moves a link: the nearest above it over fixed joints only, or null.
   * @param {string} link @returns {JointView | null}
   */
  jointThatMoves(link) {
    const seen = new Set();
    let joint = this.#jointOfChild.get(link);
    while (joint?.type === "fixed" && !seen.has(joint.name)) {
      seen.add(joint.name);
      joint = this.#jointOfChild.get(joint.parent);
    }
    const moves = joint && ["revolute", "continuous", "prismatic"].includes(joint.type);
    return (moves && joint) || null;
  }

  /**
   * The joint to set so that `joint` moves: itself, or what it follows; `ratio` is how much `joint`
   * moves for one unit of that.
   * @param {JointView} joint
   */
  leaderOf(joint) {
    let leader = joint;
    let ratio = 1;
    const seen = new Set();
    while (leader.mimic && !seen.has(leader.name)) {
      seen.add(leader.name);
      ratio *= leader.multiplier || 1;
      leader = this.#joints.get(leader.mimic) ?? leader;
    }
    return { leader, ratio };
  }

  /** @param {import("./viser.d.ts").Message} message */
  #read(message) {
    if (message.name === ROOT) this.#readOpacity(message);
    if (!message.name?.startsWith(`${ROOT}/`)) return;
    const [, , encoded = "", below] = message.name.split("/");
    if (below !== undefined) return;
    const link = decodeURIComponent(encoded);
    if (message.type === "FrameMessage") this.drawn.add(link);
    else if (message.type === "RemoveSceneNodeMessage") this.drawn.delete(link);
  }

  /** The server hides the opacity in a size that is never drawn; see robot_drawing.py.
   * @param {import("./viser.d.ts").Message} message */
  #readOpacity(message) {
    const value = (message.props ?? message.updates)?.origin_radius;
    if (typeof value === "number") this.opacity = value;
  }
}

/** @param {Object3D} mesh @returns {Box3 | null} */
function localBox({ geometry }) {
  if (!geometry) return null;
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const box = geometry.boundingBox;
  return box && !box.isEmpty() ? box : null;
}

/** @param {Object3D} mesh whose place in the scene is up to date @returns {Vector3[]} */
export function boxCorners(mesh) {
  const box = localBox(mesh);
  return box ? cornersOf(box).map((corner) => corner.applyMatrix4(mesh.matrixWorld)) : [];
}

/** @param {Box3} box @returns {Vector3[]} */
function cornersOf({ min, max }) {
  const found = [];
  for (const x of [min.x, max.x])
    for (const y of [min.y, max.y])
      for (const z of [min.z, max.z]) found.push(min.clone().set(x, y, z));
  return found;
}
