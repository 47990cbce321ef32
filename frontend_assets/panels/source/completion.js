/**
 * Completion in the source: the studio says what may stand at the cursor; texts with places for
 * the cursor are written on a line of their own.
 */

/** @import { Completion, CompletionContext, CompletionResult, EditorView, Extension } from "vendor/codemirror.js" */
/** @import { Completion as Offer, Completions } from "../../types/wire.d.ts" */
/** @import { TextLink } from "./shared-text.js" */

import {
  acceptCompletion,
  autocompletion,
  keymap,
  snippet,
  startCompletion,
} from "vendor/codemirror.js";
import { t } from "../../lib/i18n.js";
import { iconElement } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { complete, kindIcon } from "./meaning.js";

/** Typing one of these asks; a blank only inside a tag. */
const ASKING = /[\w:.\-/<${(["'=]$/;
const IN_TAG = /<[^<>]*\s$/;
const LOOK_BACK = 500;
const STILL_FITS = /^[\w:.-]*$/;
/** Of a path beside a suggestion so much is seen. */
const DETAIL_CHARACTERS = 32;
const BOOST_MOST = 99;
const GOES_ON = new Set(["command", "folder", "package"]);

/** @param {TextLink} link @returns {Extension} */
export function completion(link) {
  return [
    autocompletion({
      override: [(context) => source(link, context)],
      icons: false,
      addToOptions: [{ render: (option) => kindMark(option), position: 20 }],
      maxRenderedOptions: 200,
    }),
    keymap.of([{ key: "Tab", run: acceptCompletion }]),
  ];
}

/** @param {TextLink} link @param {CompletionContext} context @returns {Promise<CompletionResult | null>} */
async function source(link, context) {
  if (!mayEdit.value || link.readOnly !== "" || !asks(context)) return null;
  // Whoever types on asks anew: the studio answers the newest question only, and the editor
  // would wait for ever after an old one without an answer.
  context.addEventListener("abort", () => {}, { onDocChange: true });
  const found = await complete(link, context.pos);
  if (!found || context.aborted || found.items.length === 0) return null;
  return resultOf(found);
}

/** @param {CompletionContext} context */
function asks({ explicit, pos, state }) {
  if (explicit) return true;
  const before = state.sliceDoc(Math.max(0, pos - LOOK_BACK), pos);
  return ASKING.test(before) || IN_TAG.test(before);
}

/** @param {Completions} found @returns {CompletionResult} */
function resultOf({ start, end, items, is_whole: isWhole }) {
  const options = items.map((one, at) => optionOf(one, at, items.length));
  const result = { from: start, to: end, options };
  return isWhole ? { ...result, validFor: STILL_FITS } : { ...result, filter: false };
}

/** @param {Offer} offer @param {number} at @param {number} count @returns {Completion} */
function optionOf({ label, kind, insert, stops, detail, doc }, at, count) {
  return {
    label,
    type: kind,
    ...(detail === "" ? {} : { detail: endOf(detail) }),
    ...(doc === "" && endOf(detail) === detail ? {} : { info: doc || detail }),
    apply: writing(kind, insert, stops),
    boost: BOOST_MOST - Math.round((2 * BOOST_MOST * at) / Math.max(count, 1)),
  };
}

/** @param {string} detail @returns {string} of a long path its end, by which it differs from others */
function endOf(detail) {
  if (detail.length <= DETAIL_CHARACTERS || !detail.startsWith("/")) return detail;
  const end = detail.slice(-DETAIL_CHARACTERS);
  return `…${end.slice(Math.max(end.indexOf("/"), 0))}`;
}

/**
 * @param {string} kind @param {string} insert @param {Offer["stops"]} stops
 * @returns {NonNullable<Completion["apply"]>} after what cannot stand alone the next choice is offered
 */
function writing(kind, insert, stops) {
  const write = snippet(snippetTemplate(insert, stops));
  if (!GOES_ON.has(kind) || (stops.length === 0 && !insert.endsWith("/")))
    return stops.length === 0 ? insert : write;
  return (view, option, from, to) => {
    write(view, option, from, to);
    startCompletion(view);
  };
}

/** @param {Completion} option @returns {HTMLElement} what kind of thing it is */
function kindMark({ type }) {
  const kind = /** @type {import("../../types/wire.d.ts").SubjectKind} */ (type);
  const mark = document.createElement("span");
  mark.className = "completion-kind";
  mark.dataset.kind = kind;
  mark.title = t(`language.kind.${kind}`);
  mark.append(iconElement(kindIcon(kind)));
  return mark;
}

/**
 * @param {EditorView} view
 * @param {string} text
 * @param {readonly (readonly number[])[]} stops
 */
export function insertSnippet(view, text, stops) {
  const { from, to } = view.state.selection.main;
  const line = view.state.doc.lineAt(from);
  const before = line.text.slice(0, from - line.from);
  // Into an empty line; else below the line that the cursor is in, as deep as that one.
  const isFree = before.trim() === "" && line.text.slice(to - line.from).trim() === "";
  const template = snippetTemplate(text, stops);
  if (isFree) snippet(template)(view, null, from, to);
  else snippet(`\n${template}`)(view, null, line.to, line.to);
}

/**
 * A `{` or `(` behind `$` brings its other half, which is then typed over: a text that is never closed
 * is an error at every letter.
 *
 * @param {EditorView} view @param {number} from @param {number} to @param {string} text typed there
 * @returns {boolean} it was written here
 */
export function pairedBrackets(view, from, to, text) {
  if (from !== to || view.state.readOnly) return false;
  const { doc } = view.state;
  const line = doc.lineAt(from);
  const before = line.text.slice(0, from - line.from);
  const other = { "{": "}", "(": ")" }[text];
  if (other && /(?:^|[^$])\$$/.test(before)) {
    if (doc.sliceString(from, from + 1) === other) return false;
    write(view, from, from, text + other);
    return true;
  }
  const isOpen = /\$\{[^}]*$/.test(before) ? "}" : /\$\([^)]*$/.test(before) ? ")" : "";
  if (text !== isOpen || doc.sliceString(from, from + 1) !== text) return false;
  write(view, from, from + 1, text);
  return true;
}

/** @param {EditorView} view @param {number} from @param {number} to @param {string} text the cursor goes behind its first sign */
function write(view, from, to, text) {
  view.dispatch({
    changes: { from, to, insert: text },
    selection: { anchor: from + 1 },
    userEvent: "input.type",
    scrollIntoView: true,
  });
}

/**
 * Texts with places for the cursor, as CodeMirror's snippets write them.
 *
 * @param {string} text
 * @param {readonly (readonly number[])[]} stops stretches of the text that the cursor visits, in order
 * @returns {string} a snippet template of CodeMirror
 */
export function snippetTemplate(text, stops) {
  let template = "";
  let at = 0;
  stops.forEach(([start = 0, end = 0], number) => {
    const inside = text.slice(start, end).replaceAll(/[{}]/g, "");
    template += plain(text.slice(at, start));
    template += inside === "" ? `#{${number + 1}}` : `#{${number + 1}:${inside}}`;
    at = end;
  });
  return template + plain(text.slice(at));
}

/** @param {string} text */
const plain = (text) => text.replaceAll(/[{}]/g, "\\$&");
