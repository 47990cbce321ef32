/** The variants of the open document and what is compared, as the studio last told it. */

/**
 * @import { Signal } from "vendor/preact.js"
 * @import { Comparison, Side, Variants } from "../../types/wire.d.ts"
 */

import { computed, signal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";

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

/** @param {Variants} event */
export function takeVariants(event) {
  variants.value = event;
}

/** @param {Comparison} event */
export function takeComparison(event) {
  comparison.value = event;
}

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
