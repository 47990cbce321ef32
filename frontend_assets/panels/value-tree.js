/** Plain values as a tree that folds: a reply, a result, feedback. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shownNumber } from "../lib/numbers.js";

/** Lists and messages with more are folded at first. */
const OPEN_MAX = 12;
const SHOWN_MAX = 500;

/** @param {{value: unknown, label: string}} props */
export function ValueTree({ value, label }) {
  const entries = entriesOf(value);
  if (entries.length === 0) return html`<p class="note">${t("form.empty")}</p>`;
  return html`<dl class="value-tree" aria-label=${label}>${entries.map(([name, inner]) => html`<${Entry} key=${name} name=${name} value=${inner} />`)}</dl>`;
}

/** @param {{name: string, value: unknown}} props */
function Entry({ name, value }) {
  if (typeof value !== "object" || value === null)
    return html`<div class="value-row"><dt>${name}</dt><dd title=${wholeText(value)}>${textOf(value)}</dd></div>`;
  const entries = entriesOf(value);
  if (entries.length === 0)
    return html`<div class="value-row"><dt>${name}</dt><dd>${Array.isArray(value) ? "[]" : "{}"}</dd></div>`;
  if (Array.isArray(value) && value.length <= OPEN_MAX && value.every(isLeaf))
    return html`<div class="value-row"><dt>${name}</dt><dd title=${value.map(wholeText).join(", ")}>[${value.map(textOf).join(", ")}]</dd></div>`;
  return html`<details class="value-inner" open=${entries.length <= OPEN_MAX}><summary>${name}<small>${entries.length}</small></summary>
    <dl>${entries.slice(0, SHOWN_MAX).map(([key, inner]) => html`<${Entry} key=${key} name=${key} value=${inner} />`)}</dl></details>`;
}

/** @param {unknown} value @returns {[string, unknown][]} */
const entriesOf = (value) =>
  typeof value === "object" && value !== null
    ? Object.entries(value).map(([key, inner]) => [Array.isArray(value) ? `[${key}]` : key, inner])
    : [];

/** @param {unknown} value */
const isLeaf = (value) => typeof value !== "object" || value === null;

/** @param {unknown} value */
const wholeText = (value) => (value === "" ? '""' : String(value));

/** @param {unknown} value @returns {string} a fraction with as many digits as are read */
const textOf = (value) =>
  typeof value === "number" && !Number.isInteger(value) ? shownNumber(value) : wholeText(value);
