/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Numbers } from "./lens.js" */
/** @import { Props } from "./live-nodes.js" */
/** @import { Matrix4, Object3D, Vector3 } from "./viser.d.ts" */

import { isSeen } from "./extent.js";
import { liveNodes } from "./live-nodes.js";
import { radiusAt, reading } from "./live-picking.js";
import { hitOf, pick, rayThrough } from "./picking.js";
import { dot, minus, plus, times } from "../lib/vectors.js";

const FLOOR = "/grid";
/** Points and lines are met so near, px. */
const NEAR_PX = 4;
/** Words face the eye. */
const NO_SURFACE = new Set(["LabelMessage"]);

/** @typedef {{ origin: Vector3, direction: Vector3 }} Ray the direction has the length 1 */
/** How wide a pixel is, m: `base + slope * distance`. @typedef {{ base: number, slope: number }} PixelSize */
/**
 * What is seen at a place: in the scene, how far from the eye, and of what.
 *
 * @typedef {object} Surface
 * @property {Vector3} point
 * @property {number} distance m
 * @property {string | null} link
 * @property {string | null} display its id; null, and no link: the floor
 */

/**
 * The nearest thing under the mouse, as RViz finds it by depth: links, and all that displays draw,
 * single points and thin lines too. Between the lines of a grid there is nothing.
 */
export class Surfaces {
  #door;
  #robot;

  /** @param {Door} door @param {RobotView} robot */
  constructor(door, robot) {
    this.#door = door;
    this.#robot = robot;
  }

