/**
 * Jerry, drawn from above: his flat world, the commands that he gets, and how far he says that
 * things are.
 */

/** @import { Heard, Jerry, Place, Run, Seen } from "./world.js" */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { Icon } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { FieldPanel, followNamespaces, Troubles } from "../demo-panel.js";
import {
  clearWalk,
  command,
  DIRECTIONS,
  formulaText,
  gridLines,
  hearCommands,
  hearPlaces,
  jerries,
  jerryTrouble,
  measure,
  placeText,
  seenOf,
  viewOf,
} from "./world.js";

const STEPS_MAX = 1000;
/** @type {Record<string, string>} */
const FATES = { pending: "dots", followed: "check", ignored: "alert", unknown: "help" };

/** @param {Jerry} one */
const nameOf = ({ prefix }) => prefix || "/";

export function JerryPanel() {
  const parts = { follow: followNamespaces, worlds: jerries, nameOf, world: Shown };
  return html`<${FieldPanel} id="jerry" icon="grid" demo="jerry_robot" ...${parts} />`;
}

/** @typedef {{jerry: Jerry, known: Seen}} Parts each reads the turn of what is known: it stays the same object */

/** @param {{world: Jerry}} props one of them, who is heard from now on */
function Shown({ world: shown }) {
  const known = useMemo(() => seenOf(shown.prefix), [shown.prefix]);
  useEffect(() => hearPlaces(shown.pose, known), [known, shown.pose?.name]);
  useEffect(() => hearCommands(shown.command, known), [known, shown.command?.name]);
  const steps = useSignal(1);
  const place = useSignal(/** @type {Place} */ ({ x: 3, y: 4 }));
  const go = (/** @type {string} */ direction) => {
    if (mayAct.peek()) command(shown, direction, steps.peek());
  };
  const ask = (/** @type {Place} */ at) => {
    place.value = at;
    if (mayAct.peek()) measure(shown, known, at);
  };
  return html`<div class="field-parts">
      <${JerryField} known=${known} go=${go} ask=${ask} />
      <div class="field-tools scroll">
        <${Standing} jerry=${shown} known=${known} />
        <${Commands} jerry=${shown} known=${known} go=${go} steps=${steps} />
        <${Distances} jerry=${shown} known=${known} ask=${ask} place=${place} />
      </div>
    </div>
    <${Troubles} troubles=${[jerryTrouble.value]} />`;
}

/** @param {Parts} props */
function Standing({ jerry: { pose }, known }) {
  known.turn.value;
  const { place } = known.walk;
  const words = place ? t("jerry.at", { place: placeText(place) }) : t("jerry.not_told");
  return html`<div class="field-line"><strong class="jerry-place" role="status">${pose ? words : t("jerry.nobody")}</strong>
    <button type="button" class="button small push" onClick=${() => clearWalk(known)}><${Icon} name="wand" size=${13} />${t("jerry.clear")}</button></div>`;
}

/** @param {Parts & {go: (direction: string) => void, steps: import("vendor/preact.js").Signal<number>}} props */
function Commands({ jerry: { command: topic }, known, go, steps }) {
  known.turn.value;
  const isOff = !mayAct.value || topic === null;
  const type = (/** @type {number} */ typed) => {
    steps.value = Math.min(STEPS_MAX, Math.max(0, Math.round(typed) || 0));
  };
  return html`<fieldset class="field-group" disabled=${isOff}><legend>${t("jerry.commands")}</legend>
      <div class="field-line"><label>${t("jerry.steps")} <input type="number" class="box number" min="0" max=${STEPS_MAX} value=${steps.value} disabled=${isOff}
        onInput=${(/** @type {any} */ event) => type(event.currentTarget.valueAsNumber)} /></label></div>
      <div class="jerry-pad">${DIRECTIONS.map((direction) => html`<button key=${direction} type="button" class="button small" disabled=${isOff} onClick=${() => go(direction)}>${t(`jerry.${direction}`)}</button>`)}</div>
    </fieldset>
    <ul class="jerry-list" aria-label=${t("jerry.heard")}>${known.walk.commands.slice(0, 8).map((one) => html`<${HeardRow} key=${one.number} heard=${one} />`)}</ul>`;
}

/** @param {{heard: Heard}} props */
function HeardRow({ heard: { direction, steps, fate } }) {
  return html`<li class=${`jerry-row ${fate}`}><${Icon} name=${FATES[fate] ?? "dots"} size=${13} /><code>${direction} ${steps}</code><span class="muted">${t(`jerry.fate.${fate}`)}</span></li>`;
}

/** @param {Parts & {ask: (place: Place) => void, place: import("vendor/preact.js").Signal<Place>}} props */
function Distances({ jerry: { distance }, known, ask, place }) {
  known.turn.value;
  const isOff = !mayAct.value || distance === null;
  const box = (/** @type {"x" | "y"} */ axis) =>
    html`<label>${axis} <input type="number" step="any" class="box number" value=${place.value[axis]} disabled=${isOff}
      onInput=${(/** @type {any} */ event) => {
        place.value = { ...place.value, [axis]: event.currentTarget.valueAsNumber || 0 };
      }} /></label>`;
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    ask(place.peek());
  };
  return html`<form class="field-group" aria-label=${t("jerry.distance")} onSubmit=${submit}>
      <div class="field-line">${box("x")}${box("y")}
        <button type="submit" class="button small" disabled=${isOff}><${Icon} name="measure" size=${13} />${t("jerry.ask")}</button></div>
      ${distance === null && html`<p class="note">${t("jerry.no_distance")}</p>`}
    </form>
    <ul class="jerry-list" aria-label=${t("jerry.runs")}>${known.runs.map((one) => html`<${RunRow} key=${one.number} run=${one} />`)}</ul>`;
}

