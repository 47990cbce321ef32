import assert from "node:assert/strict";
import { test } from "node:test";
import { boxOf, fromHalf, placesOf } from "../../frontend_assets/viser/extent.js";

/** @param {number} count @param {(at: number) => [number, number, number]} place @returns {[number, number, number][]} */
const places = (count, place) => Array.from({ length: count }, (_, at) => place(at));

test("a box is around all that is near, and around nothing there is none", () => {
  const { NaN: nan, POSITIVE_INFINITY: infinite } = Number;
  assert.deepEqual(
    boxOf([
      [1, -2, 3],
      [-1, 5, 0],
      [nan, 0, 0],
      [0, infinite, 0],
      [0, 0, 3e30],
    ]),
    [
      [-1, -2, 0],
      [1, 5, 3],
    ],
  );
  assert.equal(boxOf([[nan, nan, nan]]), null);
  assert.equal(boxOf([]), null);
});

test("a few strays of many points are not waited for, and few points are all there are", () => {
  const line = places(1000, (at) => [at / 1000, 0, 0]);
  const [least, most] = boxOf([...line, [900, 900, 900], [-900, 0, 0]]) ?? [];
  assert.ok(least && most && least[0] >= 0 && most[0] < 1);
  assert.deepEqual(boxOf([...line.slice(0, 50), [900, 0, 0]])?.[1], [900, 0, 0]);
});

test("points of either precision are where they are, and of many some are looked at", () => {
  const whole = new Float32Array([1, 2, 3, 4, 5, 6]);
  assert.deepEqual(placesOf({ points: whole }), [
    [1, 2, 3],
    [4, 5, 6],
  ]);
  assert.deepEqual(placesOf({ points: new Uint16Array([0x3c00, 0xc000, 0x3555]) }), [
    [1, -2, 0.333251953125],
  ]);
  const found = placesOf({ points: new Float32Array(3 * 1_000_000) }).length;
  assert.ok(found > 3000 && found <= 4000);
});

test("half precision has small numbers, none, and what has no end", () => {
  assert.equal(fromHalf(0x0001), 2 ** -24);
  assert.equal(fromHalf(0x8400), -(2 ** -14));
  assert.equal(fromHalf(0x7bff), 65504);
  assert.equal(fromHalf(0xfc00), Number.NEGATIVE_INFINITY);
  assert.ok(Number.isNaN(fromHalf(0x7e00)));
});

test("a solid reaches as far as its turned and scaled corners", () => {
  const half = Math.SQRT1_2;
  const box = boxOf(
    placesOf({
      vertices: [-0.5, -0.5, -0.5, 0.5, 0.5, 0.5],
      batched_positions: [10, 0, 0],
      batched_scales: [4, 2, 1],
      batched_wxyzs: [half, 0, 0, half],
    }),
  );
  const rounded = box?.map((corner) => corner.map((part) => Math.round(part * 1e6) / 1e6));
  assert.deepEqual(rounded, [
    [9, -2, -0.5],
    [11, 2, 0.5],
  ]);
});

test("a cross reaches to the ends of its axes, and what is of no known size is a place", () => {
  const [least, most] = boxOf(placesOf({ batched_positions: [1, 1, 1], axes_length: 2 })) ?? [];
  assert.deepEqual(
    [least, most],
    [
      [1, 1, 1],
      [3, 3, 3],
    ],
  );
  assert.deepEqual(placesOf({ batched_positions: [1, 1, 1] }), [[1, 1, 1]]);
  assert.deepEqual(placesOf({}), []);
});
