/** The URDF, or what changed in it, in a text that is only read: coloured, folded, searched, numbered. */

/** @import { Extension } from "vendor/codemirror.js" */
/** @import { DiffLineView, UrdfChanges } from "../../types/wire.d.ts" */

import {
  crosshairCursor,
  Decoration,
  defaultKeymap,
  drawSelection,
  EditorState,
  EditorView,
  foldGutter,
  foldKeymap,
  GutterMarker,
  gutter,
  highlightSelectionMatches,
  keymap,
  lineNumbers,
  openSearchPanel,
  RangeSetBuilder,
  search,
  searchKeymap,
  xml,
} from "vendor/codemirror.js";
import { t } from "../../lib/i18n.js";
import { oneChange } from "../../lib/text-differences.js";
import { editorWords, foldMark, LIGHTS, SOURCE_LOOK, setLit } from "../source/editor.js";

/** @typedef {(line: number, column: number) => void} Choose a line, from 0, and the letter in it */

/** One view: it shows a whole text, or stretches of changed lines. */
export class UrdfText {
  /** What its view shows by lines: null for a text as it is. @type {readonly Row[] | null} */
  #rows = null;

  /** @param {HTMLElement} parent @param {Choose} choose told of clicks while a whole text is shown */
  constructor(parent, choose) {
    this.choose = choose;
    this.view = new EditorView({ state: this.#stateOf("", null), parent });
  }

  destroy() {
    this.view.destroy();
  }

  /** @param {string} text what stays the same in it stays where it is in view */
  showText(text) {
    if (this.#rows) this.view.setState(this.#stateOf(text, null));
    else this.view.dispatch({ changes: oneChange(this.view.state.doc.toString(), text) });
    this.#rows = null;
  }

  /** @param {UrdfChanges} changes */
  showChanges({ hunks }) {
    const rows = hunks.flatMap((hunk, at) => (at === 0 ? hunk : [GAP, ...hunk]));
    const scroll = this.#rows ? this.view.scrollSnapshot() : null;
    const text = rows.map((row) => row.text).join("\n");
    this.view.setState(this.#stateOf(text, rows));
    if (scroll) this.view.dispatch({ effects: scroll });
    this.#rows = rows;
  }

  /** @param {number} line from 0 that lights up and comes into view; -1: none */
  light(line) {
    const { view } = this;
    if (this.#rows || line >= view.state.doc.lines) return;
    view.dispatch({ effects: setLit.of(line < 0 ? [] : [line + 1]) });
    if (line < 0) return;
    const { from } = view.state.doc.line(line + 1);
    const block = view.lineBlockAt(from);
    const { scrollTop, clientHeight } = view.scrollDOM;
    if (block.top >= scrollTop && block.bottom <= scrollTop + clientHeight) return;
    view.dispatch({ effects: EditorView.scrollIntoView(from, { y: "center" }) });
  }

  find() {
    openSearchPanel(this.view);
  }

  /** @param {string} text @param {readonly Row[] | null} rows */
  #stateOf(text, rows) {
    return EditorState.create({
      doc: text,
      extensions: [
        rows ? changed(rows) : [lineNumbers(), foldGutter({ markerDOM: foldMark })],
        ...this.#common(),
      ],
    });
  }

  /** @returns {Extension[]} */
  #common() {
    return [
      xml(),
      drawSelection(),
      crosshairCursor(),
      highlightSelectionMatches(),
      search({ top: true }),
      keymap.of([
        { key: "Enter", run: (view) => this.#chosen(view, view.state.selection.main.head) },
      ]),
      keymap.of([...searchKeymap, ...foldKeymap, ...defaultKeymap]),
      EditorState.readOnly.of(true),
      EditorState.phrases.of(editorWords()),
      EditorView.editorAttributes.of({ class: "urdf-text" }),
      EditorView.contentAttributes.of({ "aria-label": t("panel.urdf"), tabindex: "0" }),
      EditorView.domEventHandlers({ mouseup: (event, view) => this.#clicked(event, view) }),
      SOURCE_LOOK,
      LIGHTS,
    ];
  }

  /** @param {EditorView} view @param {number} pos @returns {boolean} */
  #chosen(view, pos) {
    if (this.#rows) return false;
    const line = view.state.doc.lineAt(pos);
    this.choose(line.number - 1, pos - line.from);
    return true;
  }

  /** A press, but not the end of a drag; a click never comes where the press drew the line anew. @param {MouseEvent} event @param {EditorView} view @returns {boolean} */
  #clicked(event, view) {
    if (event.button !== 0) return false;
    const pos = view.posAtCoords({ x: event.clientX, y: event.clientY });
    const { from, to } = view.state.selection.main;
    if (pos !== null && (from === to || (from < pos && pos < to))) this.#chosen(view, pos);
    return false;
  }
}

/** @typedef {Pick<DiffLineView, "before" | "after" | "text"> & {kind: DiffLineView["kind"] | "gap"}} Row */
/** Between two stretches: lines that are the same. @type {Row} */
const GAP = { kind: "gap", before: null, after: null, text: "" };

/** @param {readonly Row[]} rows @returns {Extension} the lines coloured by what became of them, with both their numbers */
function changed(rows) {
  /** @type {RangeSetBuilder<Decoration>} */
  const built = new RangeSetBuilder();
  let at = 0;
  for (const { kind, text } of rows) {
    if (kind !== "same") built.add(at, at, LINES[kind]);
    at += text.length + 1;
  }
  return [
    numbers(rows, "before"),
    numbers(rows, "after"),
    signs(rows),
    EditorView.decorations.of(built.finish()),
  ];
}

const LINES = {
  old: Decoration.line({ class: "urdf-old" }),
  new: Decoration.line({ class: "urdf-new" }),
  gap: Decoration.line({ class: "urdf-gap" }),
};

class Words extends GutterMarker {
  /** @param {string} words */
  constructor(words) {
    super();
    this.words = words;
  }

  /** @param {Words} other */
  eq(other) {
    return this.words === other.words;
  }

  toDOM() {
    return document.createTextNode(this.words);
  }
}

/** @param {readonly Row[]} rows @param {"before" | "after"} side */
function numbers(rows, side) {
  const widest = String(rows.reduce((most, row) => Math.max(most, row[side] ?? 0), 0));
  return gutter({
    class: "cm-lineNumbers urdf-numbers",
    lineMarker: (view, { from }) =>
      new Words(String(rows[view.state.doc.lineAt(from).number - 1]?.[side] ?? "")),
    initialSpacer: () => new Words(widest),
  });
}

/** @param {readonly Row[]} rows */
function signs(rows) {
  const written = { same: "", gap: "⋯", old: "−", new: "+" };
  return gutter({
    class: "urdf-signs",
    lineMarker: (view, { from }) =>
      new Words(written[rows[view.state.doc.lineAt(from).number - 1]?.kind ?? "same"]),
    initialSpacer: () => new Words("⋯"),
  });
}