/** @param {{run: Run}} props an answer, and how it is worked out */
function RunRow({ run: { place, from, answer, right, isExact } }) {
  const words = isExact ? t("jerry.exact") : t("jerry.wrong", { right: String(right) });
  return html`<li class=${`jerry-run ${isExact ? "followed" : "ignored"}`}>
    <span class="jerry-row"><${Icon} name=${isExact ? "check" : "alert"} size=${13} /><code>${placeText(place)}</code><span class="muted">${words}</span></span>
    <span class="jerry-formula">${formulaText(from, place)} = ${String(answer)}</span></li>`;
}

/** @type {Record<string, string>} */
const KEYS = {
  ArrowUp: "forward",
  ArrowDown: "backward",
  ArrowLeft: "left",
  ArrowRight: "right",
};
/** Places that were asked for are drawn, so many of them. */
const MARKS_MAX = 8;

/** @param {{known: Seen, go: (direction: string) => void, ask: (place: Place) => void}} props */
function JerryField({ known, go, ask }) {
  known.turn.value;
  const { walk, runs } = known;
  const drawing = useRef(/** @type {any} */ (null));
  const marks = runs.slice(0, MARKS_MAX);
  const view = viewOf([...walk.way, ...marks.map(({ place }) => place)]);
  const { low, size } = view;
  // On the screen y goes to the left and x up.
  const box = `${-low.y - size} ${-low.x - size} ${size} ${size}`;
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    const direction = KEYS[event.key];
    if (!direction || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) go(direction);
  };
  const onClick = (/** @type {MouseEvent} */ event) => {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(
      drawing.current.getScreenCTM().inverse(),
    );
    ask({ x: halved(-y), y: halved(-x) });
  };
  const where = walk.place ? t("jerry.at", { place: placeText(walk.place) }) : "";
  return html`<div class="field-frame jerry-frame" role="application" tabindex="0" aria-label=${t("jerry.field", { where })} onKeyDown=${onKeyDown}>
    <svg ref=${drawing} viewBox=${box} class="jerry-field" style=${`--pixel:${size / 400}px`} onClick=${onClick}>
      <${Grid} view=${view} />
      <polyline class="jerry-way" points=${walk.way.map(pointText).join(" ")} />
      ${marks.map((run) => html`<${Mark} key=${run.number} run=${run} size=${size} />`)}
      ${walk.place && html`<${Figure} place=${walk.place} size=${size} />`}
    </svg></div>`;
}

/** @param {Place} place @returns {string} */
const pointText = ({ x, y }) => `${-y},${-x}`;

/** @param {number} value m @returns {number} to half a metre, and no -0 */
const halved = (value) => Math.round(value * 2) / 2 + 0;

/** @param {{view: import("./world.js").View}} props lines, the axes among them, and their numbers */
function Grid({ view: { low, size, step } }) {
  const letters = size / 32;
  const kind = (/** @type {number} */ at) => (at === 0 ? "jerry-axis" : "jerry-line");
  const ahead = gridLines(low.x, size, step);
  const aside = gridLines(low.y, size, step);
  // The corner where both would stand has none, and no number is cut off by an edge.
  const isRoom = (/** @type {number} */ from, /** @type {number} */ at) =>
    at !== 0 && at - from > 4 * letters && from + size - at > 2 * letters;
  return html`<g>
    ${ahead.map((x) => html`<line key=${`x${x}`} class=${kind(x)} x1=${-low.y - size} x2=${-low.y} y1=${-x} y2=${-x} />`)}
    ${aside.map((y) => html`<line key=${`y${y}`} class=${kind(y)} y1=${-low.x - size} y2=${-low.x} x1=${-y} x2=${-y} />`)}
    ${ahead.filter((x) => isRoom(low.x, x)).map((x) => html`<text key=${`t${x}`} class="jerry-number" font-size=${letters} x=${-low.y - letters / 3} y=${-x - letters / 4} text-anchor="end">x ${x}</text>`)}
    ${aside.filter((y) => isRoom(low.y, y)).map((y) => html`<text key=${`u${y}`} class="jerry-number" font-size=${letters} x=${-y + letters / 4} y=${-low.x - letters / 3}>y ${y}</text>`)}
  </g>`;
}

/** @param {{run: import("./world.js").Run, size: number}} props a place that was asked for, and the way there */
function Mark({ run: { place, from, isExact }, size }) {
  const radius = size / 70;
  return html`<g class=${`jerry-mark ${isExact ? "" : "ignored"}`}>
    <line x1=${-from.y} y1=${-from.x} x2=${-place.y} y2=${-place.x} />
    <circle cx=${-place.y} cy=${-place.x} r=${radius} />
    <text class="jerry-number" font-size=${size / 30} x=${-place.y + radius * 1.5} y=${-place.x - radius}>${placeText(place)}</text></g>`;
}

/** @param {{place: Place, size: number}} props a round robot with two eyes that look ahead */
function Figure({ place, size }) {
  const scale = size / 24;
  return html`<g class="jerry-figure" transform=${`translate(${-place.y} ${-place.x}) scale(${scale})`}>
    <circle class="jerry-ear" cx="-0.48" cy="-0.5" r="0.26" /><circle class="jerry-ear" cx="0.48" cy="-0.5" r="0.26" />
    <circle class="jerry-body" r="0.62" />
    <circle class="jerry-eye" cx="-0.22" cy="-0.2" r="0.12" /><circle class="jerry-eye" cx="0.22" cy="-0.2" r="0.12" />
    <path class="jerry-mouth" d="M-0.26 0.18 Q0 0.42 0.26 0.18" /></g>`;
}
