/** Lines of a text that light up while something that they say is pointed at elsewhere. */

/** @import { EditorState, Range } from "vendor/codemirror.js" */

import { Decoration, EditorView, StateEffect, StateField, ViewPlugin } from "vendor/codemirror.js";

const LIT = Decoration.line({ class: "source-lit" });

/** Line numbers, from 1. @type {import("vendor/codemirror.js").StateEffectType<readonly number[]>} */
export const setLit = StateEffect.define();

const LINES = StateField.define({
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

/** A mark beside the scrollbar for each, also for those that are out of view. */
const RULER = ViewPlugin.define((view) => {
  const ruler = document.createElement("div");
  ruler.className = "source-ruler";
  ruler.ariaHidden = "true";
  view.dom.append(ruler);
  /** @type {import("vendor/codemirror.js").DecorationSet} */
  let drawn = Decoration.none;
  const draw = () => view.requestMeasure({ key: ruler, read: placesOf, write: put });
  const put = (/** @type {number[]} */ places) => {
    const marks = places.map((share) => {
      const mark = document.createElement("i");
      mark.style.top = `${100 * share}%`;
      return mark;
    });
    ruler.replaceChildren(...marks);
  };
  return {
    /** @param {import("vendor/codemirror.js").ViewUpdate} update */
    update({ state, geometryChanged }) {
      const lit = state.field(LINES);
      if (lit === drawn && !(geometryChanged && lit.size > 0)) return;
      drawn = lit;
      draw();
    },
    destroy: () => ruler.remove(),
  };
});

/** @param {EditorView} view @returns {number[]} how far down in the text each lit line is, from 0 to 1 */
function placesOf(view) {
  /** @type {number[]} */
  const places = [];
  for (const at = view.state.field(LINES).iter(); at.value; at.next())
    places.push(view.lineBlockAt(at.from).top / Math.max(view.contentHeight, 1));
  return places;
}

/** The extension that draws them. */
export const LIGHTS = [LINES, RULER];
