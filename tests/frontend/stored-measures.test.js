import assert from "node:assert/strict";
import { test } from "node:test";
import { MEASURES_MOST, readMeasures } from "../../frontend_assets/model/measuring.js";

const FRAME = { kind: "frame", link: "base" };
const AXIS = { kind: "axis", link: "arm", joint: "lift" };
const POINT = { kind: "point", link: "base", at: [0, 0.1, 2], normal: [0, 0, 1] };

test("what was measured is there again as it was", () => {
  const stored = JSON.parse(
    JSON.stringify([
      [FRAME, AXIS],
      [POINT, FRAME, AXIS],
    ]),
  );
  assert.deepEqual(readMeasures(stored), [
    [FRAME, AXIS],
    [POINT, FRAME, AXIS],
  ]);
});

test("a measure with an end that is none is left out, the others stay", () => {
  const bad = [
    [FRAME, { kind: "point", link: "base", at: [0, null, 1] }],
    [FRAME, { kind: "axis", link: "arm" }],
    [FRAME, { kind: "other", link: "arm" }],
    [FRAME, { kind: "frame", link: 3 }],
    [FRAME],
    [FRAME, null],
    "text",
    null,
  ];
  assert.deepEqual(readMeasures([...bad, [FRAME, AXIS]]), [[FRAME, AXIS]]);
});

test("what is no list holds no measures", () => {
  for (const stored of [undefined, null, 3, "x", { length: 2 }]) {
    assert.deepEqual(readMeasures(stored), []);
  }
});

test("a point without a direction stays one", () => {
  const [ends] = readMeasures([[{ ...POINT, normal: "up" }, FRAME]]);
  assert.deepEqual(ends?.[0], { ...POINT, normal: null });
});

test("a list without end is read up to a number", () => {
  const stored = Array.from({ length: MEASURES_MOST + 5 }, () => [FRAME, AXIS]);
  assert.equal(readMeasures(stored).length, MEASURES_MOST);
});
