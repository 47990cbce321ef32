/**
 * What this person measures; nothing of it is shared, and those who only look may measure too. A
 * measure holds what was clicked, not numbers: those follow the joints and every edit.
 */

/** @import { Anchor, Measured } from "../../lib/measuring.js" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, effect, signal, untracked } from "vendor/preact.js";
import { anchorOfPart, measured, sameAnchor } from "../../lib/measuring.js";
import { recall, remember, remembered } from "../../lib/remembered.js";
import { readMeasures } from "../../lib/stored-measures.js";
import { documentState, robot } from "./document.js";
import { followFrames, linkPoses } from "./frames.js";
import { selection } from "./selection.js";

export const MODES = /** @type {const} */ (["all", "points", "frames", "axes"]);
/** @typedef {typeof MODES[number]} MeasureMode */
/** @typedef {{id: number, ends: readonly Anchor[]}} Measure */

/** What a click in 3D is aimed at. @type {Signal<MeasureMode>} */
export const measureMode = remembered("measure.mode", /** @type {MeasureMode} */ ("all"), (value) =>
  MODES.some((mode) => mode === value),
);
/** Whether clicks measure now. */
export const measuring = signal(false);
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

export function startMeasuring() {
  batch(() => {
    pending.value = [];
    measuring.value = true;
  });
}

export function stopMeasuring() {
  batch(() => {
    pending.value = [];
    measuring.value = false;
  });
}

/** Escape: forget what was clicked of a measure, then end. */
export function stepBack() {
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
