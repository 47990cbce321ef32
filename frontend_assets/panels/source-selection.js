/**
 * The selection of this person in the source: a cursor that is put into a link or joint selects it, and
 * the one that is selected elsewhere is marked and comes into view. Neither moves the cursor or the focus.
 */

/** @import { EditorState, Extension } from "vendor/codemirror.js" */
/** @import { TextLink } from "../app/texts.js" */
/** @import { SourceTexts } from "./source-texts.js" */

import {
  Decoration,
  EditorView,
  ensureSyntaxTree,
  StateEffect,
  StateField,
  syntaxTree,
} from "vendor/codemirror.js";
import { useEffect } from "vendor/preact.js";
import { lineOfPart } from "../lib/part-lines.js";
import { whenPlaced } from "../lib/seen.js";
import { robot } from "../model/document.js";
import { part, partWrittenAt, selection, selectPart, splitKey } from "../model/selection.js";
import { fromElsewhere } from "./source-editor.js";

/** @typedef {ReturnType<typeof syntaxTree>["topNode"]} SyntaxNode */

const BY_SOURCE = "source";
const PARSE_MS = 20;
const CHOSEN = Decoration.line({ class: "source-chosen" });
const PARTS = new Set(["link", "joint"]);

/** Line of the selected part, from 1; 0: none. @type {import("vendor/codemirror.js").StateEffectType<number>} */
const setChosen = StateEffect.define();

const MARK = StateField.define({
  create: () => Decoration.none,
  update(mark, { effects, changes, state: { doc } }) {
    const told = effects.findLast((one) => one.is(setChosen));
    if (!told) return mark.map(changes);
    const { value: line } = told;
    return line >= 1 && line <= doc.lines
      ? Decoration.set([CHOSEN.range(doc.line(line).from)])
      : Decoration.none;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** @param {TextLink} link @returns {Extension} for the editor of one text */
export function selecting(link) {
  const listener = EditorView.updateListener.of(
    ({ state, selectionSet, docChanged, transactions }) => {
      // Whoever types is in a part already; what came from elsewhere is nobody's choice here.
      if (!selectionSet || docChanged) return;
      if (transactions.some((one) => one.annotation(fromElsewhere))) return;
      selectAround(link.file, state);
    },
  );
  return [MARK, listener];
}

/** @param {string} file @param {EditorState} state */
function selectAround(file, state) {
  const known = robot.value;
  if (!known) return;
  const { head } = state.selection.main;
  const tree = ensureSyntaxTree(state, head, PARSE_MS) ?? syntaxTree(state);
  for (let at = /** @type {SyntaxNode | null} */ (tree.resolveInner(head, 0)); at; at = at.parent) {
    const element = at.name === "Element" ? elementOf(at, state) : null;
    const found =
      element && partWrittenAt(known, { file, ...element }, selection.value?.link ?? null);
    if (!found) continue;
    if (found !== part.value) selectPart(found, "", "", BY_SOURCE);
    return;
  }
}

/** @param {SyntaxNode} node @param {EditorState} state @returns {{kind: string, name: string, line: number} | null} a link or joint */
function elementOf(node, { doc }) {
  const text = (/** @type {SyntaxNode | null | undefined} */ one) =>
    one ? doc.sliceString(one.from, one.to) : "";
  const tag = node.firstChild;
  const kind = text(tag?.getChild("TagName"));
  if (!tag || !PARTS.has(kind)) return null;
  const named = tag
    .getChildren("Attribute")
    .find((one) => text(one.getChild("AttributeName")) === "name");
  const name = text(named?.getChild("AttributeValue")).slice(1, -1);
  return { kind, name, line: doc.lineAt(node.from).number };
}

/** What is selected is marked in the text in front, and in view. @param {SourceTexts} texts */
export function useSelection(texts) {
  const link = texts.shown.value?.link;
  const chosen = selection.value;
  const parts = robot.value;
  useEffect(() => {
    const { view } = texts;
    if (!link || !view) return;
    view.dispatch({ effects: setChosen.of(lineIn(link.file, view.state)) });
  }, [link, chosen, parts]);
  useEffect(() => {
    const { view } = texts;
    if (!link || !view || !chosen || chosen.by === BY_SOURCE) return undefined;
    return whenPlaced(view.dom, () => bringIntoView(view, lineIn(link.file, view.state)));
  }, [link, chosen]);
}

/** @param {string} file @param {EditorState} state @returns {number} line of the selected part; 0: it is not in this file */
function lineIn(file, { doc }) {
  const [kind, name] = splitKey(part.value ?? "");
  const all = kind === "joint" ? robot.value?.joints : robot.value?.links;
  const found = PARTS.has(kind) ? all?.find((one) => one.name === name && one.file === file) : null;
  return found ? lineOfPart(doc, { kind, name, line: found.line }) : 0;
}

/** A line that is seen stays where it is. @param {EditorView} view @param {number} line */
function bringIntoView(view, line) {
  if (line === 0) return;
  const { from } = view.state.doc.line(line);
  const { top, bottom } = view.lineBlockAt(from);
  const { scrollTop, clientHeight } = view.scrollDOM;
  if (top >= scrollTop && bottom <= scrollTop + clientHeight) return;
  view.dispatch({ effects: EditorView.scrollIntoView(from, { y: "center" }) });
}
