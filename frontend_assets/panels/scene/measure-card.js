/** The card of the measuring tool over the 3D view: what to click next, and what was measured. */

/** @import { Anchor } from "../../model/viewport.js" */
/** @import { Measure, Measured, Placed, Units, Write } from "../../model/measuring.js" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { t } from "../../lib/i18n.js";
import { allDigits } from "../../lib/numbers.js";
import { LinkPicker } from "../../lib/pick-box.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { robot } from "../../model/document.js";
import {
  addEnd,
  anchorName,
  anchorOfPart,
  angleText,
  deleteMeasure,
  deleteMeasures,
  endsWanted,
  lengthsText,
  MODES,
  measuredNow,
  measureMode,
  measures,
  measuring,
  pending,
  startMeasuring,
  stopMeasuring,
  wantEnds,
} from "../../model/measuring.js";
import { hovered } from "../../model/selection.js";
import { millimetres } from "../../model/tf.js";
import { degrees, notify } from "../../model/view.js";

export function MeasureCard() {
  if (!measuring.value && measures.value.length === 0) return null;
  return html`<aside class="measure-card" aria-label=${t("measure.title")}>
    <header><h3><${Icon} name="measure" size=${15} />${t("measure.title")}</h3>
      <${UnitButtons} />
      ${
        measures.value.length > 0 &&
        html`<${IconButton} icon="trash" label=${t("measure.delete_all")} onClick=${deleteMeasures} />`
      }
      ${
        measuring.value
          ? html`<${IconButton} icon="close" label=${t("measure.end")} hint=${`${t("measure.end")} (Esc)`} onClick=${stopMeasuring} />`
          : html`<${IconButton} icon="plus" label=${t("measure.more")} hint=${`${t("measure.more")} (N)`} onClick=${startMeasuring} />`
      }
    </header>
    ${measuring.value && html`<${Making} />`}
    <${Found} />
  </aside>`;
}

function UnitButtons() {
  const toMillimetres = t(millimetres.value ? "measure.to_m" : "measure.to_mm");
  const toDegrees = t(degrees.value ? "angles.to_radians" : "angles.to_degrees");
  return html`<button type="button" class="unit unit-button" aria-label=${toMillimetres} title=${toMillimetres} onClick=${() => {
    millimetres.value = !millimetres.value;
  }}>${millimetres.value ? "mm" : "m"}</button>
    <button type="button" class="unit unit-button" aria-label=${toDegrees} title=${toDegrees} onClick=${() => {
      degrees.value = !degrees.value;
    }}>${degrees.value ? "°" : "rad"}</button>`;
}

/** What a click means, and what to click next. */
function Making() {
  const step = `measure.next.${pending.value.length + 1}`;
  return html`<div class="measure-making">
    <div class="chips" role="group" aria-label=${t("measure.aim")}>${MODES.map(
      (
        mode,
      ) => html`<button key=${mode} type="button" class="chip" aria-pressed=${measureMode.value === mode}
        title=${t(`measure.aim.${mode}.hint`)} onClick=${() => {
          measureMode.value = mode;
        }}>${t(`measure.aim.${mode}`)}</button>`,
    )}
      <button type="button" class="chip" aria-pressed=${endsWanted.value === 3} title=${t("measure.corner.hint")}
        onClick=${() => wantEnds(endsWanted.value === 3 ? 2 : 3)}>${t("measure.corner.switch")}</button></div>
    <p role="status">${t(step)}</p>
    ${pending.value.length > 0 && html`<p class="measure-ends">${pending.value.map((end) => html`<${End} end=${end} />`)}</p>`}
    <${ByName} />
  </div>`;
}

/** Links and joints by their names, for those who use no mouse. */
function ByName() {
  const turn = useSignal(0);
  const { links = [], joints = [] } = robot.value ?? {};
  /** @type {Map<string, string>} */
  const parts = new Map();
  for (const { name } of links) parts.set(name, `link:${name}`);
  for (const { name } of joints) parts.set(t("measure.joint", { name }), `joint:${name}`);
  /** @param {string} name */
  const onPick = (name) => {
    const anchor = anchorOfPart(joints, parts.get(name) ?? "");
    if (anchor) addEnd(anchor);
    turn.value += 1;
  };
  return html`<${LinkPicker} label=${t("measure.by_name")} placeholder=${t("measure.by_name")} value=${null}
    links=${[...parts.keys()]} onPick=${onPick} />`;
}

