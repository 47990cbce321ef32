/** What the studio knows of the words in the source: cards on hover, definitions, uses, completion. */

/** @import { Extension, Tooltip } from "vendor/codemirror.js" */
/** @import { TextLink } from "../app/texts.js" */

import { EditorState, EditorView, hoverTooltip, keymap, ViewPlugin } from "vendor/codemirror.js";
import { effect, untracked } from "vendor/preact.js";
import { lookUp } from "../app/language.js";
import { t } from "../lib/i18n.js";
import { mayEdit } from "../model/connection.js";
import { wantedSnippet } from "../model/source.js";
import {
  cursorOf,
  goBack,
  goToDefinition,
  inFront,
  showMeaning,
  showReferences,
} from "./source-actions.js";
import { completion } from "./source-completion.js";
import { following } from "./source-follow.js";
import { meaningCard } from "./source-meaning.js";
import { PEEK } from "./source-peek.js";
import { renameAt } from "./source-rename.js";
import { findInFiles } from "./source-search.js";
import { insertSnippet, pairedBrackets } from "./source-snippet.js";

const HOVER_MS = 350;

/** @param {TextLink} link @returns {Extension} what the editor of one text knows */
export function languageOf(link) {
  return [
    hoverTooltip((_, pos) => hovered(link, pos), {
      hoverTime: HOVER_MS,
      hideOn: ({ docChanged, selection }) => docChanged || selection !== undefined,
    }),
    PEEK,
    following(link),
    completion(link),
    EditorView.inputHandler.of(pairedBrackets),
    keymap.of([
      { key: "F12", run: (view) => goToDefinition(link, view, cursorOf(view)) },
      { key: "Shift-F12", run: (view) => showReferences(link, view, cursorOf(view)) },
      { key: "Alt-F12", run: (view) => showMeaning(link, view, cursorOf(view)) },
      { key: "Mod-Shift-f", run: () => findInFiles(), preventDefault: true },
      { key: "F2", run: (view) => renameAt(link, view, cursorOf(view)) },
      { key: "Alt-ArrowLeft", run: goBack, preventDefault: true },
    ]),
    EditorView.domEventHandlers({ mousedown: (event, view) => onPress(link, event, view) }),
    EditorState.phrases.of({ Completions: t("language.completions") }),
    ViewPlugin.define(takingSnippets),
    ViewPlugin.define((view) => inFront(link, view)),
  ];
}

/** @param {TextLink} link @param {number} pos @returns {Promise<Tooltip | null>} */
async function hovered(link, pos) {
  const meaning = await lookUp(link, pos);
  if (!meaning) return null;
  const { start, end } = meaning;
  const inside = start <= pos && pos <= end;
  const create = () => ({ dom: meaningCard(meaning) });
  return { pos: inside ? start : pos, end: inside ? end : pos, above: true, create };
}

/** @param {TextLink} link @param {MouseEvent} event @param {EditorView} view @returns {boolean} */
function onPress(link, event, view) {
  if (event.button !== 0 || !(event.ctrlKey || event.metaKey) || event.altKey) return false;
  const pos = view.posAtCoords({ x: event.clientX, y: event.clientY });
  return pos !== null && goToDefinition(link, view, pos);
}

/** Writes what another panel wants at the cursor. @param {EditorView} view */
function takingSnippets(view) {
  const stop = effect(() => {
    const wanted = wantedSnippet.value;
    if (!wanted) return;
    // Not while the editor is in the midst of being made.
    queueMicrotask(() => untracked(() => take(view)));
  });
  return { destroy: stop };
}

/** @param {EditorView} view */
function take(view) {
  const wanted = wantedSnippet.value;
  if (!wanted) return;
  wantedSnippet.value = null;
  if (mayEdit.value && !view.state.readOnly) insertSnippet(view, wanted.text, wanted.stops);
  view.focus();
}
