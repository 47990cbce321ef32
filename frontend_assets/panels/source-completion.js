/** Completion in the source: the studio says what may stand at the cursor. */

/** @import { Completion, CompletionContext, CompletionResult, Extension } from "vendor/codemirror.js" */
/** @import { Completion as Offer, Completions } from "../types/wire.d.ts" */
/** @import { TextLink } from "../app/texts.js" */

import {
  acceptCompletion,
  autocompletion,
  keymap,
  snippet,
  startCompletion,
} from "vendor/codemirror.js";
import { complete } from "../app/language.js";
import { t } from "../lib/i18n.js";
import { kindIcon } from "../lib/kinds.js";
import { snippetTemplate } from "../lib/snippets.js";
import { iconElement } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";

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
  const kind = /** @type {import("../types/wire.d.ts").SubjectKind} */ (type);
  const mark = document.createElement("span");
  mark.className = "completion-kind";
  mark.dataset.kind = kind;
  mark.title = t(`language.kind.${kind}`);
  mark.append(iconElement(kindIcon(kind)));
  return mark;
}
