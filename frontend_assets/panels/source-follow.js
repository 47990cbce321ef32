/** While Ctrl is held, the word under the pointer that leads somewhere looks like a link. */

/**
 * @import { Extension } from "vendor/codemirror.js"
 * @import { TextLink } from "../app/texts.js"
 */

import { Decoration, EditorView, StateEffect, StateField, ViewPlugin } from "vendor/codemirror.js";
import { lookUp } from "../app/language.js";

const REST_MS = 60;
const FOLLOWED = Decoration.mark({ class: "source-follow" });
/** The stretch that leads somewhere; null: none. @type {import("vendor/codemirror.js").StateEffectType<{start: number, end: number} | null>} */
const setFollowed = StateEffect.define();

const MARK = StateField.define({
  create: () => Decoration.none,
  update(mark, { effects, docChanged }) {
    const told = effects.findLast((one) => one.is(setFollowed));
    if (!told) return docChanged ? Decoration.none : mark;
    const { value } = told;
    return value ? Decoration.set([FOLLOWED.range(value.start, value.end)]) : Decoration.none;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** @param {TextLink} link @returns {Extension} for the editor of one text */
export function following(link) {
  return [MARK, ViewPlugin.define((view) => follower(link, view))];
}

/** @param {TextLink} link @param {EditorView} view */
function follower(link, view) {
  /** Where the pointer is in the text. @type {{x: number, y: number} | null} */
  let pointer = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let asking;
  let turn = 0;
  const look = (/** @type {boolean} */ held) => {
    turn += 1;
    clearTimeout(asking);
    if (held && pointer) asking = setTimeout(ask, REST_MS, turn, pointer);
    else if (view.state.field(MARK) !== Decoration.none)
      view.dispatch({ effects: setFollowed.of(null) });
  };
  const ask = async (/** @type {number} */ mine, /** @type {{x: number, y: number}} */ at) => {
    const pos = view.posAtCoords(at);
    const meaning = pos === null ? null : await lookUp(link, pos);
    const leads = meaning && meaning.places.length > 0 && meaning.start < meaning.end;
    if (mine !== turn) return;
    const fits = leads && meaning.end <= view.state.doc.length;
    view.dispatch({ effects: setFollowed.of(fits ? meaning : null) });
  };
  const stop = new AbortController();
  const { signal } = stop;
  view.contentDOM.addEventListener(
    "mousemove",
    ({ clientX: x, clientY: y, ctrlKey, metaKey }) => {
      pointer = { x, y };
      look(ctrlKey || metaKey);
    },
    { signal },
  );
  const leave = () => {
    pointer = null;
    look(false);
  };
  view.contentDOM.addEventListener("mouseleave", leave, { signal });
  addEventListener("blur", leave, { signal });
  const onKey = (/** @type {KeyboardEvent} */ { key, ctrlKey, metaKey }) => {
    if (pointer && (key === "Control" || key === "Meta")) look(ctrlKey || metaKey);
  };
  addEventListener("keydown", onKey, { signal });
  addEventListener("keyup", onKey, { signal });
  return {
    destroy() {
      clearTimeout(asking);
      stop.abort();
      turn += 1;
    },
  };
}
