/** What a hand does to a view, as in RViz: what it drags, the wheel, two fingers, and the keys F and Z. */

/** @import { Pose, Size, Triple, Value, View } from "./view-poses.js" */

import { lengthOf, minus, plus, times, unit } from "./vectors.js";
import {
  anglesOf,
  axisOf,
  DISTANCE_MIN,
  eyeOf,
  FIRST,
  groundAlong,
  isFlat,
  isOn,
  lookTurn,
  numberOf,
  orbitPose,
  orbits,
  orbitTurn,
  pointed,
  poseOf,
  standingTurn,
  standingValues,
  tallOf,
  tipped,
  towards,
  tripleOf,
  tripleValues,
  turned,
  viewOf,
  wholeTurn,
  withValues,
} from "./view-poses.js";

/** @typedef {"turn" | "move" | "zoom" | "lift"} Way what a drag does; `lift` goes along the line of sight */

/** RViz's. */
export const RAD_PER_PX = 0.005;

/**
 * @param {View} view @param {Way} way @param {number} dx px to the right @param {number} dy px downwards
 * @param {Size} size @param {readonly [number, number]} [at] where the mouse is now, px from the upper left corner
 * @returns {View}
 */
export function dragged(view, way, dx, dy, size, at = [size.width / 2, size.height / 2]) {
  if (isOn(view, "Lock Camera")) return view;
  if (view.kind === "TopDownOrtho") return draggedMap(view, way, dx, dy);
  if (!orbits(view.kind)) return draggedWalk(view, way, dx, dy);
  if (way === "turn") {
    return withValues(view, {
      Yaw: wholeTurn(numberOf(view, "Yaw") - dx * RAD_PER_PX),
      Pitch: tipped(numberOf(view, "Pitch") + dy * RAD_PER_PX),
    });
  }
  const distance = numberOf(view, "Distance");
  if (way === "zoom" || (way === "lift" && view.kind === "XYOrbit"))
    return zoomed(view, dy * 0.01 * distance);
  if (way === "lift") return moved(view, [0, 0, dy * 0.01 * distance]);
  if (view.kind === "XYOrbit") return draggedGround(view, dx, dy, size, at);
  const metres = (distance * tallOf(view)) / size.height;
  return moved(view, [-dx * metres, dy * metres, 0]);
}

/** @param {View} view @param {number} by m farther @returns {View} */
const zoomed = (view, by) =>
  withValues(view, { Distance: Math.max(numberOf(view, "Distance") + by, DISTANCE_MIN) });

/** @param {View} view an orbit @param {Triple} way in the camera's axes @returns {View} */
function moved(view, way) {
  const focal = plus(tripleOf(view, "Focal Point"), turned(orbitTurn(view), way));
  return withValues(view, tripleValues("Focal Point", focal));
}

/** The ground sticks to the mouse. Towards the horizon it would run away: RViz bounds that.
 * @param {View} view @param {number} dx @param {number} dy @param {Size} size @param {readonly [number, number]} at
 * @returns {View} */
function draggedGround(view, dx, dy, size, at) {
  const pose = orbitPose(view);
  const from = groundAt(view, pose, [at[0] - dx, at[1] - dy], size);
  const to = groundAt(view, pose, at, size);
  if (!from || !to) return view;
  const way = minus(from, to);
  const bounded = lengthOf(way) > 1 ? unit(way) : way;
  return withValues(
    view,
    tripleValues("Focal Point", plus(tripleOf(view, "Focal Point"), bounded)),
  );
}

/** @param {View} view @param {Pose} pose @param {readonly [number, number]} at @param {Size} size @returns {Triple | null} */
function groundAt(view, pose, [x, y], { width, height }) {
  const tall = tallOf(view) / height;
  const [right, up] = [(x - width / 2) * tall, (height / 2 - y) * tall];
  const eye = eyeOf(pose);
  if (isFlat(view)) {
    const from = plus(eye, turned(pose.turn, [right * pose.distance, up * pose.distance, 0]));
    const ahead = turned(pose.turn, [0, 0, -1]);
    const way = groundAlong(from, ahead);
    return way === null ? null : plus(from, times(ahead, way));
  }
  const ahead = turned(pose.turn, [right, up, -1]);
  const way = groundAlong(eye, ahead);
  return way === null ? null : plus(eye, times(ahead, way));
}

/** @param {View} view @param {Way} way @param {number} dx @param {number} dy @returns {View} */
function draggedMap(view, way, dx, dy) {
  if (way === "turn") return withValues(view, { Angle: numberOf(view, "Angle") + dx * RAD_PER_PX });
  if (way !== "move") return scaled(view, 1 - dy * 0.01);
  const [scale, angle] = [numberOf(view, "Scale"), numberOf(view, "Angle")];
  const [x, y] = turned(
    [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)],
    [-dx / scale, dy / scale, 0],
  );
  return withValues(view, { X: numberOf(view, "X") + x, Y: numberOf(view, "Y") + y });
}

