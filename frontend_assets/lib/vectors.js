/** Vectors of three numbers. */

/** @typedef {readonly [number, number, number]} Triple */
/** @typedef {[number, number, number]} Vector */

/** @param {Triple} a @param {Triple} b @returns {Vector} */
export const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/** @param {Triple} a @param {Triple} b @returns {Vector} from b to a */
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {Triple} a @param {number} by @returns {Vector} */
export const times = (a, by) => [a[0] * by, a[1] * by, a[2] * by];
/** @param {Triple} a @param {Triple} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Triple} a @param {Triple} b @returns {Vector} */
export const cross = ([x, y, z], [u, v, w]) => [y * w - z * v, z * u - x * w, x * v - y * u];
/** @param {Triple} a */
export const lengthOf = (a) => Math.hypot(...a);
/** @param {Triple} a @returns {Vector} of length 1 */
export const unit = (a) => times(a, 1 / (lengthOf(a) || 1));
