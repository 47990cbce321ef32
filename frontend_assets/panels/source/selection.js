/**
 * The selection of this person in the source: a cursor that is put into a link or joint selects
 * it, the one that is selected elsewhere is marked and brought into view, and what a line shapes
 * lights up.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { EditorState, Extension } from "vendor/codemirror.js" */
/** @import { TextLink } from "./shared-text.js" */

import {
  Decoration,
  EditorView,
  ensureSyntaxTree,
  StateEffect,
  StateField,
  syntaxTree,
} from "vendor/codemirror.js";
import { useEffect } from "vendor/preact.js";
import { whenPlaced } from "../../lib/seen.js";
import { allSites, robot } from "../../model/document.js";
import { hoverSite } from "../../model/origin.js";
import { part, partWrittenAt, selection, selectPart, splitKey } from "../../model/selection.js";
import { fromElsewhere } from "./editor.js";

/** @typedef {{lines: number, line: (number: number) => {text: string}}} Lines as CodeMirror's Text; from 1 */

/**
 * The line of a text in which a link or joint of the robot is written.
 *
 * @param {Lines} doc as it is now; the robot may be of an older one
 * @param {{kind: string, name: string, line: number}} part `line` where it was in the last good run
 * @returns {number} from 1; 0: it is not to be found
 */
export function lineOfPart(doc, { kind, name, line }) {
  const tag = new RegExp(`<${kind}(?:[\\s>]|$)`);
  const isNamed = (/** @type {string} */ text) =>
    tag.test(text) && (text.includes(`"${name}"`) || text.includes(`'${name}'`));
  const there = line >= 1 && line <= doc.lines ? doc.line(line).text : "";
  // A name that a macro makes is not written anywhere; its line is all that is known.
  if (isNamed(there) || (tag.test(there) && there.includes("$"))) return line;
  for (let number = 1; number <= doc.lines; number += 1)
    if (isNamed(doc.line(number).text)) return number;
  return tag.test(there) ? line : 0;
}

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
    const answer = effects.findLast((one) => one.is(setChosen));
    if (!answer) return mark.map(changes);
    const { value: line } = answer;
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

/**
 * Mark what is selected in the text in front, and bring it into view.
 *
 * @param {{view: EditorView | null, shown: Signal<{link: TextLink | null} | null>}} texts
 */
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

/**
 * While the pointer is on a line that sets a property, what it shapes lights up, as from its row.
 *
 * @param {{file: string}} link
 * @returns {Extension} for the editor of one text
 */
export function pointing(link) {
  let line = 0;
  /** @param {number} now line from 1; 0: none */
  const point = (now) => {
    if (now === line) return;
    line = now;
    hoverSite(now === 0 ? null : siteAt(link.file, now));
  };
  return EditorView.domEventHandlers({
    mousemove({ clientX, clientY }, view) {
      const at = view.posAtCoords({ x: clientX, y: clientY });
      point(at === null ? 0 : view.state.doc.lineAt(at).number);
    },
    mouseleave: () => point(0),
  });
}

/** @param {string} file @param {number} line @returns {string | null} of several the first */
function siteAt(file, line) {
  for (const one of allSites().values()) if (one.file === file && one.line === line) return one.id;
  return null;
}
