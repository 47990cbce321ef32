/**
 * The frames of TF, and the pose of one frame in another: of the link that was selected last or
 * another frame that was chosen, in the root unless another one was chosen. Clicks on the way
 * between the two leave both as they are.
 */

/** @import { FrameView, TfFrames } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Pose } from "../lib/kinematics.js" */

import { batch, computed, effect, signal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { poseOfQuaternion, wayBetween } from "../lib/frame-pose.js";
import { framesBetween, isOwn, isOwnWay, withLooseLinks } from "../lib/frame-tree.js";
import { compose, inverse } from "../lib/kinematics.js";
import { remembered } from "../lib/remembered.js";
import { askOrKeepWhy, polled } from "./asking.js";
import { documentId } from "./connection.js";
import { robot } from "./document.js";
import { posesOf } from "./frames.js";
import { selection, selectLink } from "./selection.js";

/** Asked again and again: how often frames are told, and how long ago, changes with the time. */
const TREE_EVERY_MS = 1000;
/** Asked again and again: robots tell of frames more often than this, and one pose costs next to nothing. */
const PAIR_EVERY_MS = 200;

/** Of which frame the pose is told, and in which; empty: of none. @typedef {{frame: string, seen_from: string}} Pair */
/** @type {Signal<Pair>} */
export const pair = signal({ frame: "", seen_from: "" });

/** The last answer. @type {Signal<{answer: TfFrames} | null>} */
export const answered = signal(null);
/** Why there was none at last; empty: there was. */
export const tfRefused = signal("");

/** @type {readonly FrameView[]} */
const NONE = [];
/** All frames; none before the first answer. */
export const tfFrames = computed(() => {
  const answer = answered.value?.answer;
  return answer ? withLooseLinks(answer, robot.value?.links.map(({ name }) => name) ?? []) : NONE;
});
const tfNames = computed(() => new Set(tfFrames.value.map(({ name }) => name)));
/** The frame that everything is drawn in. */
export const fixedFrame = computed(() => answered.value?.answer.fixed ?? "");

/** The last pose, and what was asked. @type {Signal<{asked: Pair, answer: TfFrames} | null>} */
const posed = signal(null);
/** Why the last request failed; empty: it did not. */
export const pairRefused = signal("");

/** What was told of the pair that is looked at now; null: not yet. */
export const pairAnswer = computed(() => {
  const [known, { frame, seen_from }] = [posed.value, pair.value];
  const fits = known?.asked.frame === frame && known.asked.seen_from === seen_from;
  return known && fits ? known.answer : null;
});

/** Ask for all frames now. */
export async function askTf() {
  const answer = await askOrKeepWhy({ type: "get_tf" }, tfRefused);
  if (answer?.type === "tf_frames") answered.value = { answer };
}

/** Ask for the pose now. */
export async function askPair() {
  const asked = pair.peek();
  const answer = await askOrKeepWhy({ type: "get_tf", ...asked, pose_only: true }, pairRefused);
  // An answer to an earlier question may come after the next was asked.
  if (answer?.type === "tf_frames" && asked === pair.peek()) posed.value = { asked, answer };
}

const followTree = polled(askTf, TREE_EVERY_MS, () => documentId.value !== "");
const followPair = polled(askPair, PAIR_EVERY_MS, () => {
  const { frame, seen_from } = pair.value;
  return documentId.value !== "" && frame !== "" && seen_from !== "";
});

/** Keep the frames and the pose true while somebody looks. @returns {() => void} the end of looking */
export function followTf() {
  const ends = [followTree(), followPair()];
  return () => {
    for (const end of ends) end();
  };
}

// Another document has other frames.
effect(() => {
  documentId.value;
  answered.value = null;
  posed.value = null;
});

/** Selections made by this panel are those on the way. */
export const BY_FRAMES = "frames";
/** Frames that are no links, which are marked in 3D at once. */
const FOLLOWED_MAX = 16;

/** @type {Signal<string | null>} */
const followed = signal(null);
/** Null: the root. @type {Signal<string | null>} */
const chosen = signal(null);

effect(() => {
  const { link = null, by = "" } = selection.value ?? {};
  if (link !== null && by !== BY_FRAMES) followed.value = link;
});

const linkNames = computed(() => new Set(robot.value?.links.map(({ name }) => name)));

/** @param {string | null} name @returns {string | null} while the robot or TF has it */
const there = (name) =>
  name !== null && (linkNames.value.has(name) || tfNames.value.has(name)) ? name : null;

/** The frame whose pose is told; null: none was selected yet. */
export const target = computed(() => there(followed.value));

/** The frame in which it is told. */
export const reference = computed(
  () => there(chosen.value) ?? robot.value?.root ?? there(fixedFrame.value),
);

/** All that can be chosen: what TF has, and the robot's links before TF was asked. */
export const frameNames = computed(() => [...new Set([...tfNames.value, ...linkNames.value])]);

/** Frames of TF on the way from the reference to the target; null: none leads there, or nothing is known of it. */
const frameWay = computed(() => {
  const [from, to] = [reference.value, target.value];
  return from === null || to === null ? null : framesBetween(tfFrames.value, from, to);
});

/** Somebody on the wire tells of frames. */
export const isToldByOthers = computed(() =>
  tfFrames.value.some((frame) => frame.parent !== "" && !isOwn(frame)),
);

/**
 * The robot's own joints lead from the one to the other, and nobody on the wire says otherwise: then
 * the pose follows every joint frame without a word to the studio.
 */
const isOwnPair = computed(() => {
  const [from, to] = [reference.value, target.value];
  if (from === null || to === null) return false;
  if (!linkNames.value.has(from) || !linkNames.value.has(to)) return false;
  return frameWay.value ? isOwnWay(tfFrames.value, from, frameWay.value) : !isToldByOthers.value;
});

// Where joints lead, nobody needs to ask.
effect(() => {
  const [seen_from, frame] = isOwnPair.value
    ? ["", ""]
    : [reference.value ?? "", target.value ?? ""];
  pair.value = { frame, seen_from };
});

/** Joints between the two; null: they are not what leads from one to the other. */
export const jointWay = computed(() => {
  const [from, to] = [reference.value, target.value];
  if (from === null || to === null || !isOwnPair.value) return null;
  return wayBetween(robot.value?.joints ?? [], from, to);
});

/** Frames between the two as TF has them; null: joints lead there, or nothing does. */
export const tfWay = computed(() => (isOwnPair.value ? null : frameWay.value));

/** Where the pose comes from, once there is one. */
export const source = computed(() => (isOwnPair.value ? "joints" : "tf"));

/** Pose of the target in the reference; null until it is known. @type {Signal<Pose | null>} */
export const referenceFromTarget = computed(() => (isOwnPair.value ? ownPose() : tfPose()));

/** @returns {Pose | null} */
function ownPose() {
  const [from, to] = [reference.value ?? "", target.value ?? ""];
  const poses = posesOf([from, to]);
  const rootFromReference = poses?.get(from);
  const rootFromTarget = poses?.get(to);
  if (!rootFromReference || !rootFromTarget) return null;
  return compose(inverse(rootFromReference), rootFromTarget);
}

/** @returns {Pose | null} */
function tfPose() {
  const answer = pairAnswer.value?.pose;
  return answer ? poseOfQuaternion(answer.wxyz, answer.xyz) : null;
}

/** Frames from the reference to the target, both ends with it. @type {Signal<ReadonlySet<string>>} */
export const chain = computed(() => {
  const way = frameWay.value;
  if (way === null || reference.value === null) return new Set();
  return new Set([reference.value, ...way.map(({ at }) => at)]);
});

/** Lengths are told in mm. */
export const millimetres = remembered("millimetres", false);

/** Somebody looks at the pose. */
export const comparing = signal(false);

const isLink = (/** @type {string} */ frame) => linkNames.value.has(frame);

/**
 * A list that is the same while its members are: frames are told anew all the time.
 *
 * @param {() => string[]} list
 * @returns {Signal<readonly string[]>}
 */
function steady(list) {
  const members = computed(() => JSON.stringify(list()));
  return computed(() => JSON.parse(members.value));
}

/** The two while somebody looks. */
const ends = steady(() => {
  const two = comparing.value ? [reference.value, target.value] : [];
  return two.filter((frame) => frame !== null);
});

/** Frames that are seen in 3D for it. */
export const comparedFrames = computed(() => ({
  links: ends.value.filter(isLink),
  others: ends.value.filter((frame) => !isLink(frame)),
}));

/** All frames of the way, through which a line leads in 3D. */
export const drawnChain = steady(() =>
  comparing.value && target.value !== null ? [...chain.value] : [],
);

/** Those of them that are no links; of a long way the two ends and as many as may be. */
export const followedFrames = steady(() =>
  [...new Set([...ends.value, ...drawnChain.value])]
    .filter((frame) => !isLink(frame))
    .slice(0, FOLLOWED_MAX),
);

/** Links on the way that are lit in 3D for it. @type {Signal<readonly string[]>} */
export const litChain = computed(() => {
  if (!comparing.value || target.value === null) return [];
  return [...chain.value].filter(isLink);
});

/** @param {string} frame a link is selected, too */
export function setTarget(frame) {
  if (linkNames.value.has(frame)) selectLink(frame, "");
  followed.value = frame;
}

/** @param {string} frame */
export function setReference(frame) {
  chosen.value = frame;
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
