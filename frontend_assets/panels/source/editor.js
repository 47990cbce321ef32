/**
 * The editor of the source panel: one CodeMirror view, and a state for each open file; its
 * colours, its cursor, its Tab key, and the lines that light up.
 */

/** @import { Extension, Range, ViewUpdate } from "vendor/codemirror.js" */
/** @import { TextLink } from "./shared-text.js" */

import {
  Annotation,
  bracketMatching,
  Compartment,
  closeBrackets,
  closeBracketsKeymap,
  crosshairCursor,
  Decoration,
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
  MatchDecorator,
  openSearchPanel,
  python,
  rectangularSelection,
  StateEffect,
  StateField,
  StreamLanguage,
  search,
  searchKeymap,
  syntaxHighlighting,
  tagHighlighter,
  tags,
  ViewPlugin,
  xml,
  yaml,
} from "vendor/codemirror.js";
import { createGesture } from "../../lib/gesture.js";
import { language, t } from "../../lib/i18n.js";
import { shortPath } from "../../lib/paths.js";
import { iconElement } from "../../lib/ui.js";
import { documentState } from "../../model/document.js";
import { noteTyping } from "../../model/source.js";
import { changeMarks } from "./changes.js";

/**
 * When marks around a word are drawn anew, the browser's cursor is left between two elements, and
 * CodeMirror holds that for the same place. Chromium types there before the word, not behind it:
 * `<xacro:` and `l` gave `<xaclro:`.
 *
 * @returns {Extension}
 */
const steadyCaret = () => EditorView.updateListener.of(keepWithinText);

/** @param {ViewUpdate} update */
function keepWithinText({ view }) {
  const { main } = view.state.selection;
  const selection = /** @type {Document} */ (view.root).getSelection();
  if (!view.hasFocus || view.composing || !main.empty) return;
  if (!isBetweenElements(selection, view)) return;
  const { node, offset } = view.domAtPos(main.head, -1);
  if (node instanceof Text) selection?.collapse(node, offset);
}

/** @param {Selection | null} selection @param {EditorView} view */
function isBetweenElements(selection, { contentDOM }) {
  const node = selection?.anchorNode;
  return node instanceof Element && node !== contentDOM && contentDOM.contains(node);
}

/**
 * Who walks through the page by Tab must neither change the text nor be caught in it. To leave
 * while editing, press Escape and then Tab.
 *
 * @param {(update: ViewUpdate) => boolean} typedHere
 * @returns {Extension}
 */
function tabPassesThrough(typedHere) {
  return [
    EditorView.domEventHandlers({ mousedown, focus, blur }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged && typedHere(update)) update.view.setTabFocusMode(false);
    }),
  ];
}

/** Views whose next focus is no walk: a click gives it, or the window that they lost it with. @type {WeakSet<EditorView>} */
const called = new WeakSet();

/** @param {MouseEvent} _ @param {EditorView} view */
function mousedown(_, view) {
  if (!view.hasFocus) called.add(view);
  view.setTabFocusMode(false);
}

/** @param {FocusEvent} _ @param {EditorView} view */
function blur(_, view) {
  if (!document.hasFocus()) called.add(view);
}

/** @param {FocusEvent} event @param {EditorView} view */
function focus({ relatedTarget }, view) {
  const within = relatedTarget instanceof Node && view.dom.contains(relatedTarget);
  if (!called.delete(view) && !within) view.setTabFocusMode(true);
}

const CLASSES = syntaxHighlighting(
  tagHighlighter([
    { tag: tags.tagName, class: "source-tag" },
    { tag: tags.angleBracket, class: "source-bracket" },
    { tag: tags.attributeName, class: "source-name" },
    { tag: [tags.attributeValue, tags.string, tags.content], class: "source-value" },
    { tag: [tags.number, tags.bool, tags.atom], class: "source-value" },
    { tag: tags.propertyName, class: "source-name" },
    { tag: [tags.comment, tags.processingInstruction, tags.documentMeta], class: "source-comment" },
    { tag: [tags.character, tags.meta, tags.keyword, tags.labelName], class: "source-special" },
    { tag: tags.invalid, class: "source-invalid" },
    {
      tag: [tags.function(tags.definition(tags.variableName)), tags.definition(tags.className)],
      class: "source-tag",
    },
    { tag: [tags.self, tags.null], class: "source-special" },
  ]),
);

