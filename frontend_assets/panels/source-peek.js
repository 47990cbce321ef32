/** A card at the cursor of the source: a meaning, or a list of places; Escape closes it. */

/** @import { EditorView, Extension, Tooltip } from "vendor/codemirror.js" */

import {
  closeHoverTooltips,
  keymap,
  StateEffect,
  StateField,
  showTooltip,
} from "vendor/codemirror.js";

/** @type {import("vendor/codemirror.js").StateEffectType<{pos: number, card: HTMLElement} | null>} */
const setPeek = StateEffect.define();

/** @type {StateField<Tooltip | null>} */
const peeked = StateField.define({
  /** @returns {Tooltip | null} */
  create: () => null,
  update(tooltip, { effects, docChanged, selection }) {
    const set = effects.findLast((one) => one.is(setPeek));
    if (set) return set.value ? tooltipOf(set.value) : null;
    return docChanged || selection ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

/** @param {{pos: number, card: HTMLElement}} peek @returns {Tooltip} */
function tooltipOf({ pos, card }) {
  // At once, so that what is typed next is meant for the card.
  const mount = () => firstOf(card)?.focus({ preventScroll: true });
  return { pos, above: false, create: () => ({ dom: card, mount }) };
}

/** @param {HTMLElement} card @returns {HTMLElement | null} what takes the focus in it */
const firstOf = (card) => card.querySelector("input") ?? card.querySelector("button");

/** @type {Extension} */
export const PEEK = [peeked, keymap.of([{ key: "Escape", run: closePeek }])];

/** @param {EditorView} view @param {number} pos @param {HTMLElement} card its field, or first button, gets the focus */
export function peek(view, pos, card) {
  card.addEventListener("keydown", (event) => onKey(view, card, event));
  card.addEventListener("click", ({ target }) => {
    if (target instanceof Element && target.closest("button")) closePeek(view);
  });
  view.dispatch({ effects: [closeHoverTooltips, setPeek.of({ pos, card })] });
}

/** @param {EditorView} view @returns {boolean} there was one */
export function closePeek(view) {
  if (!view.state.field(peeked, false)) return false;
  view.dispatch({ effects: setPeek.of(null) });
  view.focus();
  return true;
}

/** @param {EditorView} view @param {HTMLElement} card @param {KeyboardEvent} event */
function onKey(view, card, event) {
  const all = [...card.querySelectorAll("button")];
  const at = all.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
  /** @type {Record<string, number>} */
  const moves = { ArrowDown: at + 1, ArrowUp: at - 1 + all.length };
  const to = moves[event.key];
  if (to !== undefined && all.length > 0) all[to % all.length]?.focus();
  else if (event.key === "Escape") closePeek(view);
  else return;
  event.preventDefault();
  event.stopPropagation();
}
