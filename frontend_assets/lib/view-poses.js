/**
 * RViz's views as numbers: where each has its camera, and which values show the same as another view.
 * Everything is in the frame that the view goes with, in m and rad, with z up; the camera looks along
 * its -z, and its y is up.
 */

import { quaternionOf } from "./frame-pose.js";
import { cross, dot, lengthOf, minus, plus, times, unit } from "./vectors.js";

/** @typedef {readonly [number, number, number]} Triple */
/** @typedef {readonly [number, number, number, number]} Turn a quaternion of length 1: x, y, z, w */
/** @typedef {boolean | number | string} Value */
/** @typedef {Readonly<Record<string, Value>>} Values by RViz's names of properties */
/** @typedef {"Orbit" | "XYOrbit" | "FPS" | "TopDownOrtho" | "ThirdPersonFollower" | "FrameAligned"} Kind */

/**
 * @typedef {object} View
 * @property {Kind} kind
 * @property {Values} values those that are not here have their first values
 * @property {number} [reach] how far away that is what an FPS looks at, m: RViz does not keep it
 */
/** @typedef {{place: Triple, turn: Turn}} Frame where a frame is */
/**
 * A camera that looks at a point.
 * @typedef {object} Pose
 * @property {Triple} focal the point
 * @property {number} distance from the camera to it
 * @property {Turn} turn of the camera
 */
/** @typedef {{width: number, height: number}} Size of the picture, px */

export const FIXED_FRAME = "<Fixed Frame>";
export const TARGET_FRAME = "Target Frame";
export const ORTHOGRAPHIC = "Orthographic";
const QUARTER = Math.PI / 4;
/** RViz's: at a right angle yaw would have no meaning. */
const PITCH_MAX = Math.PI / 2 - 0.001;
export const DISTANCE_MIN = 0.001;
/** An XYOrbit's camera is so far above its line of sight, in distances. */
const ABOVE = 0.2;
export const SHARED = { "Target Frame": FIXED_FRAME, "Near Clip Distance": 0.01 };
const PERSPECTIVE = { ...SHARED, Orthographic: false, "Field of View": QUARTER };
const FOCUSED = {
  ...PERSPECTIVE,
  ...{ "Invert Z Axis": false, Distance: 10, Yaw: QUARTER, Pitch: QUARTER },
  ...{ "Focal Shape Size": 0.05, "Focal Shape Fixed Size": true },
  ...{ "Focal Point/X": 0, "Focal Point/Y": 0, "Focal Point/Z": 0 },
};
const STANDING = {
  ...PERSPECTIVE,
  ...{ Scale: 100, Yaw: 0, Pitch: 0, "Position/X": 5, "Position/Y": 5, "Position/Z": 10 },
};
/** RViz's first values, as `studio/rviz/views.py` tells them. @type {Readonly<Record<Kind, Values>>} */
export const FIRST = {
  Orbit: FOCUSED,
  XYOrbit: FOCUSED,
  FPS: STANDING,
  TopDownOrtho: { ...SHARED, Scale: 10, Angle: 0, X: 0, Y: 0 },
  ThirdPersonFollower: FOCUSED,
  FrameAligned: {
    ...STANDING,
    ...{ "Invert Z Axis": false, "Point towards": "+x axis", "Lock Camera": false },
  },
};

/** @param {unknown} kind @returns {kind is Kind} */
export const isKind = (kind) => typeof kind === "string" && Object.hasOwn(FIRST, kind);

/** @param {View} view @param {string} name @returns {number} */
export function numberOf({ kind, values }, name) {
  const value = values[name] ?? FIRST[kind][name];
  return typeof value === "number" && Number.isFinite(value) ? value : 0;
}

/** @param {View} view @param {string} name */
export const isOn = ({ kind, values }, name) => (values[name] ?? FIRST[kind][name]) === true;

