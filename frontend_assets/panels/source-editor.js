/** The editor of the source panel: one CodeMirror view, and a state for each open file. */

/** @import { Extension, ViewUpdate } from "vendor/codemirror.js" */
/** @import { TextLink } from "../app/texts.js" */

import {
  Annotation,
  bracketMatching,
  Compartment,
  closeBrackets,
  closeBracketsKeymap,
  crosshairCursor,
  defaultKeymap,
  drawSelection,
  EditorState,
  EditorView,
  foldGutter,
  foldKeymap,
  gotoLine,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSelectionMatches,
  highlightSpecialChars,
  indentOnInput,
  indentUnit,
  indentWithTab,
  keymap,
  lineNumbers,
  lintGutter,
  lintKeymap,
  openSearchPanel,
  rectangularSelection,
  search,
  searchKeymap,
  xml,
  yaml,
} from "vendor/codemirror.js";
import { createGesture } from "../lib/gesture.js";
import { language, t } from "../lib/i18n.js";
import { indentationOf } from "../lib/indentation.js";
import { shortPath } from "../lib/paths.js";
import { iconElement } from "../lib/ui.js";
import { documentState } from "../model/document.js";
import { noteTyping } from "../model/source.js";
import { steadyCaret } from "./source-caret.js";
import { changeMarks } from "./source-changes.js";
import { LIGHTS } from "./source-lights.js";
import { SOURCE_LOOK } from "./source-look.js";
import { tabPassesThrough } from "./source-tab-key.js";

/** Marks what did not come from the keyboard here. */
export const fromElsewhere = Annotation.define();
/** What scrolls can be reached by Tab, however a browser takes editable text. */
const REACHED_BY_KEYS = EditorView.contentAttributes.of({ tabindex: "0" });
const locked = new Compartment();
const darkness = new Compartment();
const spoken = new Compartment();

/**
 * @typedef {object} EditorEvents
 * @property {(line: number, column: number) => void} onCursor both from 1
 * @property {() => void} onUndo
 * @property {() => void} onRedo
 */

/** @param {EditorEvents} events @returns {Extension} what the editors of all files have in common */
export function commonExtensions(events) {
  return [
    lineNumbers(),
    lintGutter(),
    foldGutter({ markerDOM: foldMark }),
    highlightActiveLineGutter(),
    highlightActiveLine(),
    highlightSpecialChars(),
    highlightSelectionMatches(),
    drawSelection(),
    EditorState.allowMultipleSelections.of(true),
    REACHED_BY_KEYS,
    rectangularSelection(),
    crosshairCursor(),
    bracketMatching(),
    closeBrackets(),
    indentOnInput(),
    search({ top: true }),
    keymap.of([
      { key: "Ctrl-g", run: gotoLine, preventDefault: true },
      { key: "Ctrl-h", mac: "Mod-Alt-f", run: openReplace, preventDefault: true },
    ]),
    historyKeys(events),
    tabPassesThrough(isTyped),
    keymap.of([
      ...closeBracketsKeymap,
      ...defaultKeymap,
      ...searchKeymap,
      ...foldKeymap,
      ...lintKeymap,
      indentWithTab,
    ]),
    SOURCE_LOOK,
    LIGHTS,
    steadyCaret(),
    EditorView.updateListener.of(({ state, docChanged, selectionSet }) => {
      if (docChanged || selectionSet) tellCursor(state, events);
    }),
  ];
}

/** The search with its second field in front. @param {EditorView} view @returns {boolean} */
export function openReplace(view) {
  openSearchPanel(view);
  const field = view.dom.querySelector('.cm-search input[name="replace"]');
  if (field instanceof HTMLInputElement) field.select();
  return true;
}

/** @param {boolean} open @returns {HTMLElement} */
export function foldMark(open) {
  const mark = document.createElement("span");
  mark.className = `source-fold ${open ? "" : "folded"}`;
  mark.title = open ? t("source.fold") : t("source.unfold");
  mark.append(iconElement(open ? "chevronDown" : "chevronRight"));
  return mark;
}

