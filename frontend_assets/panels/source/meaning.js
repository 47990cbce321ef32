/**
 * What a word of the source stands for, as a small card at the cursor: its values, its text,
 * where it is defined, or a list of places.
 */

/** @import { Command, Completions, Meaning, Parameter, References, SubjectKind, TextPlace } from "../../types/wire.d.ts" */
/** @import { EditorView, Extension, Tooltip } from "vendor/codemirror.js" */
/** @import { Answer, Asked } from "../../model/wire.js" */
/** @import { TextLink } from "./shared-text.js" */

import {
  closeHoverTooltips,
  keymap,
  StateEffect,
  StateField,
  showTooltip,
} from "vendor/codemirror.js";
import { t } from "../../lib/i18n.js";
import { shownNumbers } from "../../lib/numbers.js";
import { placeText } from "../../lib/paths.js";
import { iconElement } from "../../lib/ui.js";
import { showFile, showSource } from "../../model/source.js";
import { send } from "../../model/wire.js";

const VALUES_SHOWN = 6;
const PLACES_SHOWN = 8;

/**
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {string} names of classes
 * @param {...(Node | string)} content
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function made(tag, names, ...content) {
  const element = document.createElement(tag);
  if (names) element.className = names;
  element.append(...content);
  return element;
}

/** @param {Meaning} meaning @returns {HTMLElement} */
export function meaningCard(meaning) {
  const card = made("div", "meaning");
  card.append(head(meaning), ...values(meaning), ...texts(meaning), ...places(meaning));
  return card;
}

/** @param {Meaning} meaning */
function head({ kind, name, parameters }) {
  const words = made("span", "meaning-kind", t(`language.kind.${kind}`));
  const title = made("code", "", kind === "expression" ? `\${${name}}` : name);
  const line = made("div", "meaning-head", iconElement(kindIcon(kind)), title);
  if (parameters.length > 0) line.append(made("code", "muted", parametersText(parameters)));
  line.append(words);
  return line;
}

/** @param {readonly Parameter[]} parameters @returns {string} those that a call may leave out with their default */
function parametersText(parameters) {
  const stars = { value: "", block: "*", blocks: "**" };
  return parameters
    .map(({ name, kind, default: text, forwards }) => {
      const own = `${stars[/** @type {keyof typeof stars} */ (kind)] ?? ""}${name}`;
      if (text !== null) return `${own}=${text === "" ? "''" : text}`;
      return forwards ? `${own}=^` : own;
    })
    .join("  ");
}

/** @param {Meaning} meaning @returns {HTMLElement[]} what it came to, and what the expression around it did */
function values({ kind, values: seen, unit, expression, expression_values: whole, calls }) {
  /** @type {HTMLElement[]} */
  const lines = [];
  if (seen.length > 0) lines.push(valueLine("=", seen, unit));
  if (kind === "macro") lines.push(made("div", "muted", t("language.calls", { count: calls })));
  if (expression !== "" && whole.length > 0 && !sameValues(seen, whole))
    lines.push(valueLine(`${expression} =`, whole, ""));
  return lines;
}

/** @param {readonly string[]} a @param {readonly string[]} b */
const sameValues = (a, b) => a.length === b.length && a.every((one, at) => one === b[at]);

/** @param {string} before @param {readonly string[]} seen @param {string} unit */
function valueLine(before, seen, unit) {
  const line = made("div", "meaning-values", made("code", "muted", before));
  seen.slice(0, VALUES_SHOWN).forEach((value, at) => {
    if (at > 0) line.append(made("span", "muted", "·"));
    const shown = made("code", "meaning-value", value === "" ? "''" : shownNumbers(value));
    shown.title = value;
    line.append(shown);
  });
  if (unit !== "") line.append(made("span", "muted", unit));
  const more = seen.length - VALUES_SHOWN;
  if (more > 0) line.append(made("span", "muted", t("language.more", { count: more })));
  return line;
}

/** @param {Meaning} meaning @returns {HTMLElement[]} how it is written, and what its comments say */
function texts({ kind, name, text, values: seen, doc }) {
  /** @type {HTMLElement[]} */
  const lines = [];
  const isNews = text !== "" && !(seen.length === 1 && seen[0] === text);
  if (isNews) lines.push(made("div", "muted", t("language.written", { text })));
  const said = kind === "tag" ? t(`language.tag.${name}`) : doc;
  if (said !== "") lines.push(made("p", "meaning-doc", said));
  return lines;
}

