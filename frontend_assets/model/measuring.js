/**
 * Distances and angles between points, link frames and joint axes of the robot: what this person
 * measures, its commands, and what the 3D view is told and tells of it. Nothing of it is shared,
 * and viewers may measure too. What this browser stored before is checked.
 */

/** @import { Anchor } from "./viewport.js" */
/** @import { JointView } from "../types/wire.d.ts" */
/** @import { Pose, Triple } from "../lib/kinematics.js" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Studio3d } from "./viewport.js" */

import { batch, computed, effect, signal, untracked } from "vendor/preact.js";
import { addCommands } from "../lib/commands.js";
import { AT_REST, moved, translationOf, turned, turnedBack } from "../lib/kinematics.js";
import { shownMeasure, shownNumber, toDegrees } from "../lib/numbers.js";
import { recall, remember, remembered } from "../lib/remembered.js";
import { cross, dot, lengthOf, minus } from "../lib/vectors.js";
import { displays, documentState, robot } from "./document.js";
import { followFrames, linkPoses } from "./frames.js";
import { centreOfMass, followMasses, masses, sumOf } from "./masses.js";
import { selection } from "./selection.js";
import { millimetres } from "./tf.js";
import { hasKind, putToolAway, takeKind, toolInHand } from "./tools.js";
import { degrees, isFree } from "./view.js";
import { viewport } from "./viewport.js";

/** Where an anchor is in the root frame; the direction is its normal, z axis or axis. @typedef {{anchor: Anchor, at: Triple, direction: Triple | null}} Placed */
/**
 * @typedef {object} Measured all lengths in m, all angles in rad
 * @property {readonly Placed[]} ends
 * @property {number} distance between the first two
 * @property {Triple} inRoot from the first to the second, in the root frame
 * @property {Triple} inFirst the same in the frame of the first one's link
 * @property {number | null} toAxis the shortest way between the lines, or from the line to the point; null: there is no line
 * @property {number | null} angle between the directions of the first two; null: one has none
 * @property {number | null} corner angle at the second of three; null: there are two, or they coincide
 */

/**
 * @param {readonly Anchor[]} anchors two or three
 * @param {ReadonlyMap<string, Pose>} poses of the links in the root frame
 * @param {readonly JointView[]} joints
 * @returns {Measured | null} null: the robot has one of them no more
 */
export function measured(anchors, poses, joints) {
  const ends = anchors.flatMap((anchor) => placed(anchor, poses, joints) ?? []);
  const [first, second, third] = ends;
  if (ends.length < anchors.length || !first || !second) return null;
  const inRoot = minus(second.at, first.at);
  const firstPose = poses.get(first.anchor.link) ?? AT_REST;
  return {
    ends,
    distance: lengthOf(inRoot),
    inRoot,
    inFirst: turnedBack(firstPose, inRoot),
    toAxis: shortest(first, second),
    angle: first.direction && second.direction && angleBetween(first.direction, second.direction),
    corner: third ? angleBetween(minus(first.at, second.at), minus(third.at, second.at)) : null,
  };
}

/** @param {Anchor} anchor @param {ReadonlyMap<string, Pose>} poses @param {readonly JointView[]} joints @returns {Placed | null} */
function placed(anchor, poses, joints) {
  const pose = poses.get(anchor.link);
  if (!pose) return null;
  if (anchor.kind === "point")
    return {
      anchor,
      at: moved(pose, anchor.at),
      direction: anchor.normal && turned(pose, anchor.normal),
    };
  const at = translationOf(pose);
  if (anchor.kind === "frame") return { anchor, at, direction: turned(pose, [0, 0, 1]) };
  const joint = joints.find(({ name }) => name === anchor.joint);
  if (joint?.child !== anchor.link) return null;
  return { anchor, at, direction: turned(pose, joint.axis) };
}

/** @param {Triple} a @param {Triple} b @returns {number | null} rad, 0 to pi; exact for small ones too; null: one has no length */
export function angleBetween(a, b) {
  if (lengthOf(a) === 0 || lengthOf(b) === 0) return null;
  return Math.atan2(lengthOf(cross(a, b)), dot(a, b));
}

/** Below this sine two axes are parallel. */
const PARALLEL = 1e-9;

/** @param {Placed} one @param {Placed} other @returns {number | null} */
function shortest(one, other) {
  const between = minus(other.at, one.at);
  const [a, b] = [lineOf(one), lineOf(other)];
  if (a && b) {
    const across = cross(a, b);
    if (lengthOf(across) > PARALLEL) return Math.abs(dot(between, across)) / lengthOf(across);
  }
  const line = a ?? b;
  return line && lengthOf(cross(between, line));
}