/** @param {{end: Anchor}} props */
function End({ end }) {
  const icon = { point: "zero", frame: "frames", axis: "joints" }[end.kind];
  return html`<span class="measure-end" title=${t(`measure.kind.${end.kind}`, { name: anchorName(end) })}
    onPointerEnter=${() => {
      hovered.value = end.link;
    }} onPointerLeave=${() => {
      hovered.value = null;
    }}><${Icon} name=${icon} size=${13} /><span>${anchorName(end)}</span></span>`;
}

function Found() {
  if (measures.value.length === 0) return null;
  return html`<ul class="measure-list">${[...measuredNow.value]
    .reverse()
    .map(
      ({ measure, found }) => html`<${Row} key=${measure.id} measure=${measure} found=${found} />`,
    )}</ul>`;
}

/** @param {{measure: Measure, found: Measured | null}} props */
function Row({ measure, found }) {
  const units = { millimetres: millimetres.value, degrees: degrees.value };
  const facts = found ? factsOf(found, units) : [];
  const [main, ...others] = facts;
  const copy = async () => {
    const lines = facts.map(([words, text]) => `${words}: ${text()}`);
    const names = measure.ends.map(anchorName).join(" – ");
    const done = await copyText([names, ...lines].join("\n"));
    notify(t(done ? "copied" : "copy.failed"), { bad: !done });
  };
  return html`<li>
    <div class="measure-head"><p class="measure-ends">${measure.ends.map((end) => html`<${End} end=${end} />`)}</p>
      <${IconButton} icon="copy" label=${t("measure.copy")} size=${14} onClick=${copy} />
      <${IconButton} icon="trash" label=${t("measure.delete")} size=${14} onClick=${() => deleteMeasure(measure.id)} /></div>
    ${!found && html`<p class="muted">${t("measure.gone")}</p>`}
    ${main && html`<p class="measure-main" title=${`${main[0]}: ${main[1](allDigits)}`}><output aria-label=${main[0]}>${main[1]()}</output></p>`}
    <dl>${others.map(([words, text]) => html`<div><dt>${words}</dt><dd title=${text(allDigits)}>${text()}</dd></div>`)}</dl>
  </li>`;
}

/** @param {Measured} found @param {Units} units @returns {[string, (write?: Write) => string][]} words and numbers, the chief one first */
function factsOf({ ends, distance, inRoot, inFirst, toAxis, angle, corner }, units) {
  const [first, second] = /** @type {[Placed, Placed]} */ (/** @type {unknown} */ (ends));
  /** @param {readonly number[]} values @returns {(write?: Write) => string} */
  const lengths = (values) => (write) => lengthsText(values, units, write);
  /** @param {number} value @returns {(write?: Write) => string} */
  const turn = (value) => (write) => angleText(value, units, write);
  /** @type {[string, (write?: Write) => string][]} */
  const facts = [];
  if (ends.length > 2) {
    const middle = { name: anchorName(second.anchor) };
    facts.push([t("measure.corner", middle), corner === null ? () => "–" : turn(corner)]);
  }
  facts.push([t("measure.distance"), lengths([distance])]);
  if (toAxis !== null) facts.push([t("measure.to_axis"), lengths([toAxis])]);
  facts.push([t("measure.in", { frame: robot.value?.root ?? "" }), lengths(inRoot)]);
  if (first.anchor.link !== robot.value?.root)
    facts.push([t("measure.in", { frame: first.anchor.link }), lengths(inFirst)]);
  if (angle !== null) {
    const [one, other] = [first, second].map(({ anchor }) => t(`measure.direction.${anchor.kind}`));
    facts.push([t("measure.angle", { one: one ?? "", other: other ?? "" }), turn(angle)]);
  }
  return facts;
}
