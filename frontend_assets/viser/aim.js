/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { JointView, Vector3 } from "./viser.d.ts" */
import { pickSurface } from "./picking.js";
import { pixelsBetween, pixelsToLine, placeOf } from "./screen.js";

/** @typedef {"all" | "points" | "frames" | "axes"} AimMode */
/** @typedef {[number, number, number]} Triple */
/**
 * Something that can be measured, as the page keeps it: a point and its normal in the frame of the
 * link, the link's frame itself, or the axis of a joint, which is at rest in its child.
 * @typedef {{ kind: "point", link: string, at: Triple, normal: Triple | null } | { kind: "frame", link: string } | { kind: "axis", link: string, joint: string }} Anchor
 */

const CORNER_PX = 9;
/** Where everything may be meant, a frame must be met better than where only frames are. */
const FRAME_PX = { all: 9, frames: 26 };
const AXIS_PX = { all: 6, axes: 14 };
/** Half the length of an axis that can be met, of the distance from the eye. */
export const AXIS_SHARE = 0.11;
const MOVES = new Set(["revolute", "continuous", "prismatic"]);

/** What of the robot is meant by a place of the window. */
export class Aim {
  #door;
  #robot;
  #distance;

  /** @param {Door} door @param {RobotView} robot @param {() => number} distance from the eye to what it looks at, m */
  constructor(door, robot, distance) {
    this.#door = door;
    this.#robot = robot;
    this.#distance = distance;
  }

  /** @param {number} x @param {number} y @param {AimMode} mode @param {boolean} free without snapping
   * @returns {Anchor | null} */
  at(x, y, mode, free) {
    if (mode === "points" || free) return this.#surfacePoint(x, y, free);
    if (mode === "frames") return this.#frame(x, y, FRAME_PX.frames);
    if (mode === "axes") return this.#axis(x, y, AXIS_PX.axes);
    return (
      this.#frame(x, y, FRAME_PX.all) ??
      this.#axis(x, y, AXIS_PX.all) ??
      this.#surfacePoint(x, y, false)
    );
  }

  /** Both ends of what is drawn of an axis, in the scene. @param {JointView} joint @returns {[Vector3, Vector3] | null} */
  axisLine(joint) {
    const node = this.#robot.node(joint.child);
    if (!node || !MOVES.has(joint.type)) return null;
    const middle = this.#origin(node.matrixWorld);
    const way = middle.clone().set(...joint.axis);
    if (!(way.length() > 0)) return null;
    way.transformDirection(node.matrixWorld).multiplyScalar(AXIS_SHARE * this.#distance());
    return [middle.clone().sub(way), middle.clone().add(way)];
  }

  /** @param {number} x @param {number} y @param {boolean} free @returns {Anchor | null} */
  #surfacePoint(x, y, free) {
    const found = pickSurface(this.#door, this.#robot, x, y);
    const node = found && this.#robot.node(found.link);
    if (!node) return null;
    const corner = free ? null : this.#nearestCorner(found.corners, x, y);
    const back = node.matrixWorld.clone().invert();
    const normal = found.normal?.transformDirection(back) ?? null;
    return {
      kind: "point",
      link: found.link,
      at: triple((corner ?? found.point).clone().applyMatrix4(back)),
      normal: normal && triple(normal),
    };
  }

  /** @param {Vector3[]} corners @param {number} x @param {number} y */
  #nearestCorner(corners, x, y) {
    return nearest(corners, CORNER_PX, (corner) => this.#pixels(corner, x, y));
  }

  /** @param {number} x @param {number} y @param {number} within px @returns {Anchor | null} */
  #frame(x, y, within) {
    const links = [...this.#robot.drawn];
    const found = nearest(links, within, (link) => {
      const node = this.#robot.node(link);
      return node ? this.#pixels(this.#origin(node.matrixWorld), x, y) : null;
    });
    return found === null ? null : { kind: "frame", link: found };
  }

  /** @param {number} x @param {number} y @param {number} within px @returns {Anchor | null} */
  #axis(x, y, within) {
    const found = nearest(this.#robot.joints.values(), within, (joint) => {
      const [begin, end] = (this.axisLine(joint) ?? []).map((one) => placeOf(this.#door, one));
      return begin && end ? pixelsToLine([x, y], begin, end) : null;
    });
    return found && { kind: "axis", link: found.child, joint: found.name };
  }

  /** @param {Vector3} point @param {number} x @param {number} y */
  #pixels(point, x, y) {
    const place = placeOf(this.#door, point);
    return place && pixelsBetween(place, [x, y]);
  }

  /** @param {import("./viser.d.ts").Matrix4} matrix @returns {Vector3} */
  #origin(matrix) {
    const camera = this.#door.mutable?.camera;
    if (!camera) throw new Error("The 3D view has no camera yet.");
    return camera.position.clone().setFromMatrixPosition(matrix);
  }
}

/** @template T @param {Iterable<T>} all @param {number} within @param {(one: T) => number | null} distance
 * @returns {T | null} */
function nearest(all, within, distance) {
  /** @type {T | null} */
  let found = null;
  let least = within;
  for (const one of all) {
    const far = distance(one);
    if (far === null || far > least) continue;
    least = far;
    found = one;
  }
  return found;
}

/** @param {Vector3} vector @returns {Triple} */
function triple({ x, y, z }) {
  return [x, y, z];
}
