/**
 * Of which frame the pose is told, and in which: of the link that was selected last, in the root unless
 * another one was chosen. Clicks on the way between the two leave both as they are.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Pose } from "../../lib/kinematics.js" */

import { batch, computed, effect, signal } from "vendor/preact.js";
import { compose, inverse } from "../../lib/kinematics.js";
import { remembered } from "../../lib/remembered.js";
import { commandById } from "../commands.js";
import { robot } from "./document.js";
import { posesOf } from "./frames.js";
import { selection, selectLink } from "./selection.js";

/** Selections made by this panel are those on the way. */
export const BY_FRAMES = "frames";

/** @type {Signal<string | null>} */
const followed = signal(null);
/** Null: the root. @type {Signal<string | null>} */
const chosen = signal(null);

effect(() => {
  const { link = null, by = "" } = selection.value ?? {};
  if (link !== null && by !== BY_FRAMES) followed.value = link;
});

/** @param {string | null} name @returns {string | null} while the robot has it */
const there = (name) => robot.value?.links.find((link) => link.name === name)?.name ?? null;

/** The frame whose pose is told; null: none was selected yet. */
export const target = computed(() => there(followed.value));

/** The frame in which it is told. */
export const reference = computed(() => there(chosen.value) ?? robot.value?.root ?? null);

/** Pose of the target in the reference; null until it is known. @type {Signal<Pose | null>} */
export const referenceFromTarget = computed(() => {
  const [from, to] = [reference.value, target.value];
  if (from === null || to === null) return null;
  const poses = posesOf([from, to]);
  const rootFromReference = poses?.get(from);
  const rootFromTarget = poses?.get(to);
  if (!rootFromReference || !rootFromTarget) return null;
  return compose(inverse(rootFromReference), rootFromTarget);
});

/** Lengths are told in mm. */
export const millimetres = remembered("millimetres", false);

/** Somebody looks at the pose. */
export const comparing = signal(false);

/** Links whose frames are seen in 3D for it. @type {Signal<readonly string[]>} */
export const comparedFrames = computed(() => {
  const links = comparing.value ? [reference.value, target.value] : [];
  return links.filter((link) => link !== null);
});

/** @param {string} link */
export function setTarget(link) {
  selectLink(link, "");
}

/** @param {string} link */
export function setReference(link) {
  chosen.value = link;
}

/** Tell the pose of the reference in the target instead. */
export function swapFrames() {
  const [from, to] = [reference.value, target.value];
  if (from === null || to === null) return;
  batch(() => {
    setReference(to);
    setTarget(from);
  });
}

/** @param {string} link poses are told in its frame from now on, and the panel that does so is shown */
export function tellIn(link) {
  setReference(link);
  commandById("panel.frames")?.run();
}
