/** What can be asked of the word at the cursor: its meaning, its definition, where it is used. */

/** @import { EditorView } from "vendor/codemirror.js" */
/** @import { Reference, References, TextPlace } from "../types/wire.d.ts" */
/** @import { TextLink } from "../app/texts.js" */

import { signal } from "vendor/preact.js";
import { lookUp, referencesTo } from "../app/language.js";
import { addCommands } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { placeText } from "../lib/paths.js";
import { cursorPlace, showSource } from "../model/source.js";
import { notify } from "../model/view.js";
import { goTo, made, meaningCard, placeButton } from "./source-meaning.js";
import { closePeek, peek } from "./source-peek.js";
import { renameAt } from "./source-rename.js";

const STEPS_KEPT = 50;
/** Where one was before each jump. @type {{file: string, line: number, column: number}[]} */
const trail = [];
/** The text in front, and the view that shows it. @type {import("vendor/preact.js").Signal<{link: TextLink, view: EditorView} | null>} */
const front = signal(null);

/** @param {TextLink} link @param {EditorView} view @returns {{destroy: () => void}} ends when another text comes to the front */
export function inFront(link, view) {
  const own = { link, view };
  front.value = own;
  return {
    destroy: () => {
      if (front.peek() === own) front.value = null;
    },
  };
}

/** @param {EditorView} view */
export const cursorOf = (view) => view.state.selection.main.head;

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
export function goToDefinition(link, view, pos) {
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
export function goBack() {
  const before = trail.pop();
  if (before) showSource(before.file, before.line, before.column);
  return before !== undefined;
}

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
export function showMeaning(link, view, pos) {
  if (closePeek(view)) return true;
  lookUp(link, pos).then((meaning) => {
    if (meaning) peek(view, pos, meaningCard(meaning));
    else notify(t("language.nothing"));
  });
  return true;
}

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
export function showReferences(link, view, pos) {
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