  /** @param {number} x @param {number} y @returns {Surface | null} */
  at(x, y) {
    const ray = rayThrough(this.#door, x, y);
    const beside = rayThrough(this.#door, x + 1, y);
    if (!ray || !beside) return null;
    const pixel = {
      base: ray.origin.distanceTo(beside.origin),
      slope: ray.direction.distanceTo(beside.direction),
    };
    /** @type {Surface | null} */
    let nearest = this.#link(ray, x, y);
    for (const { kind, props, object, display } of [...this.#floor(), ...liveNodes(this.#door)]) {
      const hit = NO_SURFACE.has(kind) ? null : this.#hit(kind, props, object, ray, pixel);
      if (!hit || (nearest && hit.distance >= nearest.distance)) continue;
      const { distance } = hit;
      const point = hit.point ?? ray.origin.clone().addScaledVector(ray.direction, distance);
      nearest = { point, distance, link: null, display };
    }
    return nearest;
  }

  /** @param {Ray} ray @param {number} x @param {number} y @returns {Surface | null} */
  #link(ray, x, y) {
    const found = pick(this.#door, this.#robot, x, y);
    if (!found) return null;
    const { link, point } = found;
    return { point, distance: point.distanceTo(ray.origin), link, display: null };
  }

  /** The grid of the studio, which is no display's, if it is seen. */
  #floor() {
    const { message } = window.__viserSceneTree?.getState()[FLOOR] ?? {};
    const object = this.#door.node(FLOOR);
    if (!message || !object || !isSeen(object)) return [];
    const props = /** @type {Props} */ (message.props ?? {});
    return [{ kind: message.type, props, object, display: null }];
  }

  /** @param {string} kind @param {Props} props @param {Object3D} object @param {Ray} ray @param {PixelSize} pixel
   * @returns {{ distance: number, point?: Vector3 } | null} */
  #hit(kind, props, object, ray, pixel) {
    const own = inFrame(ray, object.matrixWorld);
    if (kind === "PointCloudMessage")
      return placed(nearestPoint(props, own, pixel), object);
    if (kind === "LineSegmentsMessage")
      return placed(nearestSegment(props.points, own, pixel), object);
    if (kind === "GridMessage") return lineOfGrid(props.cell_size ?? 0, own, pixel);
    // Its point is in the axes of the mesh where that is of many bodies.
    const hit = hitOf(this.#door, object, ray);
    return hit && { distance: hit.distance };
  }
}

/** A ray as a frame of the scene sees it; frames of displays are not scaled. @param {Ray} ray @param {Matrix4} matrix @returns {Ray} */
function inFrame({ origin, direction }, matrix) {
  const back = matrix.clone().invert();
  return {
    origin: origin.clone().applyMatrix4(back),
    direction: direction.clone().transformDirection(back),
  };
}

/** @param {{ distance: number, part: number, at: [number, number, number] } | null} hit @param {Object3D} object
 * @returns {{ distance: number, part: number, point: Vector3 } | null} */
function placed(hit, object) {
  if (!hit) return null;
  const point = object.position
    .clone()
    .set(...hit.at)
    .applyMatrix4(object.matrixWorld);
  return { distance: hit.distance, part: hit.part, point };
}

/**
 * The point nearest to the eye of those that a ray meets.
 *
 * @param {Props} cloud
 * @param {Ray} ray in its frame
 * @param {PixelSize} pixel
 * @returns {{ distance: number, part: number, at: [number, number, number] } | null}
 */
export function nearestPoint(cloud, { origin: o, direction: d }, pixel) {
  const { points, studio_point_px: wide_px = 0 } = cloud;
  if (!points) return null;
  const read = reading(points);
  const near_px = Math.max(wide_px / 2, NEAR_PX);
  let [nearest, part] = [Number.POSITIVE_INFINITY, -1];
  for (let at = 0; at < points.length; at += 3) {
    const [x, y, z] = [read(at) - o.x, read(at + 1) - o.y, read(at + 2) - o.z];
    const along = x * d.x + y * d.y + z * d.z;
    if (!(along > 0 && along < nearest)) continue;
    const radius = wide_px > 0 ? 0 : radiusAt(cloud, read(at + 2));
    const reach = Math.max(radius, near_px * (pixel.base + pixel.slope * along));
    if (x * x + y * y + z * z - along * along > reach * reach) continue;
    [nearest, part] = [along, at / 3];
  }
  return part < 0 ? null : { distance: nearest, part, at: tripleAt(read, part) };
}

/**
 * The place of a line that a ray meets; of several the nearest to the eye.
 *
 * @param {Numbers | undefined} points (N, 2, 3)
 * @param {Ray} ray in their frame
 * @param {PixelSize} pixel
 * @returns {{ distance: number, part: number, at: [number, number, number] } | null}
 */
export function nearestSegment(points, ray, pixel) {
  if (!points) return null;
  const read = reading(points);
  /** @type {{ distance: number, part: number, at: [number, number, number] } | null} */
  let nearest = null;
  for (let part = 0; 6 * part < points.length; part += 1) {
    const [begin, end] = [tripleAt(read, 2 * part), tripleAt(read, 2 * part + 1)];
    const found = approach(begin, end, ray);
    if (!found || (nearest && found.along >= nearest.distance)) continue;
    if (found.apart > NEAR_PX * (pixel.base + pixel.slope * found.along)) continue;
    nearest = { distance: found.along, part, at: found.at };
  }
  return nearest;
}

/** How near a ray comes to a line, where, and how far from the eye. @param {[number, number, number]} begin
 * @param {[number, number, number]} end @param {Ray} ray */
function approach(begin, end, { origin: o, direction: d }) {
  const way = minus(end, begin);
  const from = minus(begin, [o.x, o.y, o.z]);
  const ray = /** @type {const} */ ([d.x, d.y, d.z]);
  const [length2, slant] = [dot(way, way), dot(way, ray)];
  const across2 = length2 - slant * slant;
  const [fromWay, fromRay] = [dot(from, way), dot(from, ray)];
  // Seen end-on, its nearer end.
  const nearEnd = slant < 0 ? 1 : 0;
  const wanted = across2 > 1e-12 * length2 ? (slant * fromRay - fromWay) / across2 : nearEnd;
  const share = Math.min(Math.max(wanted, 0), 1);
  const [at, there] = [plus(begin, times(way, share)), plus(from, times(way, share))];
  const along = dot(there, ray);
  if (!(along > 0)) return null;
  return { at, along, apart: Math.sqrt(Math.max(0, dot(there, there) - along * along)) };
}

/** Where a ray meets a line of a grid on the xy plane. @param {number} cell m @param {Ray} ray @param {PixelSize} pixel
 * @returns {{ distance: number, part: null } | null} */
export function lineOfGrid(cell, { origin: o, direction: d }, pixel) {
  const distance = -o.z / d.z;
  if (!(distance > 0) || !Number.isFinite(distance)) return null;
  const off = (/** @type {number} */ part) => Math.abs(part - cell * Math.round(part / cell));
  const reach = NEAR_PX * (pixel.base + pixel.slope * distance);
  const isMet = Math.min(off(o.x + distance * d.x), off(o.y + distance * d.y)) <= reach;
  return isMet ? { distance, part: null } : null;
}

/** @param {(at: number) => number} read @param {number} row @returns {[number, number, number]} */
const tripleAt = (read, row) => [read(3 * row), read(3 * row + 1), read(3 * row + 2)];