/** @param {View} view @returns {string} empty: with none */
export function targetOf({ values }) {
  const frame = values[TARGET_FRAME] ?? FIXED_FRAME;
  return typeof frame === "string" && frame !== FIXED_FRAME ? frame.replace(/^\//, "") : "";
}

/** @param {View} view */
export const isFlat = (view) => view.kind === "TopDownOrtho" || isOn(view, ORTHOGRAPHIC);

/** The opening angle of the picture from below to above, rad. @param {View} view */
export function fieldOf(view) {
  const field = view.kind === "TopDownOrtho" ? QUARTER : numberOf(view, "Field of View");
  return Math.min(Math.max(field, 0.01), Math.PI - 0.1);
}

/** @param {Kind} kind it orbits a point */
export const orbits = (kind) =>
  kind === "Orbit" || kind === "XYOrbit" || kind === "ThirdPersonFollower";

/* Vectors and turns. */

/** @type {Turn} */
export const NO_TURN = [0, 0, 0, 1];

/** @param {Turn} a @param {Turn} b @returns {Turn} `b` first */
export function product([x, y, z, w], [p, q, r, s]) {
  return [
    w * p + x * s + y * r - z * q,
    w * q - x * r + y * s + z * p,
    w * r + x * q - y * p + z * s,
    w * s - x * p - y * q - z * r,
  ];
}

/** @param {Turn} turn @returns {Turn} */
const inverse = ([x, y, z, w]) => [-x, -y, -z, w];

/** @param {Turn} turn @param {Triple} place @returns {Triple} */
export function turned([x, y, z, w], place) {
  const aside = times(cross([x, y, z], place), 2);
  return plus(plus(place, times(aside, w)), cross([x, y, z], aside));
}

/** The turn of a camera, by where its right, its up and its back point. @param {Triple} right @param {Triple} up @param {Triple} back @returns {Turn} */
function turnOf(right, up, back) {
  return quaternionOf([
    ...[right[0], up[0], back[0], 0],
    ...[right[1], up[1], back[1], 0],
    ...[right[2], up[2], back[2], 0],
  ]);
}

/** Of a camera at `back` from what it looks at. @param {Triple} back @param {Triple} up about @returns {Turn} */
export function lookTurn(back, up) {
  const z = unit(back);
  let x = cross(up, z);
  if (lengthOf(x) < 1e-9) x = cross(Math.abs(z[2]) > 0.9 ? [0, 1, 0] : [0, 0, 1], z);
  x = unit(x);
  return turnOf(x, cross(z, x), z);
}

/** @param {Pose} pose @returns {Triple} */
export const eyeOf = ({ focal, distance, turn }) => plus(focal, turned(turn, [0, 0, distance]));

/** @param {number} angle @returns {number} from 0 to a whole turn, as RViz writes a yaw */
export const wholeTurn = (angle) => angle - 2 * Math.PI * Math.floor(angle / (2 * Math.PI));
/** @param {number} pitch */
export const tipped = (pitch) => Math.min(Math.max(pitch, -PITCH_MAX), PITCH_MAX);

/* Where the camera is. */

/** @param {View} view @param {string} name @returns {Triple} */
export const tripleOf = (view, name) => [
  numberOf(view, `${name}/X`),
  numberOf(view, `${name}/Y`),
  numberOf(view, `${name}/Z`),
];

/** @param {string} name @param {Triple} triple @returns {Values} */
export const tripleValues = (name, [x, y, z]) => ({
  [`${name}/X`]: x,
  [`${name}/Y`]: y,
  [`${name}/Z`]: z,
});

/** Metres from below to above, of one distance. @param {View} view */
export const tallOf = (view) => 2 * Math.tan(fieldOf(view) / 2);

/** From what it looks at, a picture of parallel rays shows as much as one of this distance.
 * @param {View} view @param {Size} size */
const flatDistance = (view, { height }) =>
  height / Math.max(numberOf(view, "Scale"), 1e-6) / tallOf(view);

/** @param {View} view @param {Size} size @returns {Pose} */
export function poseOf(view, size) {
  if (orbits(view.kind)) return orbitPose(view);
  if (view.kind !== "TopDownOrtho") return standingPose(view, size);
  const half = numberOf(view, "Angle") / 2;
  return {
    focal: [numberOf(view, "X"), numberOf(view, "Y"), 0],
    distance: flatDistance(view, size),
    turn: [0, 0, Math.sin(half), Math.cos(half)],
  };
}

/** @param {View} view @returns {Pose} */
export function orbitPose(view) {
  const turn = orbitTurn(view);
  const distance = Math.max(numberOf(view, "Distance"), DISTANCE_MIN);
  const above = view.kind === "XYOrbit" ? turned(turn, [0, ABOVE * distance, 0]) : null;
  const focal = tripleOf(view, "Focal Point");
  return { focal: above ? plus(focal, above) : focal, distance, turn };
}

/** @param {View} view @returns {Turn} */
export function orbitTurn(view) {
  const side = isOn(view, "Invert Z Axis") ? -1 : 1;
  const [yaw, pitch] = [side * numberOf(view, "Yaw"), side * tipped(numberOf(view, "Pitch"))];
  const flat = Math.cos(pitch);
  const back = /** @type {Triple} */ ([
    Math.cos(yaw) * flat,
    Math.sin(yaw) * flat,
    Math.sin(pitch),
  ]);
  return lookTurn(back, [0, 0, side]);
}

/** @param {View} view @param {Size} size @returns {Pose} */
function standingPose(view, size) {
  const turn = standingTurn(numberOf(view, "Yaw"), tipped(numberOf(view, "Pitch")));
  const eye = tripleOf(view, "Position");
  const distance = isFlat(view)
    ? flatDistance(view, size)
    : Math.max(view.reach ?? lengthOf(eye), DISTANCE_MIN);
  return { focal: plus(eye, turned(turn, [0, 0, -distance])), distance, turn };
}

/** Of one that looks along x at first. @param {number} yaw @param {number} pitch @returns {Turn} */
export function standingTurn(yaw, pitch) {
  const [sin, cos, down, level] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return turnOf(
    [sin, -cos, 0],
    [down * cos, down * sin, level],
    [-level * cos, -level * sin, down],
  );
}

/* The same camera by the values of a view. */

/** What views have in common, and keep when another takes over. */
const KEPT = ["Target Frame", "Near Clip Distance", "Invert Z Axis", ORTHOGRAPHIC, "Field of View"];
const OWN = ["Focal Shape Size", "Focal Shape Fixed Size", "Lock Camera"];

/**
 * The view of a kind that shows what a camera shows. Where a kind cannot (a TopDownOrtho looks down),
 * it looks at the same point, and what is there has the same size.
 *
 * @param {Kind} kind @param {Pose} pose @param {View} before whose frame and settings it keeps @param {Size} size
 * @returns {View}
 */
export function viewOf(kind, pose, before, size) {
  const view = { kind, values: keptValues(kind, before) };
  if (orbits(kind)) return withValues(view, orbitValues(view, pose));
  if (kind === "TopDownOrtho") {
    const [X, Y] = pose.focal;
    const Scale = size.height / (pose.distance * tallOf(before));
    const Angle = before.kind === kind ? numberOf(before, "Angle") : 0;
    return withValues(view, { Scale, Angle, X, Y });
  }
  const values = { ...standingValues(pose.turn), ...tripleValues("Position", eyeOf(pose)) };
  const Scale = size.height / (pose.distance * tallOf(view));
  const stands = withValues(view, isFlat(view) ? { ...values, Scale } : values);
  return { ...(kind === "FrameAligned" ? pointed(stands) : stands), reach: pose.distance };
}

/** @param {View} view @param {Values} values @returns {View} */
export const withValues = (view, values) => ({ ...view, values: { ...view.values, ...values } });

/** @param {Kind} kind @param {View} before @returns {Values} */
function keptValues(kind, before) {
  const names = before.kind === kind ? [...KEPT, ...OWN] : KEPT;
  const kept = names.filter((name) => name in FIRST[kind] && name in before.values);
  return Object.fromEntries(kept.map((name) => [name, /** @type {Value} */ (before.values[name])]));
}

/** @param {View} view @param {Pose} pose @returns {Values} */
function orbitValues(view, pose) {
  const on = view.kind === "XYOrbit" ? groundPose(pose) : pose;
  const side = isOn(view, "Invert Z Axis") ? -1 : 1;
  const back = turned(on.turn, [0, 0, 1]);
  const [yaw, pitch] = anglesOf(back, turned(on.turn, [0, 1, 0]), side);
  return {
    Distance: Math.max(on.distance, DISTANCE_MIN),
    Yaw: wholeTurn(side * yaw),
    Pitch: tipped(side * pitch),
    ...tripleValues("Focal Point", on.focal),
  };
}

/** Where an Orbit is around its focal point. Above or below it, where yaw has no meaning, the top of
 * the picture says which. @param {Triple} back @param {Triple} up @param {number} side -1: z points down
 * @returns {[number, number]} yaw and pitch */
export function anglesOf(back, up, side) {
  const pitch = Math.asin(Math.min(Math.max(back[2], -1), 1));
  if (Math.hypot(back[0], back[1]) > 1e-6) return [Math.atan2(back[1], back[0]), pitch];
  const away = Math.sign(back[2]) * side;
  return [Math.atan2(-away * up[1], -away * up[0]), pitch];
}

/** @param {Turn} turn @returns {Values} */
export function standingValues(turn) {
  const ahead = turned(turn, [0, 0, -1]);
  const up = turned(turn, [0, 1, 0]);
  const pitch = Math.asin(Math.min(Math.max(-ahead[2], -1), 1));
  const isLevel = Math.hypot(ahead[0], ahead[1]) > 1e-6;
  const [x, y] = isLevel ? ahead : times(up, Math.sign(pitch));
  return { Yaw: wholeTurn(Math.atan2(y, x)), Pitch: tipped(pitch) };
}

/** The point on the ground about which an XYOrbit shows the same; where no ground is seen, the point
 * below what is looked at. @param {Pose} pose @returns {Pose} */
function groundPose({ focal, distance, turn }) {
  const eye = plus(focal, turned(turn, [0, 0, distance]));
  const up = turned(turn, [0, 1, 0]);
  const ahead = turned(turn, [0, 0, -1]);
  const [along, below] = [groundAlong(eye, ahead), groundAlong(eye, times(up, -1))];
  if (along === null || below === null) return { focal: [focal[0], focal[1], 0], distance, turn };
  const near = (along * below) / (ABOVE * along + below);
  const lowered = minus(eye, times(up, ABOVE * near));
  const way = groundAlong(lowered, ahead) ?? near;
  return { focal: plus(lowered, times(ahead, way)), distance: way, turn };
}

/** @param {Triple} from @param {Triple} direction @returns {number | null} how far the ground is; null: not that way */
export function groundAlong(from, direction) {
  const way = -from[2] / direction[2];
  return Number.isFinite(way) && way >= 0 ? way : null;
}

/* Along an axis of a frame. */

/** @type {Readonly<Record<string, Triple>>} */
const AXES = {
  "+x axis": [1, 0, 0],
  "-x axis": [-1, 0, 0],
  "+y axis": [0, 1, 0],
  "-y axis": [0, -1, 0],
  "+z axis": [0, 0, 1],
  "-z axis": [0, 0, -1],
};
/** Any that is no axis. */
const ARBITRARY = "arbitrary";
const ALONG = 1 - 1e-4;

/** Turned upside down, y and z point the other way. @param {View} view @param {string} name @returns {Triple | null} */
function axisNamed(view, name) {
  const [x, y, z] = AXES[name] ?? [0, 0, 0];
  if (x === 0 && y === 0 && z === 0) return null;
  return isOn(view, "Invert Z Axis") ? [x, -y, -z] : [x, y, z];
}

/** The axis of its frame that it looks along, or nearest to, and the cosine between them.
 * @param {View} view @returns {[string, number]} */
export function axisOf(view) {
  const turn = standingTurn(numberOf(view, "Yaw"), tipped(numberOf(view, "Pitch")));
  const ahead = turned(turn, [0, 0, -1]);
  /** @type {[string, number]} */
  let best = ["", -1];
  for (const name of Object.keys(AXES)) {
    const along = dot(axisNamed(view, name) ?? [0, 0, 0], ahead);
    if (along > best[1]) best = [name, along];
  }
  return best;
}

/** With the axis that it looks along. @param {View} view @returns {View} */
export function pointed(view) {
  if (view.kind !== "FrameAligned") return view;
  const [axis, along] = axisOf(view);
  return withValues(view, { "Point towards": along > ALONG ? axis : ARBITRARY });
}

/** A FrameAligned that looks along an axis, with the frame's origin before it.
 * @param {View} view @param {string} axis @param {number} [distance] without: as far as it is @returns {View} */
export function towards(
  view,
  axis,
  distance = Math.max(lengthOf(tripleOf(view, "Position")), 0.1),
) {
  const ahead = axisNamed(view, axis);
  if (!ahead) return withValues(view, { "Point towards": ARBITRARY });
  const turn = lookTurn(
    times(ahead, -1),
    ahead[2] === 0 ? [0, 0, 1] : [ahead[2] < 0 ? 1 : -1, 0, 0],
  );
  const values = { ...standingValues(turn), ...tripleValues("Position", times(ahead, -distance)) };
  return { ...withValues(view, { ...values, "Point towards": axis }), reach: distance };
}

/* The frame that a view goes with. */

/** What of a frame a view goes with: all with its place, some with its turns.
 * @param {View} view @param {Frame} frame @returns {Frame} */
export function followed(view, { place, turn }) {
  if (view.kind === "ThirdPersonFollower") {
    const [x, y, z, w] = turn;
    const half = Math.atan2(2 * (x * y + w * z), w * w + x * x - y * y - z * z) / 2;
    return { place, turn: [0, 0, Math.sin(half), Math.cos(half)] };
  }
  if (view.kind !== "FrameAligned") return { place, turn: NO_TURN };
  return { place, turn: isOn(view, "Invert Z Axis") ? product(turn, [1, 0, 0, 0]) : turn };
}

/** @param {Frame} frame @param {Pose} pose in it @returns {Pose} where the frame is */
export const outOf = (frame, { focal, distance, turn }) => ({
  focal: plus(frame.place, turned(frame.turn, focal)),
  distance,
  turn: product(frame.turn, turn),
});

/** @param {Frame} frame @param {Pose} pose @returns {Pose} in the frame */
export const into = (frame, { focal, distance, turn }) => ({
  focal: placeIn(frame, focal),
  distance,
  turn: product(inverse(frame.turn), turn),
});

/** @param {Frame} frame @param {Triple} place @returns {Triple} in the frame */
export const placeIn = (frame, place) => turned(inverse(frame.turn), minus(place, frame.place));

/* From one view to another. */

/** @param {Turn} a @param {Turn} b @param {number} part @returns {Turn} the shorter way between them */
function between([x, y, z, w], b, part) {
  const cosine = x * b[0] + y * b[1] + z * b[2] + w * b[3];
  const side = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(Math.abs(cosine), 1));
  const sine = Math.sin(angle);
  const [p, q] =
    sine < 1e-6
      ? [1 - part, part]
      : [Math.sin((1 - part) * angle) / sine, Math.sin(part * angle) / sine];
  const mixed = [x, y, z, w].map((one, at) => p * one + q * side * /** @type {number} */ (b[at]));
  const length = Math.hypot(...mixed) || 1;
  return /** @type {[number, number, number, number]} */ (mixed.map((one) => one / length));
}

/** A camera on its way. @param {Pose} a @param {Pose} b @param {number} part 0: at `a`, 1: at `b` @returns {Pose} */
export const poseBetween = (a, b, part) => ({
  focal: plus(times(a.focal, 1 - part), times(b.focal, part)),
  distance: a.distance ** (1 - part) * b.distance ** part,
  turn: between(a.turn, b.turn, part),
});

/** The same point from another side. @param {Triple} direction from the point to the eye, in the frame with z up @returns {Turn} */
export function turnFrom(direction) {
  const [x, y, z] = unit(direction);
  const yaw = Math.hypot(x, y) > 1e-6 ? Math.atan2(y, x) : -Math.PI / 2;
  const pitch = tipped(Math.asin(z));
  return orbitTurn({ kind: "Orbit", values: { Yaw: yaw, Pitch: pitch } });
}