/** @param {View} view @param {number} by @returns {View} */
const scaled = (view, by) =>
  withValues(view, {
    Scale: Math.min(Math.max(numberOf(view, "Scale") * Math.max(by, 0.1), 1e-4), 1e6),
  });

/** @param {View} view @param {Way} way @param {number} dx @param {number} dy @returns {View} */
function draggedWalk(view, way, dx, dy) {
  if (way === "turn") {
    return pointed(
      withValues(view, {
        Yaw: wholeTurn(numberOf(view, "Yaw") - dx * RAD_PER_PX),
        Pitch: tipped(numberOf(view, "Pitch") + dy * RAD_PER_PX),
      }),
    );
  }
  if (way === "move") return walked(view, [dx * 0.01, -dy * 0.01, 0]);
  return isFlat(view) ? scaled(view, 1 - dy * 0.01) : walked(view, [0, 0, dy * 0.1]);
}

/** @param {View} view @param {Triple} way in the camera's axes @returns {View} */
function walked(view, way) {
  const turn = standingTurn(numberOf(view, "Yaw"), tipped(numberOf(view, "Pitch")));
  const eye = tripleOf(view, "Position");
  const reach = view.reach ?? lengthOf(eye);
  return { ...withValues(view, tripleValues("Position", plus(eye, turned(turn, way)))), reach };
}

/** So much of a turn of the wheel at once, as RViz counts it: 120 for a notch. */
const WHEEL_MAX = 480;

/**
 * @param {View} view @param {number} diff more than 0: away from the hand, which comes nearer @param {boolean} shift
 * @returns {View}
 */
export function wheeled(view, diff, shift) {
  if (isOn(view, "Lock Camera")) return view;
  const by = Math.min(Math.max(diff, -WHEEL_MAX), WHEEL_MAX) * 0.001;
  if (!orbits(view.kind)) {
    return isFlat(view) ? scaled(view, 1 + by) : walked(view, [0, 0, -by * 10]);
  }
  const distance = numberOf(view, "Distance");
  return shift && view.kind !== "XYOrbit"
    ? moved(view, [0, 0, -by * distance])
    : zoomed(view, -by * distance);
}

/** Two fingers spread: what is seen grows by that. @param {View} view @param {number} ratio @returns {View} */
export function pinched(view, ratio) {
  if (isOn(view, "Lock Camera") || !(ratio > 0)) return view;
  if (orbits(view.kind)) {
    const distance = numberOf(view, "Distance");
    return zoomed(view, distance / ratio - distance);
  }
  if (isFlat(view)) return scaled(view, ratio);
  const reach = view.reach ?? lengthOf(tripleOf(view, "Position"));
  return walked(view, [0, 0, -reach * Math.log(ratio)]);
}

/** Look at a point, as RViz's F does: the camera stays where it is, a TopDownOrtho goes there.
 * @param {View} view @param {Triple} point @param {Size} size @returns {View} */
export function lookedAt(view, point, size) {
  if (view.kind === "TopDownOrtho") return withValues(view, { X: point[0], Y: point[1] });
  const eye = eyeOf(poseOf(view, size));
  const focal = /** @type {Triple} */ (view.kind === "XYOrbit" ? [point[0], point[1], 0] : point);
  const back = minus(eye, focal);
  const distance = Math.max(lengthOf(back), DISTANCE_MIN);
  const turn = lookTurn(back, [0, 0, isOn(view, "Invert Z Axis") && orbits(view.kind) ? -1 : 1]);
  if (view.kind !== "XYOrbit") return viewOf(view.kind, { focal, distance, turn }, view, size);
  const side = isOn(view, "Invert Z Axis") ? -1 : 1;
  const [yaw, pitch] = anglesOf(unit(back), turned(turn, [0, 1, 0]), side);
  return withValues(view, {
    ...{ Distance: distance, Yaw: wholeTurn(side * yaw), Pitch: tipped(side * pitch) },
    ...tripleValues("Focal Point", focal),
  });
}

/** RViz's Zero. @param {View} view @returns {View} */
export function zeroed(view) {
  const { kind } = view;
  if (kind === "FrameAligned") return towards(view, axisOf(view)[0], 5);
  if (kind === "FPS") {
    const Position = tripleValues("Position", [5, 5, 10]);
    const turn = lookTurn([5, 5, 10], [0, 0, 1]);
    return { ...withValues(view, { ...standingValues(turn), ...Position }), reach: 12.25 };
  }
  const names = orbits(kind)
    ? ["Distance", "Yaw", "Pitch", "Focal Point/X", "Focal Point/Y", "Focal Point/Z"]
    : ["Scale", "Angle", "X", "Y"];
  const first = names.map((name) => [name, /** @type {Value} */ (FIRST[kind][name])]);
  return withValues(view, Object.fromEntries(first));
}
