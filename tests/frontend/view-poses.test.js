import assert from "node:assert/strict";
import { test } from "node:test";
import { lengthOf, minus, times } from "../../frontend_assets/lib/vectors.js";
import {
  eyeOf,
  FIRST,
  followed,
  into,
  isFlat,
  numberOf,
  outOf,
  poseBetween,
  poseOf,
  product,
  targetOf,
  towards,
  turned,
  turnFrom,
  viewOf,
} from "../../frontend_assets/lib/view-poses.js";

/** @import { Kind, Pose, Triple, Turn, View } from "../../frontend_assets/lib/view-poses.js" */

const SIZE = { width: 800, height: 600 };
const { sin, cos, tan, PI } = Math;

/** @param {readonly number[]} one @param {readonly number[]} other @param {number} [within] */
function near(one, other, within = 1e-9) {
  const far = one.some((value, at) => !(Math.abs(value - (other[at] ?? Number.NaN)) < within));
  assert.ok(!far && one.length === other.length, `${one} is not ${other}`);
}

/** @param {Kind} kind @param {Record<string, number | boolean | string>} [values] @returns {View} */
const view = (kind, values = {}) => ({ kind, values });

/** @param {View} one @returns {{eye: Triple, ahead: Triple, up: Triple}} */
function camera(one) {
  const pose = poseOf(one, SIZE);
  const { turn } = pose;
  return { eye: eyeOf(pose), ahead: turned(turn, [0, 0, -1]), up: turned(turn, [0, 1, 0]) };
}

/** @param {Pose} a @param {Pose} b @param {number} [within] */
function same(a, b, within = 1e-6) {
  near(eyeOf(a), eyeOf(b), within);
  for (const axis of /** @type {const} */ ([
    [0, 1, 0],
    [0, 0, -1],
  ]))
    near(turned(a.turn, axis), turned(b.turn, axis), within);
}

test("an Orbit's eye is where RViz computes it, and looks at its focal point with z up", () => {
  const [yaw, pitch, distance] = [0.5, 0.3, 4];
  const focal = /** @type {const} */ ([1, -2, 0.5]);
  const { eye, ahead, up } = camera(
    view("Orbit", {
      ...{ Yaw: yaw, Pitch: pitch, Distance: distance },
      ...{ "Focal Point/X": 1, "Focal Point/Y": -2, "Focal Point/Z": 0.5 },
    }),
  );
  near(eye, [
    1 + distance * cos(yaw) * cos(pitch),
    -2 + distance * sin(yaw) * cos(pitch),
    0.5 + distance * sin(pitch),
  ]);
  near(ahead, times(minus(focal, eye), 1 / distance));
  assert.ok(up[2] > 0.9);
  assert.ok(eye[2] > 0.5, "a pitch of more than 0 looks down");
});

test("the first values are RViz's: 10 m away at an eighth of a turn, the focal point at the origin", () => {
  const { eye } = camera(view("Orbit"));
  near(eye, [5, 5, 10 * sin(PI / 4)]);
  assert.equal(numberOf(view("FPS"), "Position/Z"), 10);
  assert.equal(targetOf(view("FPS")), "");
  assert.equal(targetOf(view("FPS", { "Target Frame": "/base_link" })), "base_link");
});

test("upside down, an Orbit is on the other side of the ground, and z points down in the picture", () => {
  const values = { Yaw: 0.4, Pitch: 0.6, Distance: 2 };
  const upright = camera(view("Orbit", values));
  const inverted = camera(view("Orbit", { ...values, "Invert Z Axis": true }));
  near(inverted.eye, [upright.eye[0], -upright.eye[1], -upright.eye[2]]);
  assert.ok(inverted.up[2] < -0.5);
});

test("an XYOrbit's camera is a fifth of its distance higher in the picture", () => {
  const values = { Yaw: 1, Pitch: 0.7, Distance: 5 };
  const [orbit, xy] = [camera(view("Orbit", values)), camera(view("XYOrbit", values))];
  near(
    xy.eye,
    [0, 1, 2].map((at) => (orbit.eye[at] ?? 0) + (orbit.up[at] ?? 0)),
  );
  near(xy.ahead, orbit.ahead);
});

