/** What a word of the source stands for, as a small card: its values, its text, where it is defined. */

/** @import { Meaning, Parameter, TextPlace } from "../types/wire.d.ts" */

import { t } from "../lib/i18n.js";
import { kindIcon } from "../lib/kinds.js";
import { shownNumbers } from "../lib/numbers.js";
import { placeText } from "../lib/paths.js";
import { iconElement } from "../lib/ui.js";
import { showFile, showSource } from "../model/source.js";

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
export function parametersText(parameters) {
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
