/** The frames of TF as the studio last told them: asked every second while somebody looks, else never. */

/** @import { FrameView, TfFrames } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { withLooseLinks } from "../../lib/frame-tree.js";
import { connection } from "./connection.js";
import { documentId, robot } from "./document.js";
import { sharedLook } from "./frames.js";
import { askOrKeepWhy } from "./refusals.js";

const EVERY_MS = 1000;

/** Of which frame the pose is told, and in which; empty: of none. @typedef {{frame: string, seen_from: string}} Pair */
/** @type {Signal<Pair>} */
export const pair = signal({ frame: "", seen_from: "" });

/** The last answer, and what was asked. @type {Signal<{asked: Pair, told: TfFrames} | null>} */
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

/** What was told of the pair that is looked at now; null: not yet. */
export const pairAnswer = computed(() => {
  const [known, { frame, seen_from }] = [answered.value, pair.value];
  const fits = known?.asked.frame === frame && known.asked.seen_from === seen_from;
  return known && fits ? known.told : null;
});

/** Keep the frames true while somebody looks. @type {() => () => void} gives the end of looking */
export const followTf = sharedLook(() => {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  let turn = 0;
  /** @param {number} mine */
  const go = async (mine) => {
    if (!document.hidden) await askTf();
    if (mine === turn) later = setTimeout(go, EVERY_MS, mine);
  };
  const end = effect(() => {
    pair.value;
    turn += 1;
    clearTimeout(later);
    if (connection.value === "connected" && documentId.value !== "") untracked(() => go(turn));
  });
  return () => {
    turn += 1;
    clearTimeout(later);
    end();
  };
});

/** Ask now. */
export async function askTf() {
  const asked = pair.peek();
  const told = await askOrKeepWhy({ type: "get_tf", ...asked }, tfRefused);
  // An answer to an earlier question may come after the next was asked.
  if (told?.type === "tf_frames" && asked === pair.peek()) answered.value = { asked, told };
}

// Another document has other frames.
effect(() => {
  documentId.value;
  answered.value = null;
});
