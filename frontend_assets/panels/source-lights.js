/** Lines of a text that light up while something that they say is pointed at elsewhere. */

/** @import { EditorState, Range } from "vendor/codemirror.js" */

import { Decoration, EditorView, StateEffect, StateField } from "vendor/codemirror.js";

const LIT = Decoration.line({ class: "source-lit" });

/** Line numbers, from 1. @type {import("vendor/codemirror.js").StateEffectType<readonly number[]>} */
export const setLit = StateEffect.define();

/** The extension that draws them. */
export const LIGHTS = StateField.define({
  create: () => Decoration.none,
  update(lights, { effects, changes, state }) {
    const lit = effects.findLast((one) => one.is(setLit));
    return lit ? decorated(lit.value, state) : lights.map(changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** @param {readonly number[]} lines @param {EditorState} state */
function decorated(lines, { doc }) {
  const there = [...new Set(lines)].filter((line) => line >= 1 && line <= doc.lines);
  /** @type {Range<Decoration>[]} */
  const ranges = there.map((line) => LIT.range(doc.line(line).from));
  return Decoration.set(ranges, true);
}
