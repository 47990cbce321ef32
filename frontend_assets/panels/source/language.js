/**
 * What the studio knows of the words in the source: cards on hover, definitions and uses by key,
 * menu or Ctrl and click.
 */

/** @import { Extension, Tooltip } from "vendor/codemirror.js" */
/** @import { TextLink } from "./shared-text.js" */
/** @import { Reference, References, TextPlace } from "../../types/wire.d.ts" */

import {
  Decoration,
  EditorState,
  EditorView,
  hoverTooltip,
  keymap,
  StateEffect,
  StateField,
  ViewPlugin,
} from "vendor/codemirror.js";
import { effect, signal, untracked } from "vendor/preact.js";
import { addCommands } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { placeText } from "../../lib/paths.js";
import { mayEdit } from "../../model/connection.js";
import { cursorPlace, showSource, wantedSnippet } from "../../model/source.js";
import { notify } from "../../model/view.js";
import { completion, insertSnippet, pairedBrackets } from "./completion.js";
import {
  closePeek,
  goTo,
  lookUp,
  made,
  meaningCard,
  PEEK,
  peek,
  placeButton,
  referencesTo,
} from "./meaning.js";
import { renameAt } from "./rename.js";
import { findInFiles } from "./search.js";

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

const STEPS_KEPT = 50;
/** Where one was before each jump. @type {{file: string, line: number, column: number}[]} */
const trail = [];
/** The text in front, and the view that shows it. @type {import("vendor/preact.js").Signal<{link: TextLink, view: EditorView} | null>} */
const front = signal(null);

/** @param {TextLink} link @param {EditorView} view @returns {{destroy: () => void}} ends when another text comes to the front */
function inFront(link, view) {
  const own = { link, view };
  front.value = own;
  return {
    destroy: () => {
      if (front.peek() === own) front.value = null;
    },
  };
}

/** @param {EditorView} view */
const cursorOf = (view) => view.state.selection.main.head;

/** @typedef {(link: TextLink, view: EditorView, pos: number) => true} Action */

/** @param {Action} action @returns {() => void} does it at the cursor of the text in front */
const atCursor = (action) => () => {
  const shown = front.peek();
  if (shown) action(shown.link, shown.view, cursorOf(shown.view));
};

/** The actions by the names of their commands; their keys count in the editor only. */
export const ACTIONS = [
  { id: "meaning", icon: "info", key: "Alt+F12", run: atCursor(showMeaning) },
  { id: "definition", icon: "definition", key: "F12", run: atCursor(goToDefinition) },
  { id: "references", icon: "search", key: "Shift+F12", run: atCursor(showReferences) },
  { id: "rename", icon: "pencil", key: "F2", run: atCursor(renameAt) },
];

addCommands(
  ACTIONS.map(({ id, icon, run }) => ({ id, icon, run, enabled: () => front.value !== null })),
);

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

/** @param {TextPlace} place */
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

/** @param {TextPlace} place */
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

const REST_MS = 60;
const FOLLOWED = Decoration.mark({ class: "source-follow" });
/** The stretch that leads somewhere; null: none. @type {import("vendor/codemirror.js").StateEffectType<{start: number, end: number} | null>} */
const setFollowed = StateEffect.define();

const MARK = StateField.define({
  create: () => Decoration.none,
  update(mark, { effects, docChanged }) {
    const answer = effects.findLast((one) => one.is(setFollowed));
    if (!answer) return docChanged ? Decoration.none : mark;
    const { value } = answer;
    return value ? Decoration.set([FOLLOWED.range(value.start, value.end)]) : Decoration.none;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/**
 * While Ctrl is held, the word under the pointer that leads somewhere looks like a link.
 *
 * @param {TextLink} link
 * @returns {Extension} for the editor of one text
 */
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
