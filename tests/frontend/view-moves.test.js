import assert from "node:assert/strict";
import { test } from "node:test";
import { minus, plus, times } from "../../frontend_assets/lib/vectors.js";
import {
  dragged,
  lookedAt,
  pinched,
  wheeled,
  zeroed,
} from "../../frontend_assets/lib/view-moves.js";
import { eyeOf, numberOf, poseOf, turned } from "../../frontend_assets/lib/view-poses.js";

/** @import { Kind, Triple, View } from "../../frontend_assets/lib/view-poses.js" */

const SIZE = { width: 800, height: 600 };

/** @param {readonly number[]} one @param {readonly number[]} other @param {number} [within] */
function near(one, other, within = 1e-9) {
  const far = one.some((value, at) => !(Math.abs(value - (other[at] ?? Number.NaN)) < within));
  assert.ok(!far && one.length === other.length, `${one} is not ${other}`);
}

/** @param {Kind} kind @param {Record<string, number | boolean | string>} [values] @returns {View} */
const view = (kind, values = {}) => ({ kind, values });
/** @param {View} one @param {...string} names */
const numbers = (one, ...names) => names.map((name) => numberOf(one, name));
/** @param {View} one @param {string} name @returns {Triple} */
const triple = (one, name) =>
  /** @type {Triple} */ (
    /** @type {unknown} */ (["X", "Y", "Z"].map((axis) => numberOf(one, `${name}/${axis}`)))
  );

test("left turns an Orbit by RViz's 0.005 rad for a pixel, no farther than upright", () => {
  const orbit = view("Orbit", { Yaw: 1, Pitch: 0.5 });
  near(numbers(dragged(orbit, "turn", 20, 10, SIZE), "Yaw", "Pitch"), [0.9, 0.55]);
  near(numbers(dragged(orbit, "turn", 0, 900, SIZE), "Pitch"), [Math.PI / 2 - 0.001]);
  near(numbers(dragged(orbit, "turn", 220, 0, SIZE), "Yaw"), [2 * Math.PI - 0.1]);
});

test("middle moves the focal point so that it stays under the mouse", () => {
  const orbit = view("Orbit", { Yaw: 0, Pitch: 0, Distance: 3 });
  const metres = (3 * 2 * Math.tan(Math.PI / 8)) / 600;
  // It looks along -x: y points right in the picture, z up.
  near(triple(dragged(orbit, "move", 60, 30, SIZE), "Focal Point"), [0, -60 * metres, 30 * metres]);
});

test("right zooms by a hundredth of the distance for a pixel, with Shift it goes along the sight", () => {
  const orbit = view("Orbit", { Distance: 5, Yaw: 0, Pitch: 0 });
  near(numbers(dragged(orbit, "zoom", 0, 10, SIZE), "Distance"), [5.5]);
  const lifted = dragged(orbit, "lift", 0, 10, SIZE);
  near([...triple(lifted, "Focal Point"), numberOf(lifted, "Distance")], [0.5, 0, 0, 5]);
});

test("a notch of the wheel comes an eighth nearer, never behind the focal point", () => {
  const orbit = view("Orbit", { Distance: 5, Yaw: 0, Pitch: 0 });
  near(numbers(wheeled(orbit, 120, false), "Distance"), [4.4]);
  near(triple(wheeled(orbit, 120, true), "Focal Point"), [-0.6, 0, 0]);
  const seen = Array.from({ length: 200 }).reduce(
    (/** @type {View} */ one) => wheeled(one, 9e9, false),
    orbit,
  );
  assert.ok(numberOf(seen, "Distance") >= 0.001);
});

test("an XYOrbit drags the ground, and only along it", () => {
  const xy = view("XYOrbit", { Yaw: 0.3, Pitch: 0.8, Distance: 4 });
  const way = triple(dragged(xy, "move", 10, -5, SIZE, [400, 300]), "Focal Point");
  assert.ok(Math.hypot(...way) > 0.001);
  near([way[2]], [0]);
  near(numbers(dragged(xy, "lift", 0, 10, SIZE), "Distance"), [4.4]);
  const above = dragged(xy, "move", 5, 5, SIZE, [400, -9000]);
  assert.deepEqual(above, xy, "at the horizon nothing moves");
});