/** @param {Meaning} meaning @returns {HTMLElement[]} */
function places({ places: found, target, kind }) {
  const links = found.slice(0, PLACES_SHOWN).map((place) => placeButton(place));
  if (target !== "" && (kind !== "file" || links.length === 0))
    links.unshift(made("code", "muted", target));
  return links.length > 0 ? [made("div", "meaning-places", ...links)] : [];
}

/** @param {TextPlace} place @param {string} [words] @returns {HTMLElement} leads there */
export function placeButton(place, words = placeText(place)) {
  const button = made("button", "text-button", words);
  button.type = "button";
  button.title = place.file;
  button.addEventListener("click", () => goTo(place));
  return button;
}

/** @param {TextPlace} place */
export function goTo({ file, line, column, length }) {
  if (line === 1 && column === 1 && length === 0) showFile(file);
  else showSource(file, line, column);
}

/** @type {import("vendor/codemirror.js").StateEffectType<{pos: number, card: HTMLElement} | null>} */
const setPeek = StateEffect.define();

/** @type {StateField<Tooltip | null>} */
const peeked = StateField.define({
  /** @returns {Tooltip | null} */
  create: () => null,
  update(tooltip, { effects, docChanged, selection }) {
    const set = effects.findLast((one) => one.is(setPeek));
    if (set) return set.value ? tooltipOf(set.value) : null;
    return docChanged || selection ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

/** @param {{pos: number, card: HTMLElement}} peek @returns {Tooltip} */
function tooltipOf({ pos, card }) {
  // At once, so that what is typed next is meant for the card.
  const mount = () => firstOf(card)?.focus({ preventScroll: true });
  return { pos, above: false, create: () => ({ dom: card, mount }) };
}

/** @param {HTMLElement} card @returns {HTMLElement | null} what takes the focus in it */
const firstOf = (card) => card.querySelector("input") ?? card.querySelector("button");

/** @type {Extension} */
export const PEEK = [peeked, keymap.of([{ key: "Escape", run: closePeek }])];

/** @param {EditorView} view @param {number} pos @param {HTMLElement} card its field, or first button, gets the focus */
export function peek(view, pos, card) {
  card.addEventListener("keydown", (event) => onKey(view, card, event));
  card.addEventListener("click", ({ target }) => {
    if (target instanceof Element && target.closest("button")) closePeek(view);
  });
  view.dispatch({ effects: [closeHoverTooltips, setPeek.of({ pos, card })] });
}

/** @param {EditorView} view @returns {boolean} there was one */
export function closePeek(view) {
  if (!view.state.field(peeked, false)) return false;
  view.dispatch({ effects: setPeek.of(null) });
  view.focus();
  return true;
}

/** @param {EditorView} view @param {HTMLElement} card @param {KeyboardEvent} event */
function onKey(view, card, event) {
  const all = [...card.querySelectorAll("button")];
  const at = all.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
  /** @type {Record<string, number>} */
  const moves = { ArrowDown: at + 1, ArrowUp: at - 1 + all.length };
  const to = moves[event.key];
  if (to !== undefined && all.length > 0) all[to % all.length]?.focus();
  else if (event.key === "Escape") closePeek(view);
  else return;
  event.preventDefault();
  event.stopPropagation();
}

/** @type {Record<SubjectKind, string>} names of icons */
const ICONS = {
  property: "properties",
  arg: "sliders",
  parameter: "sliders",
  block: "copy",
  macro: "macro",
  namespace: "includes",
  package: "package",
  file: "file",
  folder: "folder",
  yaml: "fileCode",
  function: "source",
  constant: "dots",
  variable: "dots",
  environment: "system",
  command: "source",
  link: "box",
  joint: "joints",
  expression: "source",
  tag: "source",
  element: "source",
  attribute: "source",
  value: "dots",
};

/**
 * How the things that a text can name are shown.
 *
 * @param {SubjectKind} kind
 * @returns {string} the name of its icon
 */
export const kindIcon = (kind) => ICONS[kind];

/** @param {Asked<Command>} command @returns {Promise<Answer | null>} */
const asked = (command) => send(command).catch(() => null);

/** @param {TextLink} link @param {number} offset @returns {Promise<Meaning | null>} what stands there */
export async function lookUp(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "look_up", file: link.file, offset });
  return answer?.type === "meaning" ? answer.meaning : null;
}

/** @param {TextLink} link @param {number} offset @returns {Promise<References | null>} who names it */
export async function referencesTo(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "get_references", file: link.file, offset });
  return answer?.type === "references" ? answer.references : null;
}

/** @param {TextLink} link @param {number} offset @returns {Promise<Completions | null>} what may be typed */
export async function complete(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "complete", file: link.file, offset });
  return answer?.type === "completions" ? answer.completions : null;
}
