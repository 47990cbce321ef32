/** The frames of TF and the pose of one in another, as the studio last told them: asked while somebody looks. */

/** @import { FrameView, TfFrames } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { withLooseLinks } from "../../lib/frame-tree.js";
import { documentId, robot } from "./document.js";
import { polled } from "./polling.js";
import { askOrKeepWhy } from "./refusals.js";

const TREE_EVERY_MS = 1000;
/** One pose costs the studio next to nothing. */
const PAIR_EVERY_MS = 200;

/** Of which frame the pose is told, and in which; empty: of none. @typedef {{frame: string, seen_from: string}} Pair */
/** @type {Signal<Pair>} */
export const pair = signal({ frame: "", seen_from: "" });

/** The last answer. @type {Signal<{told: TfFrames} | null>} */
export const answered = signal(null);
/** Why there was none at last; empty: there was. */
export const tfRefused = signal("");

/** @type {readonly FrameView[]} */
const NONE = [];
/** All frames; none before the first answer. */
export const tfFrames = computed(() => {
  const told = answered.value?.told;
  return told ? withLooseLinks(told, robot.value?.links.map(({ name }) => name) ?? []) : NONE;
});
export const tfNames = computed(() => new Set(tfFrames.value.map(({ name }) => name)));
/** The frame that everything is drawn in. */
export const fixedFrame = computed(() => answered.value?.told.fixed ?? "");

/** The last pose, and of what. @type {Signal<{asked: Pair, told: TfFrames} | null>} */
const posed = signal(null);
/** Why none was told at last; empty: it was. */
export const pairRefused = signal("");

/** What was told of the pair that is looked at now; null: not yet. */
export const pairAnswer = computed(() => {
  const [known, { frame, seen_from }] = [posed.value, pair.value];
  const fits = known?.asked.frame === frame && known.asked.seen_from === seen_from;
  return known && fits ? known.told : null;
});

/** Ask for all frames now. */
export async function askTf() {
  const told = await askOrKeepWhy({ type: "get_tf" }, tfRefused);
  if (told?.type === "tf_frames") answered.value = { told };
}

/** Ask for the pose now. */
export async function askPair() {
  const asked = pair.peek();
  const told = await askOrKeepWhy({ type: "get_tf", ...asked, pose_only: true }, pairRefused);
  // An answer to an earlier question may come after the next was asked.
  if (told?.type === "tf_frames" && asked === pair.peek()) posed.value = { asked, told };
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
