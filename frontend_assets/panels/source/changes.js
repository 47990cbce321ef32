/** Marks at the edge of a text: the lines that differ from the file on disk. */

/** @import { EditorState, EditorView, Extension, Text, ViewUpdate } from "vendor/codemirror.js" */

import {
  GutterMarker,
  gutter,
  RangeSet,
  RangeSetBuilder,
  StateEffect,
  StateField,
  ViewPlugin,
} from "vendor/codemirror.js";
import { t } from "../../lib/i18n.js";
import { changedLines, hunkAt, oneChange } from "../../lib/text-differences.js";
import { iconElement } from "../../lib/ui.js";
import { closePeek, made, peek } from "./meaning.js";

const SETTLE_MS = 150;

/** The disk says this now. @type {import("vendor/codemirror.js").StateEffectType<Text>} */
export const setSaved = StateEffect.define();
/** @type {import("vendor/codemirror.js").StateEffectType<RangeSet<GutterMarker>>} */
const setMarks = StateEffect.define();

class ChangeMarker extends GutterMarker {
  /** @param {"changed" | "added" | "removed"} kind */
  constructor(kind) {
    super();
    this.kind = kind;
  }

  toDOM() {
    const element = document.createElement("span");
    element.className = `source-change ${this.kind}`;
    element.title = t(`source.line_${this.kind}`);
    return element;
  }
}

const MARKERS = {
  changed: new ChangeMarker("changed"),
  added: new ChangeMarker("added"),
  removed: new ChangeMarker("removed"),
};

/** @param {Text} saved @returns {Extension} */
export function changeMarks(saved) {
  const disk = StateField.define({
    create: () => saved,
    update: (text, { effects }) => effects.findLast((one) => one.is(setSaved))?.value ?? text,
  });
  /** @type {StateField<RangeSet<GutterMarker>>} */
  const marks = StateField.define({
    create: (state) => compared(saved, state),
    update: (set, { effects, changes }) =>
      effects.findLast((one) => one.is(setMarks))?.value ?? set.map(changes),
  });
  return [
    disk,
    marks,
    gutter({
      class: "source-changes",
      markers: (view) => view.state.field(marks),
      domEventHandlers: {
        click: (view, { from }) => showOld(view, from, view.state.field(disk)),
      },
    }),
    ViewPlugin.define((view) => comparing(view, () => view.state.field(disk))),
  ];
}

/** Compares again whenever the typing rests. @param {EditorView} view @param {() => Text} saved */
function comparing(view, saved) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  return {
    /** @param {ViewUpdate} update */
    update({ docChanged, transactions }) {
      const isSaved = transactions.some(({ effects }) => effects.some((one) => one.is(setSaved)));
      if (!docChanged && !isSaved) return;
      clearTimeout(timer);
      timer = setTimeout(
        () => view.dispatch({ effects: setMarks.of(compared(saved(), view.state)) }),
        SETTLE_MS,
      );
    },
    destroy: () => clearTimeout(timer),
  };
}

/** What stood there on disk, and a button that puts it back. @param {EditorView} view @param {number} at @param {Text} saved @returns {boolean} */
function showOld(view, at, saved) {
  const { doc } = view.state;
  const hunk = hunkAt(linesOf(saved), linesOf(doc), doc.lineAt(at).number);
  if (!hunk || closePeek(view)) return hunk !== null;
  const old = linesOf(saved).slice(hunk.oldFrom - 1, hunk.oldTo - 1);
  const head = made("div", "meaning-head", t("source.was"));
  if (!view.state.readOnly) head.append(backButton(() => putBack(view, hunk, old)));
  const text = made("pre", "source-old", old.join("\n"));
  const nothing = made("div", "muted", t("source.was_empty"));
  const card = made("div", "meaning source-was", head, old.length > 0 ? text : nothing);
  card.setAttribute("role", "dialog");
  card.setAttribute("aria-label", t("source.was"));
  peek(view, at, card);
  return true;
}

/** @param {() => void} run */
function backButton(run) {
  const button = made("button", "button small", iconElement("undo"), t("source.put_back"));
  button.type = "button";
  button.addEventListener("click", run);
  return button;
}

/** @param {EditorView} view @param {import("../../lib/text-differences.js").Hunk} hunk @param {readonly string[]} old as if it were typed */
function putBack(view, { from, to }, old) {
  const now = linesOf(view.state.doc);
  const lines = [...now.slice(0, from - 1), ...old, ...now.slice(to - 1)];
  const changes = oneChange(now.join("\n"), lines.join("\n"));
  view.dispatch({ changes, userEvent: "input" });
  view.focus();
}

/** @param {Text} saved @param {EditorState} state @returns {RangeSet<GutterMarker>} */
function compared(saved, { doc }) {
  if (saved.eq(doc)) return RangeSet.empty;
  /** @type {RangeSetBuilder<GutterMarker>} */
  const built = new RangeSetBuilder();
  for (const { line, kind } of changedLines(linesOf(saved), linesOf(doc))) {
    const { from } = doc.line(line);
    built.add(from, from, MARKERS[kind]);
  }
  return built.finish();
}

/** @param {Text} text @returns {string[]} */
const linesOf = (text) => [...text.iterLines()];
