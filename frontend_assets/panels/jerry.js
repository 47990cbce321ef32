/** Jerry, drawn: his flat world, the commands that he gets, and how far he says that things are. */

/** @import { Jerry, Place } from "../lib/jerry.js" */
/** @import { Heard } from "../lib/jerry-walk.js" */
/** @import { Run, Seen } from "../app/jerry.js" */

import { html, useEffect, useMemo, useSignal } from "vendor/preact.js";
import {
  clearWalk,
  command,
  hearCommands,
  hearPlaces,
  jerries,
  jerryTrouble,
  measure,
  seenOf,
} from "../app/jerry.js";
import { followNamespaces } from "../app/namespaces.js";
import { mayEdit } from "../app/state/connection.js";
import { t } from "../lib/i18n.js";
import { DIRECTIONS, formulaText, placeText } from "../lib/jerry.js";
import { Icon } from "../lib/ui.js";
import { FieldPanel, Troubles } from "./field-panel.js";
import { JerryField } from "./jerry-field.js";

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
    if (mayEdit.peek()) command(shown, direction, steps.peek());
  };
  const ask = (/** @type {Place} */ at) => {
    place.value = at;
    if (mayEdit.peek()) measure(shown, known, at);
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
  const isOff = !mayEdit.value || topic === null;
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
  const isOff = !mayEdit.value || distance === null;
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