const XACRO = new MatchDecorator({
  regexp: /(\$\$?\{[^{}\n]*\}|\$\$?\([^()\n]*(?:\([^()\n]*\)[^()\n]*)*\))|(<\/?xacro:[\w.:-]*)/g,
  decoration: ([, expression]) => (expression ? EXPRESSION : XACRO_TAG),
});
const EXPRESSION = Decoration.mark({ class: "source-expression" });
const XACRO_TAG = Decoration.mark({ class: "source-xacro" });

const XACRO_MARKS = ViewPlugin.define(
  (view) => {
    let marks = XACRO.createDeco(view);
    return {
      /** @param {import("vendor/codemirror.js").ViewUpdate} update */
      update(update) {
        marks = XACRO.updateDeco(update, marks);
      },
      get marks() {
        return marks;
      },
    };
  },
  { decorations: ({ marks }) => marks },
);

/** How source texts look in the editor: colours by class, styled in source.css. */
export const SOURCE_LOOK = [CLASSES, XACRO_MARKS];

const LIT = Decoration.line({ class: "source-lit" });

/** Line numbers, from 1. @type {import("vendor/codemirror.js").StateEffectType<readonly number[]>} */
export const setLit = StateEffect.define();

const LIT_LINES = StateField.define({
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
      const lit = state.field(LIT_LINES);
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
  for (const at = view.state.field(LIT_LINES).iter(); at.value; at.next())
    places.push(view.lineBlockAt(at.from).top / Math.max(view.contentHeight, 1));
  return places;
}

/** The extension that draws them. */
export const LIGHTS = [LIT_LINES, RULER];

/** Texts of lines with comments behind a #: interfaces, CMakeLists.txt, setup.cfg. */
const HASHED = StreamLanguage.define({
  name: "hashed",
  token(stream) {
    if (stream.match(/^#.*/)) return "comment";
    if (stream.match(/^"(?:[^"\\]|\\.)*"|^'[^']*'/)) return "string";
    if (stream.sol() && stream.match(/^---\s*$|^\[[^\]]*\]/)) return "keyword";
    if (stream.match(/^-?\d+(?:\.\d+)?\b/)) return "number";
    if (stream.sol() && stream.match(/^\s*[\w/]+(?=[\s[<(=])/)) return "propertyName";
    if (!stream.match(/^\w+/)) stream.next();
    return null;
  },
});

/** @param {string} file @returns {"xml" | "yaml" | "python" | "hashed"} how its text is coloured */
export function kindOfText(file) {
  if (/\.ya?ml$/i.test(file)) return "yaml";
  if (/\.pyi?$/i.test(file)) return "python";
  return /\.(msg|srv|action|idl|cfg|toml|ini|txt|md|rst|sh)$/i.test(file) ? "hashed" : "xml";
}

const LANGUAGES = { yaml, xml, python, hashed: () => HASHED };
const PYTHON_STEP = "    ";

const LINES = 400;

/**
 * How a text indents, so that new lines do as the old ones.
 *
 * @param {Iterable<string>} lines
 * @param {string} [usual] where nothing tells
 * @returns {string} a tab or some spaces
 */
export function indentationOf(lines, usual = "  ") {
  /** @type {Map<string, number>} */
  const steps = new Map();
  let before = 0;
  for (const line of firstOf(lines)) {
    const depth = /^ */.exec(line)?.[0].length ?? 0;
    const step = line.startsWith("\t") ? "\t" : " ".repeat(Math.max(depth - before, 0));
    if (step === "\t" || (step.length > 1 && step.length <= 8))
      steps.set(step, (steps.get(step) ?? 0) + 1);
    before = depth;
  }
  const [best] = [...steps].sort((a, b) => b[1] - a[1]);
  return best?.[0] ?? usual;
}

/** @param {Iterable<string>} lines @returns {Generator<string>} those that say something */
function* firstOf(lines) {
  let count = 0;
  for (const line of lines) {
    count += 1;
    if (count > LINES) return;
    if (line.trim() !== "") yield line;
  }
}

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
function openReplace(view) {
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
  const kind = kindOfText(link.file);
  const lines = link.doc.iterLines();
  return EditorState.create({
    doc: link.doc,
    extensions: [
      typing(link),
      changeMarks(link.saved),
      more,
      common,
      LANGUAGES[kind](),
      indentUnit.of(indentationOf(lines, kind === "python" ? PYTHON_STEP : undefined)),
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