test("an FPS looks around, strafes and walks as in RViz", () => {
  const fps = view("FPS", { "Position/X": 0, "Position/Y": 0, "Position/Z": 0 });
  near(numbers(dragged(fps, "turn", 10, 20, SIZE), "Yaw", "Pitch"), [2 * Math.PI - 0.05, 0.1]);
  near(triple(dragged(fps, "move", 100, 0, SIZE), "Position"), [0, -1, 0]);
  near(triple(dragged(fps, "zoom", 0, -10, SIZE), "Position"), [1, 0, 0]);
  near(triple(wheeled(fps, 120, false), "Position"), [1.2, 0, 0]);
});

test("a map turns, moves under the mouse and zooms by its scale", () => {
  const map = view("TopDownOrtho", { Scale: 100, Angle: Math.PI / 2, X: 1, Y: 2 });
  near(numbers(dragged(map, "turn", 10, 0, SIZE), "Angle"), [Math.PI / 2 + 0.05]);
  near(numbers(dragged(map, "move", 50, 0, SIZE), "X", "Y"), [1, 1.5]);
  near(numbers(dragged(map, "zoom", 0, 10, SIZE), "Scale"), [90]);
  near(numbers(wheeled(map, 120, false), "Scale"), [112]);
});

test("a locked camera stays where it is", () => {
  const locked = view("FrameAligned", { "Lock Camera": true });
  assert.equal(dragged(locked, "turn", 10, 10, SIZE), locked);
  assert.equal(wheeled(locked, 120, false), locked);
  assert.equal(pinched(locked, 2), locked);
});

test("an aligned camera that is turned points towards no axis any more, and back again", () => {
  const aligned = zeroed(view("FrameAligned"));
  assert.equal(aligned.values["Point towards"], "+x axis");
  const turnedAway = dragged(aligned, "turn", 40, 0, SIZE);
  assert.equal(turnedAway.values["Point towards"], "arbitrary");
  assert.equal(dragged(turnedAway, "turn", -40, 0, SIZE).values["Point towards"], "+x axis");
});

test("two fingers that spread show all twice as large", () => {
  near(numbers(pinched(view("Orbit", { Distance: 4 }), 2), "Distance"), [2]);
  near(numbers(pinched(view("TopDownOrtho", { Scale: 4 }), 2), "Scale"), [8]);
});

test("F turns to a point and stays where it is; a map goes there", () => {
  const point = /** @type {const} */ ([1, 2, 0.5]);
  for (const kind of /** @type {const} */ (["Orbit", "FPS", "ThirdPersonFollower"])) {
    const before = poseOf(view(kind), SIZE);
    const after = poseOf(lookedAt(view(kind), point, SIZE), SIZE);
    near(eyeOf(after), eyeOf(before), 1e-6);
    const way = minus(point, eyeOf(after));
    near(times(way, 1 / Math.hypot(...way)), turned(after.turn, [0, 0, -1]), 1e-6);
  }
  near(numbers(lookedAt(view("TopDownOrtho"), point, SIZE), "X", "Y"), [1, 2]);
  near(triple(lookedAt(view("XYOrbit"), point, SIZE), "Focal Point"), [1, 2, 0]);
});

test("Zero is RViz's: 10 m from the origin, an FPS looks at it from (5, 5, 10)", () => {
  const orbit = zeroed(view("Orbit", { Distance: 1, Yaw: 2, "Target Frame": "odom" }));
  near([...numbers(orbit, "Distance", "Yaw", "Pitch")], [10, Math.PI / 4, Math.PI / 4]);
  assert.equal(orbit.values["Target Frame"], "odom");
  const fps = poseOf(zeroed(view("FPS")), SIZE);
  near(plus(eyeOf(fps), times(turned(fps.turn, [0, 0, -1]), Math.sqrt(150))), [0, 0, 0]);
  near(numbers(zeroed(view("TopDownOrtho", { X: 3, Scale: 99 })), "X", "Scale"), [0, 10]);
});

test("without perspective, what would only walk grows instead", () => {
  const fps = view("FPS", { Orthographic: true, Scale: 100 });
  near(numbers(wheeled(fps, 120, false), "Scale"), [112]);
  near(numbers(dragged(fps, "zoom", 0, 10, SIZE), "Scale"), [90]);
});
