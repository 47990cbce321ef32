/** The tables of a comparison: what the files were given, and what became of the robot. */

/** @import { DifferenceView, InputDifference } from "../types/wire.d.ts" */
/** @import { Order } from "../lib/differences.js" */

import { html, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import {
  changeText,
  endOf,
  grouped,
  matching,
  partOf,
  rowLabel,
  shownUnit,
  sorted,
  valueText,
} from "../lib/differences.js";
import { t } from "../lib/i18n.js";
import { allDigits, shownNumbers } from "../lib/numbers.js";
import { Icon, SearchBox } from "../lib/ui.js";
import { robot } from "../model/document.js";
import { hovered, selected, selectLink } from "../model/selection.js";
import { comparison, sideName } from "../model/variants.js";
import { degrees } from "../model/view.js";

const SHOWN = 200;

/** The heads of the two columns of values. */
function Heads() {
  const sides = comparison.value.sides;
  if (!sides) return null;
  return sides.map(
    (side) =>
      html`<th key=${side.kind + side.name} scope="col" title=${sideName(side)}>${sideName(side)}</th>`,
  );
}

export function InputTable() {
  const { inputs, busy } = comparison.value;
  if (inputs.length === 0)
    return busy ? null : html`<p class="nothing">${t("compare.inputs.none")}</p>`;
  return html`<table class="differences inputs">
    <caption>${t("compare.inputs")}</caption>
    <thead><tr><th scope="col">${t("compare.name")}</th><${Heads} /></tr></thead>
    <tbody>${inputs.map((one) => html`<${InputRow} key=${`${one.kind}${one.file}${one.name}`} one=${one} />`)}</tbody>
  </table>`;
}

/** @param {{one: InputDifference}} props */
function InputRow({ one }) {
  const place = one.line > 0 ? one : null;
  return html`<tr>
    <th scope="row">${place ? html`<${PlaceLink} place=${{ ...place, column: 1 }} words=${one.name} />` : one.name}
      <small class="muted">${t(`compare.kind.${one.kind}`)}</small></th>
    <td><${Value} text=${shownNumbers(one.one ?? "")} whole=${one.one} none=${one.one === null} /></td>
    <td><${Value} text=${shownNumbers(one.other ?? "")} whole=${one.other} none=${one.other === null} /></td>
  </tr>`;
}

/** @param {{text: string, whole: string | number | null, none: boolean}} props */
function Value({ text, whole, none }) {
  if (none) return html`<span class="muted" title=${t("compare.none")}>–</span>`;
  return html`<span class="value" title=${whole}>${text === "" ? t("launch.empty") : text}</span>`;
}

/** @param {string} key @returns {string} the words of a step, or the step itself */
function word(key) {
  const words = t(`difference.${key}`);
  return words === `difference.${key}` ? key : words;
}

/** @param {DifferenceView} row */
const labelOf = (row) => rowLabel(row, word);

export function DifferenceTable() {
  const filter = useSignal("");
  const order = useSignal(/** @type {Order} */ ("part"));
  const all = useSignal(false);
  const { rows, count, busy } = comparison.value;
  if (rows.length === 0)
    return busy
      ? null
      : html`<p class="nothing"><${Icon} name="check" size=${14} /> ${t("compare.same")}</p>`;
  const found = sorted(matching(rows, filter.value, labelOf), order.value);
  const shown = all.value ? found : found.slice(0, SHOWN);
  return html`<div class="comparison-filter"><h4 id="comparison-count">${t("compare.rows", { count })}</h4>
      <${SearchBox} label=${t("compare.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} /></div>
    <table class="differences" aria-labelledby="comparison-count">
      <thead><tr>
        <${SortHead} order=${order} by="part" words=${t("compare.part")} />
        <${Heads} />
        <${SortHead} order=${order} by="share" words=${t("compare.change")} />
      </tr></thead>
      ${
        order.value === "part"
          ? grouped(shown).map((group) => html`<${Group} key=${group.part} ...${group} />`)
          : html`<tbody>${shown.map((row) => html`<${Row} key=${keyOf(row)} row=${row} named />`)}</tbody>`
      }
    </table>
    ${found.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: filter.value })}</p>`}
    ${
      found.length > shown.length &&
      html`<button type="button" class="button small more" onClick=${() => {
        all.value = true;
      }}>${t("compare.all", { count: found.length })}</button>`
    }
    ${count > rows.length && html`<p class="nothing">${t("compare.first", { shown: rows.length, count })}</p>`}`;
}

/** @param {DifferenceView} row */
const keyOf = ({ part, what, number }) => `${part} ${what} ${number}`;

/** A head that sorts; by change it goes from per cent to the bare difference and back.
 * @param {{order: {value: Order}, by: "part" | "share", words: string}} props */
function SortHead({ order, by, words }) {
  const now = order.value;
  const on = by === "part" ? now === "part" : now !== "part";
  /** @type {Order} */
  const next = by === "part" ? "part" : now === "share" ? "size" : "share";
  const unit = on && by === "share" ? (now === "share" ? " %" : " Δ") : "";
  return html`<th scope="col" aria-sort=${on ? (by === "part" ? "ascending" : "descending") : "none"}>
    <button type="button" class="sort" title=${t(`compare.sort.${next}`)} onClick=${() => {
      order.value = next;
    }}>${words}${unit}${on && html`<${Icon} name="chevronDown" size=${12} />`}</button></th>`;
}

/** @param {{part: string, rows: DifferenceView[]}} props the differences of one part, below its name */
function Group({ part, rows }) {
  const whole = rows.length === 1 && (rows[0]?.what === "link" || rows[0]?.what === "joint");
  if (whole && rows[0]) return html`<tbody><${Row} row=${rows[0]} named /></tbody>`;
  return html`<tbody>
    <tr class="part"><th colspan="4" scope="rowgroup"><${PartName} part=${part} /></th></tr>
    ${rows.map((row) => html`<${Row} key=${keyOf(row)} row=${row} />`)}
  </tbody>`;
}

/** @param {string} part @returns {string | null} the link of the present robot that it is, or that it moves */
function linkOf(part) {
  const { kind, name } = partOf(part);
  if (kind === "link") return robot.value?.links.some((link) => link.name === name) ? name : null;
  return robot.value?.joints.find((joint) => joint.name === name)?.child ?? null;
}

/** @param {{part: string}} props selects the part in 3D and in the tree */
function PartName({ part }) {
  const { kind, name } = partOf(part);
  const words = kind === "robot" ? t("compare.whole") : name;
  const icon = { link: "box", joint: "joints" }[kind] ?? "robot";
  const link = linkOf(part);
  const text = html`<${Icon} name=${icon} size=${13} /><span>${words}</span>`;
  if (!link)
    return html`<span class="part-name" title=${kind === "robot" ? "" : t("compare.not_here")}>${text}</span>`;
  return html`<button type="button" class="part-name" title=${t("compare.select", { name: link })} aria-pressed=${selected.value === link}
    onClick=${() => {
      selectLink(link, "variants");
    }} onPointerEnter=${() => {
      hovered.value = link;
    }} onPointerLeave=${() => {
      hovered.value = null;
    }}>${text}</button>`;
}

/** @param {{row: DifferenceView, named?: boolean}} props `named`: with the part's name */
function Row({ row, named = false }) {
  const { unit, factor } = shownUnit(row.unit, degrees.value);
  const state = row.one === null ? "added" : row.other === null ? "removed" : "";
  return html`<tr class=${state}>
    <th scope="row">${named && html`<${PartName} part=${row.part} />`}<span class="what">${labelOf(row)}${unit && html` <small class="unit">${unit}</small>`}</span></th>
    <td><${Cell} row=${row} value=${row.one} factor=${factor} /></td>
    <td><${Cell} row=${row} value=${row.other} factor=${factor} /></td>
    <td class="change"><${Change} row=${row} factor=${factor} /></td>
  </tr>`;
}

/** @param {{row: DifferenceView, value: number | string | null, factor: number}} props */
function Cell({ row, value, factor }) {
  const text = valueText(value, factor);
  if (/\.(mesh|texture)$/.test(row.what) && typeof value === "string")
    return html`<span class="value path" title=${value}>${endOf(value, value === row.one ? row.other : row.one)}</span>`;
  if (row.what.endsWith(".color") && typeof value === "string")
    return html`<span class="swatch" style=${`background:${colorOf(value)}`} title=${value}></span>`;
  const words =
    typeof value === "string" && /^(link|joint|\w+\.shape|visual|collision)$/.test(row.what)
      ? word(value)
      : text;
  const whole = typeof value === "number" ? allDigits(value * factor) : words;
  return html`<${Value} text=${words} whole=${whole} none=${value === null} />`;
}

/** @param {string} rgba four numbers from 0 to 1 @returns {string} */
function colorOf(rgba) {
  const [red = 0, green = 0, blue = 0, alpha = 1] = rgba.split(" ").map(Number);
  const byte = (/** @type {number} */ share) => Math.round(255 * Math.min(Math.max(share, 0), 1));
  return `rgb(${byte(red)} ${byte(green)} ${byte(blue)} / ${alpha})`;
}

/** @param {{row: DifferenceView, factor: number}} props */
function Change({ row, factor }) {
  if (row.one === null) return html`<span class="came">${t("compare.added")}</span>`;
  if (row.other === null) return html`<span class="went">${t("compare.removed")}</span>`;
  const { delta, percent, whole } = changeText(row, factor);
  if (!delta) return html`<span class="muted">${t("compare.changed")}</span>`;
  return html`<span class="value" title=${whole}>${delta}</span>${percent && html`<small class="muted">${percent}</small>`}`;
}
