/** What a person can ask of variants; what found no place, or is not held, is said. */

/** @import { Side } from "../types/wire.d.ts" */

import { allSettled } from "../lib/latest.js";
import { ask } from "./actions.js";
import { notify } from "./state/view.js";

/** Sentences said at once; more than that nobody reads. */
const SAID = 3;

/** @param {readonly string[]} sentences */
function say(sentences) {
  for (const one of sentences.slice(0, SAID)) notify(one, { bad: true });
}

/** @param {string} name empty: as in the files */
export async function applyVariant(name) {
  await allSettled();
  const answer = await ask({ type: "apply_variant", name });
  if (answer?.type === "variant_applied") say(answer.left_out);
}

/** @param {string} name @param {string} note @returns {Promise<boolean>} it was done */
export async function saveVariant(name, note) {
  await allSettled();
  const answer = await ask({ type: "save_variant", name, note });
  if (answer?.type !== "variant_saved") return false;
  say(answer.left_out);
  return true;
}

/** @param {string} name is given the present arguments and values */
export async function updateVariant(name) {
  await allSettled();
  const answer = await ask({ type: "update_variant", name });
  if (answer?.type === "variant_saved") say(answer.left_out);
}

/** @param {Side} one @param {Side} other */
export const compareSides = (one, other) => ask({ type: "compare_variants", sides: [one, other] });