/** @param {Placed} one @returns {Triple | null} where the axis points, of length 1; null: it is no axis */
function lineOf({ anchor, direction }) {
  if (anchor.kind !== "axis" || !direction) return null;
  const size = lengthOf(direction);
  return size > 0 ? [direction[0] / size, direction[1] / size, direction[2] / size] : null;
}

/**
 * @param {JointView[] | readonly JointView[]} joints
 * @param {string} part `link:<name>` or `joint:<name>`
 * @returns {Anchor | null} the frame of a link, the axis of a joint that has one, else the frame of its child
 */
export function anchorOfPart(joints, part) {
  const at = part.indexOf(":");
  const name = part.slice(at + 1);
  if (part.startsWith("link:")) return { kind: "frame", link: name };
  if (!part.startsWith("joint:")) return null;
  const joint = joints.find((one) => one.name === name);
  if (!joint) return null;
  const turns = ["revolute", "continuous", "prismatic"].includes(joint.type);
  return turns
    ? { kind: "axis", link: joint.child, joint: name }
    : { kind: "frame", link: joint.child };
}

/** @param {Anchor} anchor @returns {string} what it is called by: its joint, or its link */
export const anchorName = (anchor) => (anchor.kind === "axis" ? anchor.joint : anchor.link);

/** @param {Anchor} one @param {Anchor} other @returns {boolean} */
const sameAnchor = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/**
 * @typedef {object} Units
 * @property {boolean} millimetres
 * @property {boolean} degrees
 */

/** @typedef {(value: number) => string} Write with how many digits */

/** @param {readonly number[]} values m @param {Units} units @param {Write} write @returns {string} with their unit */
export const lengthsText = (values, { millimetres }, write = shownMeasure) => {
  const texts = values.map((value) => write(millimetres ? value * 1000 : value));
  return `${texts.join("  ")} ${millimetres ? "mm" : "m"}`;
};

/** @param {number} value m @param {Units} units @param {Write} write @returns {string} with its unit */
export const lengthText = (value, units, write = shownMeasure) =>
  lengthsText([value], units, write);

/** @param {number} value rad @param {Units} units @param {Write} write @returns {string} with its unit */
export const angleText = (value, { degrees }, write = shownMeasure) =>
  degrees ? `${write(toDegrees(value))}°` : `${write(value)} rad`;

/** So many are read; a person deletes what is not needed any more. */
export const MEASURES_MOST = 100;

/** @param {unknown} stored @returns {readonly (readonly Anchor[])[]} the ends of each; those that are none are left out */
export function readMeasures(stored) {
  if (!Array.isArray(stored)) return [];
  return stored.slice(0, MEASURES_MOST).flatMap((ends) => {
    const read = Array.isArray(ends) ? ends.flatMap((end) => readAnchor(end) ?? []) : [];
    const whole = read.length === ends?.length && (read.length === 2 || read.length === 3);
    return whole ? [read] : [];
  });
}

/** @param {unknown} stored @returns {Anchor | null} */
function readAnchor(stored) {
  const { kind, link, joint, at, normal } =
    /** @type {{kind?: unknown, link?: unknown, joint?: unknown, at?: unknown, normal?: unknown}} */ (
      stored ?? {}
    );
  if (typeof link !== "string") return null;
  if (kind === "frame") return { kind, link };
  if (kind === "axis" && typeof joint === "string") return { kind, link, joint };
  if (kind !== "point" || !isTriple(at)) return null;
  return { kind, link, at, normal: isTriple(normal) ? normal : null };
}

/** @param {unknown} value @returns {value is Triple} */
const isTriple = (value) =>
  Array.isArray(value) && value.length === 3 && value.every((one) => Number.isFinite(one));

export const MODES = /** @type {const} */ (["all", "points", "frames", "axes"]);
/** @typedef {typeof MODES[number]} MeasureMode */
/** @typedef {{id: number, ends: readonly Anchor[]}} Measure */

/** What a click in 3D is aimed at. @type {Signal<MeasureMode>} */
export const measureMode = remembered("measure.mode", /** @type {MeasureMode} */ ("all"), (value) =>
  MODES.some((mode) => mode === value),
);
/** Whether clicks measure now. */
export const measuring = computed(() => toolInHand.value?.kind === "Measure");
/** Three things make an angle, two a distance. @type {Signal<2 | 3>} */
export const endsWanted = signal(2);
/** The ends of the measure that is being made. @type {Signal<readonly Anchor[]>} */
export const pending = signal([]);
/** @type {Signal<readonly Measure[]>} */
export const measures = signal([]);
let count = 0;

/** What they come to now; null where the robot has an end no more. @type {import("vendor/preact.js").Signal<readonly {measure: Measure, found: Measured | null}[]>} */
export const measuredNow = computed(() => {
  const [poses, joints] = [linkPoses.value, robot.value?.joints ?? []];
  return measures.value.map((measure) => ({
    measure,
    found: poses && measured(measure.ends, poses, joints),
  }));
});

