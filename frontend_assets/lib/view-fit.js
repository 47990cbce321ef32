/** From where all of some points is seen. */

/** @import { Pose, Triple, Turn } from "./view-poses.js" */

import { dot, plus, times } from "./vectors.js";
import { turned } from "./view-poses.js";

const NEAREST_M = 0.05;
/** What is nearer looks larger, so that the middle of the picture is found in a few steps. */
const STEPS = 4;

/**
 * A camera from which points fill a part of the picture and lie in its middle.
 *
 * @param {readonly Triple[]} points at least one
 * @param {Turn} turn of the camera
 * @param {{field: number, aspect: number, fill: number, flat: boolean}} picture its opening angle from below to above in rad, its width by its height, the part that is filled, and whether it has no perspective
 * @returns {Pose}
 */
export function fitting(points, turn, { field, aspect, fill, flat }) {
  const [right, up, back] = [
    turned(turn, [1, 0, 0]),
    turned(turn, [0, 1, 0]),
    turned(turn, [0, 0, 1]),
  ];
  const tall = Math.tan(field / 2) * fill;
  const seen = points.map((point) => ({
    x: dot(point, right) / aspect,
    y: dot(point, up),
    z: dot(point, back),
  }));
  const middle = { x: between(seen, "x"), y: between(seen, "y"), z: between(seen, "z") };
  let distance = NEAREST_M;
  for (let step = 0; step < STEPS; step++) {
    const near = (/** @type {{z: number}} */ { z }) => (flat ? 0 : z - middle.z);
    const reach = seen.map(
      (one) => near(one) + Math.max(Math.abs(one.x - middle.x), Math.abs(one.y - middle.y)) / tall,
    );
    distance = reach.reduce((most, one) => Math.max(most, one), NEAREST_M);
    for (const side of /** @type {const} */ (["x", "y"])) {
      const places = seen.map((one) => (one[side] - middle[side]) / (distance - near(one)));
      middle[side] += extremes(places).reduce((sum, one) => sum + one / 2, 0) * distance;
    }
  }
  const flatPart = plus(times(right, middle.x * aspect), times(up, middle.y));
  return { focal: plus(flatPart, times(back, middle.z)), distance, turn };
}

/** @param {readonly number[]} values @returns {[number, number]} */
const extremes = (values) => [
  values.reduce((least, one) => Math.min(least, one), Number.POSITIVE_INFINITY),
  values.reduce((most, one) => Math.max(most, one), Number.NEGATIVE_INFINITY),
];

/** @param {readonly {x: number, y: number, z: number}[]} seen @param {"x" | "y" | "z"} side */
function between(seen, side) {
  const [least, most] = extremes(seen.map((one) => one[side]));
  return (least + most) / 2;
}
