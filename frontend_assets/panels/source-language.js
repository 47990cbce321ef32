/** What the studio knows of the words in the source: cards on hover, definitions, uses, completion. */

/**
 * @import { Extension, Tooltip } from "vendor/codemirror.js"
 * @import { Reference, References } from "../types/wire.d.ts"
 * @import { TextLink } from "../app/texts.js"
 */

import { EditorState, EditorView, hoverTooltip, keymap, ViewPlugin } from "vendor/codemirror.js";
import { effect, untracked } from "vendor/preact.js";
import { lookUp, referencesTo } from "../app/language.js";
import { mayEdit } from "../app/state/connection.js";
import { cursorPlace, showSource, wantedSnippet } from "../app/state/source.js";
import { notify } from "../app/state/view.js";
import { t } from "../lib/i18n.js";
import { placeText } from "../lib/paths.js";
import { completion } from "./source-completion.js";
import { goTo, made, meaningCard, placeButton } from "./source-meaning.js";
import { closePeek, PEEK, peek } from "./source-peek.js";
import { insertSnippet } from "./source-snippet.js";

const HOVER_MS = 350;
const STEPS_KEPT = 50;
/** Where one was before each jump. @type {{file: string, line: number, column: number}[]} */
const trail = [];

/** @param {TextLink} link @returns {Extension} what the editor of one text knows */
export function languageOf(link) {
  return [
    hoverTooltip((_, pos) => hovered(link, pos), {
      hoverTime: HOVER_MS,
      hideOn: ({ docChanged, selection }) => docChanged || selection !== undefined,
    }),
    PEEK,
    completion(link),
    keymap.of([
      { key: "F12", run: (view) => goToDefinition(link, view, cursorOf(view)) },
      { key: "Shift-F12", run: (view) => showReferences(link, view, cursorOf(view)) },
      { key: "Alt-F12", run: (view) => showMeaning(link, view, cursorOf(view)) },
      { key: "Alt-ArrowLeft", run: goBack, preventDefault: true },
    ]),
    EditorView.domEventHandlers({ mousedown: (event, view) => onPress(link, event, view) }),
    EditorState.phrases.of({ Completions: t("language.completions") }),
    ViewPlugin.define(takingSnippets),
  ];
}

/** @param {EditorView} view */
const cursorOf = (view) => view.state.selection.main.head;

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

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
function goToDefinition(link, view, pos) {
  lookUp(link, pos).then((meaning) => {
    const places = meaning?.places ?? [];
    const [only] = places;
    if (!meaning || !only) notify(t("language.no_definition"));
    else if (places.length === 1) jump(only);
    else peek(view, pos, placeList(meaning.name, places.map(buttonTo)));
  });
  return true;
}

/** @param {import("../types/wire.d.ts").TextPlace} place */
function jump(place) {
  const here = cursorPlace.peek();
  if (here) trail.push({ ...here });
  trail.splice(0, trail.length - STEPS_KEPT);
  goTo(place);
}

/** @returns {boolean} */
function goBack() {
  const before = trail.pop();
  if (before) showSource(before.file, before.line, before.column);
  return before !== undefined;
}

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
function showMeaning(link, view, pos) {
  if (closePeek(view)) return true;
  lookUp(link, pos).then((meaning) => {
    if (meaning) peek(view, pos, meaningCard(meaning));
    else notify(t("language.nothing"));
  });
  return true;
}

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
function showReferences(link, view, pos) {
  if (closePeek(view)) return true;
  referencesTo(link, pos).then((found) => {
    if (!found || found.count === 0) notify(t("language.no_references"));
    else peek(view, pos, referenceList(found));
  });
  return true;
}

/** @param {References} found @returns {HTMLElement} */
function referenceList({ name, references, count }) {
  const title = t("language.references", { name, count });
  return placeList(title, references.map(referenceLine));
}

/** @param {Reference} reference @returns {HTMLElement} */
function referenceLine({ place, line, is_definition: isDefinition, in_run: inRun }) {
  const button = buttonTo(place);
  button.append(made("code", "muted", line));
  if (isDefinition) button.append(made("span", "meaning-kind", t("language.definition")));
  else if (!inRun) button.append(made("span", "meaning-kind", t("language.maybe")));
  return button;
}

/** @param {import("../types/wire.d.ts").TextPlace} place */
function buttonTo(place) {
  const words = placeText(place);
  const button = placeButton(place, words);
  button.addEventListener("click", () => {
    const here = cursorPlace.peek();
    if (here) trail.push({ ...here });
  });
  return button;
}

/** @param {string} title @param {HTMLElement[]} lines @returns {HTMLElement} */
function placeList(title, lines) {
  const list = made("ul", "", ...lines.map((line) => made("li", "", line)));
  const card = made("div", "meaning place-list", made("div", "meaning-head", title), list);
  card.setAttribute("role", "dialog");
  card.setAttribute("aria-label", title);
  return card;
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
