import assert from "node:assert/strict";
import { test } from "node:test";
import { lineOfGrid, nearestPoint, nearestSegment } from "../../frontend_assets/viser/surface.js";

/** @param {number} x @param {number} y @param {number} z @returns {any} what a ray needs of a vector */
const vector = (x, y, z) => ({ x, y, z });
/** From above, straight down. @param {number} x @param {number} y */
const down = (x, y) => ({ origin: vector(x, y, 10), direction: vector(0, 0, -1) });
/** A pixel is a millimetre wide for each metre of distance. */
const PIXEL = { base: 0, slope: 0.001 };

test("of the points under the mouse the nearest to the eye is met, none behind it", () => {
  const points = new Float32Array([0, 0, 0, 0, 0, 2, 0.5, 0, 5, 0, 0, 11]);
  assert.deepEqual(nearestPoint({ points }, down(0, 0), PIXEL), {
    distance: 8,
    part: 1,
    at: [0, 0, 2],
  });
  assert.equal(nearestPoint({ points }, down(0.25, 0), PIXEL), null);
  assert.equal(nearestPoint({ points: new Float32Array() }, down(0, 0), PIXEL), null);
  assert.equal(nearestPoint({}, down(0, 0), PIXEL), null);
});

test("a point is met within four pixels, or within what is drawn of it", () => {
  const points = new Float32Array([0, 0, 0]);
  assert.notEqual(nearestPoint({ points }, down(0.039, 0), PIXEL), null);
  assert.equal(nearestPoint({ points }, down(0.041, 0), PIXEL), null);
  assert.notEqual(nearestPoint({ points, point_size: 0.2 }, down(0.19, 0), PIXEL), null);
  assert.notEqual(nearestPoint({ points }, down(0.039, 0), { base: 0.01, slope: 0 }), null);
});

test("what is drawn of a point may be pixels, or grow with its z", () => {
  const points = new Float32Array([0, 0, 2]);
  const cloud = { points, point_size: 0.1 };
  const met = (/** @type {number} */ x, /** @type {object} */ more) =>
    nearestPoint({ ...cloud, ...more }, down(x, 0), PIXEL);
  assert.notEqual(met(0.19, { studio_size_by_z: true }), null);
  assert.equal(met(0.19, {}), null);
  assert.notEqual(met(0.07, { studio_point_px: 20 }), null);
  assert.equal(met(0.09, { studio_point_px: 20 }), null);
});

test("points that are nowhere are passed over, and half precision is read", () => {
  const points = new Float32Array([Number.NaN, 0, 0, 0, 0, 1]);
  assert.equal(nearestPoint({ points }, down(0, 0), PIXEL)?.part, 1);
  const half = new Uint16Array([0, 0, 0x3c00]);
  assert.deepEqual(nearestPoint({ points: half }, down(0, 0), PIXEL)?.at, [0, 0, 1]);
});

test("a line is met where the mouse is, and not beyond its ends", () => {
  const points = new Float32Array([-1, 0, 0, 1, 0, 0]);
  const met = nearestSegment(points, down(0.5, 0.01), PIXEL);
  assert.deepEqual([met?.part, met?.distance], [0, 10]);
  assert.ok(Math.abs((met?.at[0] ?? 0) - 0.5) < 1e-9);
  assert.equal(nearestSegment(points, down(1.1, 0), PIXEL), null);
  assert.equal(nearestSegment(points, down(0, 0.1), PIXEL), null);
  // Seen end-on it is met at its nearer end.
  const upright = new Float32Array([0, 0, 0, 0, 0, 4]);
  assert.deepEqual(nearestSegment(upright, down(0, 0), PIXEL)?.at, [0, 0, 4]);
});

test("of a grid its lines are met, and nothing between them", () => {
  assert.deepEqual(lineOfGrid(0.5, down(1.01, 0.2), PIXEL), { distance: 10, part: null });
  assert.equal(lineOfGrid(0.5, down(1.2, 0.2), PIXEL), null);
  const up = { origin: vector(1, 0, 10), direction: vector(0, 0, 1) };
  assert.equal(lineOfGrid(0.5, up, PIXEL), null);
  const level = { origin: vector(1, 0, 10), direction: vector(1, 0, 0) };
  assert.equal(lineOfGrid(0.5, level, PIXEL), null);
});