test("an FPS looks along its yaw, and below the horizon by its pitch", () => {
  const [yaw, pitch] = [2, 0.4];
  const { eye, ahead, up } = camera(
    view("FPS", { Yaw: yaw, Pitch: pitch, "Position/X": 1, "Position/Y": 2, "Position/Z": 3 }),
  );
  near(eye, [1, 2, 3]);
  near(ahead, [cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), -sin(pitch)]);
  near(up, [cos(yaw) * sin(pitch), sin(yaw) * sin(pitch), cos(pitch)]);
});

test("a TopDownOrtho looks down with as many pixels for a metre as its scale, turned by its angle", () => {
  const seen = view("TopDownOrtho", { Scale: 50, Angle: PI / 6, X: 3, Y: 4 });
  const pose = poseOf(seen, SIZE);
  assert.ok(isFlat(seen));
  near(turned(pose.turn, [0, 0, -1]), [0, 0, -1]);
  near(turned(pose.turn, [1, 0, 0]), [cos(PI / 6), sin(PI / 6), 0]);
  near(pose.focal, [3, 4, 0]);
  near([2 * pose.distance * tan(PI / 8)], [SIZE.height / 50]);
});

/** @type {Pose[]} */
const POSES = Array.from({ length: 12 }, (_, at) => ({
  focal: [sin(at), cos(3 * at), 0.3 * sin(5 * at)],
  distance: 1 + (at % 5),
  turn: turnFrom([sin(7 * at), cos(7 * at), sin(2 * at) * 1.5 + (at % 2 ? 0.2 : 0)]),
}));

test("the values of a view that takes over show the same as the one before", () => {
  for (const kind of /** @type {const} */ (["Orbit", "ThirdPersonFollower", "FPS"])) {
    for (const pose of POSES) {
      const taken = viewOf(kind, pose, view("Orbit"), SIZE);
      same(poseOf(taken, SIZE), pose);
      near(poseOf(taken, SIZE).focal, pose.focal, 1e-6);
    }
  }
});

test("upside down, too", () => {
  const before = view("Orbit", { "Invert Z Axis": true, Yaw: 1, Pitch: 0.5, Distance: 3 });
  const pose = poseOf(before, SIZE);
  same(poseOf(viewOf("Orbit", pose, before, SIZE), SIZE), pose);
});

test("an XYOrbit that takes over has its focal point on the ground, and the same camera", () => {
  /** @type {Pose} */
  const pose = { focal: [1, 0.5, 0.4], distance: 3, turn: turnFrom([1, -0.8, 0.62]) };
  const taken = viewOf("XYOrbit", pose, view("Orbit"), SIZE);
  assert.ok(Math.abs(numberOf(taken, "Focal Point/Z")) < 1e-9);
  same(poseOf(taken, SIZE), pose);
});

test("one that sees no ground is taken to the point below what it looked at", () => {
  /** @type {Pose} */
  const pose = { focal: [1, 2, 3], distance: 2, turn: turnFrom([1, 0, -0.5]) };
  const taken = viewOf("XYOrbit", pose, view("Orbit"), SIZE);
  near(
    ["X", "Y", "Z"].map((axis) => numberOf(taken, `Focal Point/${axis}`)),
    [1, 2, 0],
  );
});

test("a map keeps the point in the middle, and the size of what is there", () => {
  const pose = /** @type {Pose} */ (POSES[4]);
  const taken = viewOf("TopDownOrtho", pose, view("Orbit", { Pitch: 0.2 }), SIZE);
  near(
    [numberOf(taken, "X"), numberOf(taken, "Y"), numberOf(taken, "Angle")],
    [pose.focal[0], pose.focal[1], 0],
  );
  near([poseOf(taken, SIZE).distance], [pose.distance]);
  const back = viewOf("Orbit", poseOf(taken, SIZE), taken, SIZE);
  near([numberOf(back, "Distance")], [pose.distance]);
  assert.ok(numberOf(back, "Pitch") > 1.569);
  near(camera(back).up, [0, 1, 0], 0.01);
});