export const startMeasuring = () => takeKind("Measure");
export const stopMeasuring = putToolAway;

// What was begun of a measure is forgotten with the tool.
effect(() => {
  measuring.value;
  untracked(() => {
    if (pending.value.length > 0) pending.value = [];
  });
});

/** Escape: forget what was clicked of a measure, then end. */
function stepBack() {
  if (pending.value.length > 0) pending.value = [];
  else stopMeasuring();
}

/** @param {Anchor} anchor the next end; the last one makes a measure */
export function addEnd(anchor) {
  const before = pending.value;
  const last = before.at(-1);
  if (last && sameAnchor(last, anchor)) return;
  const ends = [...before, anchor];
  batch(() => {
    pending.value = ends.length < endsWanted.value ? ends : [];
    if (ends.length < endsWanted.value) return;
    count += 1;
    measures.value = [...measures.value, { id: count, ends }];
  });
}

/** @param {2 | 3} wanted */
export function wantEnds(wanted) {
  batch(() => {
    endsWanted.value = wanted;
    pending.value = [];
  });
}

/** @param {number} id of a measure */
export function deleteMeasure(id) {
  measures.value = measures.value.filter((one) => one.id !== id);
}

export function deleteMeasures() {
  measures.value = [];
}

// Poses are computed only while there is something to measure.
effect(() => {
  const needed = measuring.value || measures.value.length > 0;
  return needed ? untracked(followFrames) : undefined;
});

// A part that is selected anywhere but in 3D is meant, too: in the tree, say, or among the joints.
effect(() => {
  if (!measuring.value) return undefined;
  const before = selection.peek();
  return effect(() => {
    const chosen = selection.value;
    if (!chosen || chosen === before) return;
    const anchor = untracked(() => anchorOfPart(robot.value?.joints ?? [], chosen.part));
    if (anchor) untracked(() => addEnd(anchor));
  });
});

/** The file whose measures these are. */
let measuredPath = "";
const measuresKey = () => `measures.${measuredPath}`;

// They are this browser's own, and there again when the page is loaded anew.
effect(() => {
  const path = documentState.value?.path ?? "";
  if (path === "" || path === measuredPath) return;
  measuredPath = path;
  untracked(() => {
    measures.value = readMeasures(recall(measuresKey())).map((ends) => {
      count += 1;
      return { id: count, ends };
    });
  });
});
effect(() => {
  const ends = measures.value.map((measure) => measure.ends);
  if (measuredPath !== "") remember(measuresKey(), ends.length > 0 ? ends : undefined);
});

export function addMeasuring() {
  addCommands([
    {
      id: "measure",
      icon: "measure",
      keys: ["N"],
      enabled: () => robot.value !== null && hasKind("Measure") && isFree(),
      run: () => (measuring.value ? stopMeasuring() : startMeasuring()),
    },
    {
      id: "measure_back",
      icon: "close",
      keys: ["Escape"],
      enabled: () => measuring.value && isFree(),
      run: stepBack,
    },
  ]);
  effect(() => (viewport.value ? tell(viewport.value) : undefined));
  effect(() => (showsCentre() ? followCentre() : undefined));
}

/** @param {Studio3d} view @returns {() => void} the end of it */
function tell(view) {
  const stop = new AbortController();
  view.events.addEventListener(
    "measure",
    (event) => addEnd(/** @type {CustomEvent<{anchor: Anchor}>} */ (event).detail.anchor),
    { signal: stop.signal },
  );
  const ends = [
    effect(() => view.setMeasuring(measuring.value ? measureMode.value : null)),
    effect(() => view.setMeasures([...labelled(), { ends: pending.value, label: "" }])),
    effect(() => view.setCentre(centreNow())),
  ];
  return () => {
    stop.abort();
    for (const end of ends) end();
  };
}

/** @returns {{ends: readonly Anchor[], label: string}[]} the measures as the 3D view draws them */
function labelled() {
  const units = { millimetres: millimetres.value, degrees: degrees.value };
  return measuredNow.value.flatMap(({ measure, found }) => {
    if (!found) return [];
    const { corner, distance } = found;
    const label = corner === null ? lengthText(distance, units) : angleText(corner, units);
    return [{ ends: measure.ends, label }];
  });
}

const showsCentre = () => displays.value.robot?.com === true;

/** @returns {() => void} the end of it */
function followCentre() {
  const ends = [followFrames(), followMasses()];
  return () => {
    for (const end of ends) end();
  };
}

/** @returns {{at: readonly [number, number, number], label: string} | null} the robot's centre of mass, while those of the links are shown */
function centreNow() {
  const [found, poses] = [masses.value, linkPoses.value];
  const at = showsCentre() && found && poses ? centreOfMass(found, poses) : null;
  return found && at && { at, label: `${shownNumber(sumOf(found))} kg` };
}
