/**
 * Two states side by side: what is chosen, the ghost in 3D, what the files were given, and what
 * became of the robot, filtered and sorted.
 */

/** @import { DifferenceView, InputDifference, Side } from "../../types/wire.d.ts" */

import { effect, html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { allSettled } from "../../lib/latest.js";
import { allDigits, shownNumber, shownNumbers } from "../../lib/numbers.js";
import { Slider } from "../../lib/slider.js";
import { Icon, IconButton, ProgressBar, SearchBox } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { displays, robot } from "../../model/document.js";
import { ask, setDisplay } from "../../model/requests.js";
import { hovered, selected, selectLink } from "../../model/selection.js";
import {
  canCompare,
  compareSides,
  comparison,
  sideKey,
  sideName,
  sideOf,
  variants,
} from "../../model/variants.js";
import { degrees } from "../../model/view.js";
import { viewport } from "../../model/viewport.js";
import { PlaceLink } from "../parts.js";

export function VariantsComparison() {
  const { sides, busy, faults } = comparison.value;
  const section = useComesIntoView(sides !== null);
  if (!sides) return canCompare.value ? html`<${Begin} />` : null;
  return html`<section ref=${section} class="comparison" aria-label=${t("compare.title")}>
    <div class="comparison-bar">
      <header class="comparison-head"><h3>${t("compare.title")}</h3>
        <${IconButton} icon="close" label=${t("compare.end")} disabled=${!mayEdit.value} onClick=${end} /></header>
      <${Sides} sides=${sides} />
      <${GhostControls} />
    </div>
    ${busy && html`<${ProgressBar} label=${t("compare.busy")} done=${0} total=${0} />`}
    ${faults.map((one) => html`<p key=${one} class="variants-note bad" role="status"><${Icon} name="alert" />${one}</p>`)}
    <${InputTable} />
    <${DifferenceTable} />
  </section>`;
}

/** Below the list it would open out of sight. @param {boolean} open @returns {{current: HTMLElement | null}} */
function useComesIntoView(open) {
  const section = useRef(/** @type {HTMLElement | null} */ (null));
  const before = useRef(open);
  useEffect(() => {
    const around = section.current?.closest(".scroll");
    if (around && section.current && open && !before.current)
      around.scrollTop +=
        section.current.getBoundingClientRect().top - around.getBoundingClientRect().top;
    before.current = open;
  }, [open]);
  return section;
}

async function end() {
  const wasBeside = isBeside();
  if (displays.value.ghost?.visible) await setDisplay("ghost", "visible", false);
  await ask({ type: "compare_variants", sides: null });
  if (wasBeside) fitSoon();
}

/** The view was fitted around both robots. @returns {boolean} */
function isBeside() {
  const settings = displays.value.ghost;
  return settings?.visible === true && settings.beside === true;
}

/** Once what went is gone from the scene. */
function fitSoon() {
  setTimeout(() => viewport.value?.fit(), DRAWN_AFTER_MS);
}

function Begin() {
  const { active, modified, variants: list } = variants.value;
  const begin = async () => {
    await allSettled();
    const other = list.find(({ name }) => name !== active);
    /** @type {Side} */
    const saved = { kind: "saved", name: "" };
    /** @type {Side} */
    const present = { kind: "present", name: "" };
    const same = !modified && active === "" && other;
    // What changed since reads from then to now.
    if (same) compareSides(present, { kind: "variant", name: other.name });
    else compareSides(saved, present);
  };
  return html`<div class="comparison-begin">
    <button type="button" class="button small" disabled=${!mayEdit.value} onClick=${begin}>
      <${Icon} name="compare" size=${14} />${t("compare.begin")}</button></div>`;
}

/** @param {{sides: [Side, Side]}} props */
function Sides({ sides: [one, other] }) {
  const swap = () => compareSides(other, one);
  return html`<div class="comparison-sides">
    <${SideChoice} label=${t("compare.one")} side=${one} beside=${other} choose=${(/** @type {Side} */ side) => compareSides(side, other)} />
    <${IconButton} icon="compare" label=${t("compare.swap")} disabled=${!mayEdit.value} onClick=${swap} />
    <${SideChoice} label=${t("compare.other")} side=${other} beside=${one} choose=${(/** @type {Side} */ side) => compareSides(one, side)} />
  </div>`;
}

/** @param {{label: string, side: Side, beside: Side, choose: (side: Side) => void}} props */
function SideChoice({ label, side, beside, choose }) {
  /** @type {Side[]} */
  const all = [
    { kind: "present", name: "" },
    { kind: "saved", name: "" },
    ...variants.value.variants.map(({ name }) => ({
      kind: /** @type {const} */ ("variant"),
      name,
    })),
  ];
  return html`<select class="box" aria-label=${label} value=${sideKey(side)} disabled=${!mayEdit.value} title=${sideName(side)}
    onChange=${(/** @type {any} */ event) => choose(sideOf(event.currentTarget.value))}>
    ${all.map((one) => html`<option key=${sideKey(one)} value=${sideKey(one)} disabled=${sideKey(one) === sideKey(beside)}>${sideName(one)}</option>`)}
  </select>`;
}

/** The scene comes to this page on a lane of its own. */
const DRAWN_AFTER_MS = 400;
const PLACES = /** @type {const} */ (["off", "over", "beside"]);

/** For everybody who looks: whether the other robot is drawn, where, and how clearly. */
function GhostControls() {
  const settings = displays.value.ghost;
  if (!settings) return null;
  const place = settings.visible ? (settings.beside ? "beside" : "over") : "off";
  const off = !mayEdit.value;
  return html`<div class="ghost-controls" role="group" aria-label=${t("ghost")}>
    <span class="ghost-label"><${Icon} name="ghost" size=${14} />${t("ghost")}</span>
    <span class="ghost-places">
      ${PLACES.map((one) => html`<button key=${one} type="button" aria-pressed=${one === place} disabled=${off} title=${t(`ghost.${one}.hint`)} onClick=${() => putGhost(one)}>${t(`ghost.${one}`)}</button>`)}
    </span>
  </div>
  ${place !== "off" && html`<${GhostLook} opacity=${Number(settings.opacity)} off=${off} />`}`;
}

/** @param {{opacity: number, off: boolean}} props which robot it is, and how clearly it is drawn */
function GhostLook({ opacity, off }) {
  const ghost = comparison.value.ghost;
  const move = (/** @type {number} */ value) => setDisplay("ghost", "opacity", value);
  return html`<div class="ghost-look"><p class="ghost-legend">${ghost && html`<i></i>${sideName(ghost)}`}</p>
    <${Slider} label=${t("ghost.opacity")} min=${0.05} max=${1} step=${0.05} value=${opacity}
      text=${`${Math.round(opacity * 100)} %`} disabled=${off} onMove=${move} onEnd=${async () => {}} /></div>`;
}

/** @param {typeof PLACES[number]} place */
async function putGhost(place) {
  const wasBeside = isBeside();
  if (place !== "off") await setDisplay("ghost", "beside", place === "beside");
  await setDisplay("ghost", "visible", place !== "off");
  if (place === "beside") whenDrawn(() => viewport.value?.fit());
  else if (wasBeside) fitSoon();
}

/** Once the ghost stands in the scene, and viser has drawn it. @param {() => void} run */
function whenDrawn(run) {
  const stop = effect(() => {
    if (!comparison.value.ghost) return;
    setTimeout(run, DRAWN_AFTER_MS);
    queueMicrotask(() => stop());
  });
}

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

function InputTable() {
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

function DifferenceTable() {
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

/** @typedef {"part" | "share" | "size"} Order by part, by per cent, or by the bare difference */

const DEGREES = 180 / Math.PI;

/** @param {string} part `link:name`, `joint:name` or `robot` @returns {{kind: string, name: string}} */
export function partOf(part) {
  const at = part.indexOf(":");
  return at < 0 ? { kind: part, name: "" } : { kind: part.slice(0, at), name: part.slice(at + 1) };
}

/**
 * @param {DifferenceView} row
 * @param {(key: string) => string} word the words of one step of `what`
 * @returns {string} e.g. `Visual 2 radius`
 */
export function rowLabel({ what, number }, word) {
  const [first = "", ...rest] = what.split(".");
  const count = number > 0 ? [String(number)] : [];
  const text = [word(first), ...count, ...rest.map(word)].join(" ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** @param {string} unit @param {boolean} degrees @returns {{unit: string, factor: number}} */
export function shownUnit(unit, degrees) {
  if (!degrees || !/^rad\b/.test(unit)) return { unit: unit.replace("^2", "²"), factor: 1 };
  return { unit: unit.replace("rad", "°"), factor: DEGREES };
}

/** @param {number | string | null} value @param {number} factor @returns {string} empty: it has none */
export function valueText(value, factor) {
  if (value === null) return "";
  return typeof value === "number" ? shownNumber(value * factor) : value;
}

/**
 * @param {string} path of a file
 * @param {number | string | null} beside the path that it is compared with
 * @returns {string} from the first folder on that differs
 */
export function endOf(path, beside) {
  const parts = path.split("/");
  const others = typeof beside === "string" ? beside.split("/") : [];
  const at = parts.findIndex((part, n) => part !== others[n]);
  return parts.slice(at < 0 ? -1 : at).join("/");
}

/** @param {number} value @param {(value: number) => string} write @returns {string} with its sign */
function signed(value, write = shownNumber) {
  const text = write(value);
  return value > 0 ? `+${text}` : text.replace("-", "−");
}

/** @param {DifferenceView} row @param {number} factor @returns {{delta: string, percent: string, whole: string}} empty where there is none; `whole`: both with all digits */
export function changeText({ delta, percent }, factor) {
  return {
    delta: delta === null ? "" : signed(delta * factor),
    percent: percent === null ? "" : `${signed(Number(percent.toPrecision(3)))}\u00a0%`,
    whole: [
      delta === null ? "" : signed(delta * factor, allDigits),
      percent === null ? "" : `${signed(percent, allDigits)}\u00a0%`,
    ]
      .filter(Boolean)
      .join(" "),
  };
}

/**
 * @param {readonly DifferenceView[]} rows
 * @param {string} words all of them must occur in the part or the label
 * @param {(row: DifferenceView) => string} label
 * @returns {DifferenceView[]}
 */
export function matching(rows, words, label) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return rows.filter((row) => {
    const text = `${row.part} ${label(row)}`.toLowerCase();
    return wanted.every((word) => text.includes(word));
  });
}

/**
 * @param {readonly DifferenceView[]} rows as the studio lists them: part by part
 * @param {Order} order largest first; what came or went is before all changes
 * @returns {DifferenceView[]}
 */
export function sorted(rows, order) {
  if (order === "part") return [...rows];
  return [...rows].sort((a, b) => weight(b, order) - weight(a, order));
}

/** @param {DifferenceView} row @param {Order} order @returns {number} */
function weight({ one, other, delta, percent }, order) {
  if (one === null || other === null) return Number.MAX_VALUE;
  if (delta === null) return Number.MAX_VALUE / 2;
  if (order === "size") return Math.abs(delta);
  return percent === null ? Number.MAX_VALUE / 4 : Math.abs(percent);
}

/**
 * @param {readonly DifferenceView[]} rows sorted by part
 * @returns {{part: string, rows: DifferenceView[]}[]} neighbours of one part together
 */
export function grouped(rows) {
  /** @type {{part: string, rows: DifferenceView[]}[]} */
  const groups = [];
  for (const row of rows) {
    const last = groups.at(-1);
    if (last?.part === row.part) last.rows.push(row);
    else groups.push({ part: row.part, rows: [row] });
  }
  return groups;
}