test("what views have in common is kept when another takes over, and their frame", () => {
  const before = view("FPS", {
    ...{ "Target Frame": "base_link", "Near Clip Distance": 0.2, Orthographic: true },
    "Field of View": 0.9,
  });
  const { values } = viewOf("Orbit", poseOf(before, SIZE), before, SIZE);
  assert.deepEqual(
    ["Target Frame", "Near Clip Distance", "Orthographic", "Field of View"].map(
      (one) => values[one],
    ),
    ["base_link", 0.2, true, 0.9],
  );
});

/** @type {Turn} yaw of 0.7 after a tilt of 0.3 about y */
const TILTED = product([0, 0, sin(0.35), cos(0.35)], [0, sin(0.15), 0, cos(0.15)]);
const FRAME = { place: /** @type {const} */ ([4, 5, 6]), turn: TILTED };

test("an Orbit goes with the place of its frame, a follower turns with it, upright", () => {
  assert.deepEqual(followed(view("Orbit"), FRAME), { place: [4, 5, 6], turn: [0, 0, 0, 1] });
  near(followed(view("ThirdPersonFollower"), FRAME).turn, [0, 0, sin(0.35), cos(0.35)]);
});

test("one aligned with its frame tilts with it, upside down if it is told so", () => {
  assert.deepEqual(followed(view("FrameAligned"), FRAME), FRAME);
  const inverted = followed(view("FrameAligned", { "Invert Z Axis": true }), FRAME);
  near(turned(inverted.turn, [0, 0, 1]), times(turned(TILTED, [0, 0, 1]), -1));
});

test("into a frame and out of it again nothing moves", () => {
  for (const pose of POSES) same(outOf(FRAME, into(FRAME, pose)), pose);
});

test("one that points towards an axis looks along it at the origin of its frame", () => {
  for (const [axis, along] of Object.entries({
    "+x axis": [1, 0, 0],
    "-x axis": [-1, 0, 0],
    "+y axis": [0, 1, 0],
    "-z axis": [0, 0, -1],
  })) {
    const seen = towards(view("FrameAligned"), axis, 5);
    const { eye, ahead } = camera(seen);
    near(ahead, along, 0.002);
    near(eye, times(/** @type {Triple} */ (/** @type {unknown} */ (along)), -5));
    assert.equal(seen.values["Point towards"], axis);
  }
});

test("its y axis is the frame's own when z is turned upside down", () => {
  const seen = towards(view("FrameAligned", { "Invert Z Axis": true }), "+y axis", 2);
  const { turn } = followed(seen, { place: [0, 0, 0], turn: [0, 0, 0, 1] });
  near(turned(turn, camera(seen).ahead), [0, 1, 0], 0.002);
});

test("on its way a camera is between both, and at its ends at each", () => {
  const [a, b] = /** @type {[Pose, Pose]} */ ([POSES[1], POSES[2]]);
  same(poseBetween(a, b, 0), a);
  same(poseBetween(a, b, 1), b);
  const half = poseBetween(a, b, 0.5);
  near([half.distance], [Math.sqrt(a.distance * b.distance)]);
  near([lengthOf(turned(half.turn, [0, 0, 1]))], [1]);
});

test("from above, x points right and y up, as on a map", () => {
  near(turned(turnFrom([0, 0, 1]), [0, 1, 0]), [0, 1, 0], 0.01);
  near(turned(turnFrom([0, 0, 1]), [1, 0, 0]), [1, 0, 0], 0.01);
});

test("every kind has first values for all that it reads", () => {
  for (const kind of /** @type {Kind[]} */ (Object.keys(FIRST)))
    for (const number of [...eyeOf(poseOf(view(kind), SIZE))]) assert.ok(Number.isFinite(number));
});
