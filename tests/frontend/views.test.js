import assert from "node:assert/strict";
import { test } from "node:test";
import { minus } from "../../frontend_assets/lib/vectors.js";
import {
  cellsOf,
  cubeTransform,
  FACES,
  nearestSide,
  stepped,
} from "../../frontend_assets/lib/view-cube.js";
import { fitting } from "../../frontend_assets/lib/view-fit.js";
import { eyeOf, turned, turnFrom } from "../../frontend_assets/lib/view-poses.js";
import { propertyRows } from "../../frontend_assets/panels/views/views.js";

/** @import { PropertyView } from "../../frontend_assets/types/wire.d.ts" */
/** @import { Triple, Turn } from "../../frontend_assets/lib/view-poses.js" */

/** @param {string} name @param {Partial<PropertyView>} [more] @returns {PropertyView} */
const property = (name, more = {}) => ({
  ...{ name, kind: "number", default: 0, doc: "", low: null, high: null, unit: "" },
  ...{ choices: [], when: "", when_values: [], ...more },
});

test("the three numbers of a place share a row, and what has no effect has none", () => {
  const properties = [
    property("Distance"),
    ...["X", "Y", "Z"].map((axis) => property(`Focal Point/${axis}`)),
    property("Scale", { when: "Orthographic", when_values: [true] }),
  ];
  const rows = (/** @type {unknown} */ now) =>
    propertyRows(properties, () => now).map(({ label, properties: { length } }) => [label, length]);
  assert.deepEqual(rows(false), [
    ["Distance", 1],
    ["Focal Point", 3],
  ]);
  assert.deepEqual(rows(true).at(-1), ["Scale", 1]);
});

test("the cube leads to 26 places, an edge is on two faces and a corner on three", () => {
  const all = FACES.flatMap((face) => cellsOf(face).map(({ direction }) => direction.join()));
  const counts = new Map();
  for (const one of all) counts.set(one, (counts.get(one) ?? 0) + 1);
  assert.equal(counts.size, 26);
  assert.equal(counts.get("1,0,0"), 1);
  assert.equal(counts.get("1,1,0"), 2);
  assert.equal(counts.get("1,-1,1"), 3);
  const front = cellsOf(/** @type {typeof FACES[number]} */ (FACES[0]));
  assert.deepEqual(front[0]?.direction, [1, -1, 1], "first is what is seen above, at the left");
  assert.deepEqual(front[4], { direction: [1, 0, 0], isMiddle: true });
});

test("the face is named that is seen best", () => {
  assert.equal(nearestSide(turnFrom([1, 0.2, 0.1])), "front");
  assert.equal(nearestSide(turnFrom([0.1, -1, 0.1])), "right");
  assert.equal(nearestSide(turnFrom([0, 0, -1])), "bottom");
});

test("the cube is turned so that what faces the eye is in front", () => {
  const numbers = (/** @type {Turn} */ turn) =>
    (/\((.+?)\)/.exec(cubeTransform(turn))?.[1] ?? "").split(",").map(Number);
  // From the front, x comes towards us, y points right and z up, which in CSS is less.
  const m = numbers(turnFrom([1, 0, 0]));
  assert.deepEqual(
    [m.slice(0, 3), m.slice(4, 7), m.slice(8, 11)].map((one) => one.map((part) => part + 0)),
    [
      [0, 0, 1],
      [1, 0, 0],
      [0, -1, 0],
    ],
  );
});

/** @param {Triple} from @param {...string} keys @returns {Triple} where the eye is then */
const after = (from, ...keys) => {
  let turn = turnFrom(from);
  for (const key of keys) turn = turnFrom(stepped(turn, key) ?? [0, 0, 0]);
  return turned(turn, [0, 0, 1]);
};

/** @param {readonly number[]} one @param {readonly number[]} other @param {number} [within] */
const near = (one, other, within = 1e-9) =>
  assert.ok(
    one.every((part, at) => Math.abs(part - (other[at] ?? 9)) < within),
    `${one} is not ${other}`,
  );

test("arrow keys go on by an eighth of a turn, up to the pole and back again", () => {
  const half = Math.SQRT1_2;
  near(after([1, 0, 0], "ArrowRight"), [half, half, 0]);
  near(after([1, 0, 0], "ArrowLeft", "ArrowLeft"), [0, -1, 0]);
  near(after([1, 0, 0], "ArrowUp"), [half, 0, half]);
  near(after([0, 1, 0], "ArrowUp", "ArrowUp", "ArrowUp"), [0, 0, 1], 0.002);
  near(after([0, 1, 0], "ArrowUp", "ArrowUp", "ArrowDown", "ArrowDown"), [0, 1, 0], 0.002);
  assert.equal(stepped(turnFrom([1, 0, 0]), "a"), null);
});

const BOX = [-1, 1].flatMap((x) =>
  [-2, 2].flatMap((y) => [0, 1].map((z) => /** @type {Triple} */ ([x + 5, y, z]))),
);

for (const flat of [false, true])
  test(`what is fitted fills its part of the picture ${flat ? "without perspective" : "with it"}`, () => {
    const turn = turnFrom([1, -0.8, 0.62]);
    const picture = { field: 0.8, aspect: 1.5, fill: 0.5, flat };
    const pose = fitting(BOX, turn, picture);
    const back = /** @type {Turn} */ ([-turn[0], -turn[1], -turn[2], turn[3]]);
    const seen = BOX.map((corner) => {
      const [x, y, z] = turned(back, minus(corner, eyeOf(pose)));
      const far = Math.tan(0.4) * (flat ? pose.distance : -z);
      return [x / far / 1.5, y / far];
    });
    const [xs, ys] = [seen.map(([x]) => x ?? 9), seen.map(([, y]) => y ?? 9)];
    for (const side of [xs, ys])
      assert.ok(Math.abs(Math.max(...side) + Math.min(...side)) < 0.02, "in the middle");
    assert.ok(Math.abs(Math.max(...xs, ...ys) - 0.5) < 0.02);
  });