/** The document's own undo, for there is no second one. @param {EditorEvents} events @returns {Extension} */
function historyKeys({ onUndo, onRedo }) {
  const undo = () => {
    onUndo();
    return true;
  };
  const redo = () => {
    onRedo();
    return true;
  };
  return [
    keymap.of([
      { key: "Mod-z", run: undo, preventDefault: true },
      { key: "Mod-y", run: redo, preventDefault: true },
      { key: "Mod-Shift-z", run: redo, preventDefault: true },
    ]),
    EditorView.domEventHandlers({
      beforeinput(event) {
        if (event.inputType === "historyUndo") return undo();
        return event.inputType === "historyRedo" && redo();
      },
    }),
  ];
}

/** @param {EditorState} state @param {Pick<EditorEvents, "onCursor">} events */
export function tellCursor(state, { onCursor }) {
  const { head } = state.selection.main;
  const line = state.doc.lineAt(head);
  onCursor(line.number, head - line.from + 1);
}

/**
 * @param {TextLink} link
 * @param {Extension} common
 * @param {{dark: boolean, mayEdit: boolean, more: Extension}} options
 * @returns {EditorState}
 */
export function stateOf(link, common, { dark, mayEdit, more }) {
  const isYaml = /\.ya?ml$/i.test(link.file);
  const lines = link.doc.iterLines();
  return EditorState.create({
    doc: link.doc,
    extensions: [
      typing(link),
      changeMarks(link.saved),
      more,
      common,
      isYaml ? yaml() : xml(),
      indentUnit.of(indentationOf(lines)),
      EditorState.tabSize.of(4),
      locked.of(EditorState.readOnly.of(!mayEdit || link.readOnly !== "")),
      darkness.of(EditorView.theme({}, { dark })),
      spoken.of(wordsFor(link.file)),
    ],
  });
}

/** What is typed goes to the studio; a cursor that went elsewhere begins a new step of undo. @param {TextLink} link */
function typing({ shared }) {
  const gesture = createGesture();
  return EditorView.updateListener.of((update) => {
    const own = isTyped(update);
    if (update.docChanged) {
      if (own) {
        shared.type(update.changes, gesture.id());
        noteTyping();
      }
    } else if (update.selectionSet && own) {
      shared.flush();
      gesture.end();
    }
  });
}

/** @param {ViewUpdate} update @returns {boolean} it came from the keyboard or the mouse here */
function isTyped({ transactions }) {
  return !transactions.some((one) => one.annotation(fromElsewhere));
}

/** @param {string} file @returns {Extension} its name for a screen reader, and the words of the search */
function wordsFor(file) {
  const short = shortPath(file, documentState.value?.root ?? "");
  return [
    EditorView.contentAttributes.of({
      "aria-label": t("source.text", { file: short }),
      "aria-description": `${t("keys.leave")}: Escape, Tab`,
    }),
    EditorState.phrases.of(editorWords()),
  ];
}

const PHRASES = [
  "Find",
  "Replace",
  "next",
  "previous",
  "all",
  "match case",
  "by word",
  "regexp",
  "replace",
  "replace all",
  "close",
  "Go to line",
  "go",
  "current match",
  "replaced match on line $",
  "replaced $ matches",
  "on line",
  "folded code",
  "unfold",
];

/** @returns {Record<string, string>} what CodeMirror itself says, in the page's language */
export function editorWords() {
  return Object.fromEntries(PHRASES.map((one) => [one, t(`editor.${one.replaceAll(" ", "_")}`)]));
}

/** @param {EditorView} view @param {{dark: boolean, mayEdit: boolean, link: TextLink}} options set anew */
export function adjust(view, { dark, mayEdit, link }) {
  language.value;
  view.dispatch({
    effects: [
      locked.reconfigure(EditorState.readOnly.of(!mayEdit || link.readOnly !== "")),
      darkness.reconfigure(EditorView.theme({}, { dark })),
      spoken.reconfigure(wordsFor(link.file)),
    ],
  });
}

/** @param {EditorView} view @param {number} line from 1 @param {number} column from 1; the cursor goes there */
export function goToPlace(view, line, column) {
  const { doc } = view.state;
  const found = doc.line(Math.min(Math.max(line, 1), doc.lines));
  const at = Math.min(found.from + column - 1, found.to);
  view.dispatch({
    selection: { anchor: at },
    effects: EditorView.scrollIntoView(at, { y: "center" }),
  });
}
