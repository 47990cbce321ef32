/**
 * The variants of the open document: which there are, what is compared, and what can be asked of
 * them.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Comparison, Side, Variants } from "../types/wire.d.ts" */

import { computed, signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { ask } from "./requests.js";
import { notify } from "./view.js";
import { RefusedError, send, subscribe } from "./wire.js";

/** @type {Signal<Variants>} */
export const variants = signal({
  type: "variants",
  variants: [],
  active: "",
  modified: false,
  path: "",
  only_here: "",
  trouble: "",
});

/** @type {Signal<Comparison>} */
export const comparison = signal({
  type: "comparison",
  sides: null,
  busy: false,
  faults: [],
  inputs: [],
  rows: [],
  count: 0,
  ghost: null,
});

/** Two states can differ only when there are two. */
export const canCompare = computed(
  () => variants.value.variants.length > 0 || variants.value.modified,
);

subscribe("variants", (event) => {
  variants.value = event;
});

subscribe("comparison", (event) => {
  comparison.value = event;
});

/** @param {Side} side @returns {string} */
export function sideName({ kind, name }) {
  return kind === "variant" ? name : t(`compare.side.${kind}`);
}

/** @param {Side} side @returns {string} for lists of choices */
export const sideKey = ({ kind, name }) => (kind === "variant" ? `variant ${name}` : kind);

/** @param {string} key @returns {Side} */
export function sideOf(key) {
  if (key === "present" || key === "saved") return { kind: key, name: "" };
  return { kind: "variant", name: key.slice("variant ".length) };
}

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

/** @param {string} name @param {string} note @returns {Promise<string>} why it was not done; empty: it was */
export async function saveVariant(name, note) {
  await allSettled();
  return refusal(name, "", async () => {
    const answer = await send({ type: "save_variant", name, note });
    if (answer.type === "variant_saved") say(answer.left_out);
  });
}

/** @param {string} name @param {string} newName @param {string} note @returns {Promise<string>} why it was not done; empty: it was */
export function renameVariant(name, newName, note) {
  return refusal(newName, name, () =>
    send({ type: "rename_variant", name, new_name: newName, note }),
  );
}

/** @param {string} name @param {string} own which may be the same @param {() => Promise<unknown>} run @returns {Promise<string>} */
async function refusal(name, own, run) {
  if (name !== own && variants.value.variants.some((one) => one.name === name))
    return t("variants.clash", { name });
  try {
    await run();
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : t("connection.lost");
  }
}

/** @param {string} name is given the present arguments and values */
export async function updateVariant(name) {
  await allSettled();
  const answer = await ask({ type: "update_variant", name });
  if (answer?.type === "variant_saved") say(answer.left_out);
}

/** @param {Side} one @param {Side} other */
export const compareSides = (one, other) => ask({ type: "compare_variants", sides: [one, other] });
