/** Driving by hand: a stick, buttons or keys become speeds on a topic for as long as they are held. */

import { html, useEffect } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, RouterAway } from "../app/connect-first.js";
import { t } from "../lib/i18n.js";
import { allDigits, shownNumber } from "../lib/numbers.js";
import { Slider } from "../lib/slider.js";
import { Switch } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";
import { mayEdit } from "../model/connection.js";
import {
  chosenDrive,
  driveLimits,
  driveTarget,
  driveTopics,
  drivingRefused,
  followDrivable,
  halt,
  held,
  speedOf,
  together,
} from "../model/driving.js";
import { Hands } from "./teleop-hands.js";

const STAMPED = "TwistStamped";
const BOUNDS = /** @type {const} */ ([
  { name: "linear", unit: "m/s", min: 0.05, max: 3, step: 0.05 },
  { name: "angular", unit: "rad/s", min: 0.1, max: 6, step: 0.1 },
  { name: "rate", unit: "Hz", min: 5, max: 50, step: 1 },
]);

export function TeleopPanel() {
  const { panel, looking } = useLooking(followDrivable);
  useEffect(() => {
    if (!looking) halt();
  }, [looking]);
  useEffect(stopsWithPage, []);
  return html`<section ref=${panel} class="panel-body teleop" aria-label=${t("panel.teleop")}>
    <${RouterAway} />
    ${isUnconnected() ? html`<${ConnectFirst} icon="compass" />` : html`<${Content} />`}
  </section>`;
}

/** @returns {() => void} the robot stands as soon as nobody looks at the page; and with the panel's end */
function stopsWithPage() {
  const ends = new AbortController();
  const { signal } = ends;
  for (const event of ["blur", "pagehide"]) addEventListener(event, halt, { signal });
  document.addEventListener("visibilitychange", () => document.hidden && halt(), { signal });
  return () => {
    ends.abort();
    halt();
  };
}

function Content() {
  return html`<div class="scroll teleop-parts">
    <${Target} />
    ${!mayEdit.value && html`<p class="note">${t("teleop.viewer")}</p>`}
    <${Hands} />
    <${Speed} />
    ${drivingRefused.value && html`<p class="note bad" role="alert">${drivingRefused.value}</p>`}
    <div class="teleop-limits">${BOUNDS.map((bound) => html`<${Limit} key=${bound.name} ...${bound} />`)}</div>
    <div class="teleop-line"><span>${t("teleop.sideways")}</span><${Switch} label=${t("teleop.sideways")} checked=${driveLimits.value.sideways} disabled=${!mayEdit.value}
      onChange=${(/** @type {boolean} */ sideways) => {
        driveLimits.value = { ...driveLimits.value, sideways };
      }} /></div>
    <p class="note">${t("teleop.keys")}</p>
  </div>`;
}

/** The topic, and whether its messages hold the time. */
function Target() {
  const { name, stamped } = driveTarget.value;
  const choose = (/** @type {string} */ typed) => {
    halt();
    const known = driveTopics.peek().find((one) => one.name === typed);
    chosenDrive.value = typed === "" ? null : { name: typed, stamped: known?.stamped ?? stamped };
  };
  const stamp = (/** @type {boolean} */ now) => {
    halt();
    chosenDrive.value = { name, stamped: now };
  };
  return html`<div class="teleop-target">
    <label>${t("teleop.topic")}<input class="box wide" list="teleop-topics" value=${name} disabled=${!mayEdit.value} spellcheck=${false} autocomplete="off"
      onChange=${(/** @type {any} */ event) => choose(event.currentTarget.value.trim())} /></label>
    <datalist id="teleop-topics">${driveTopics.value.map((one) => html`<option key=${one.name} value=${one.name}></option>`)}</datalist>
    <label class="teleop-stamped"><input type="checkbox" checked=${stamped} disabled=${!mayEdit.value}
      onChange=${(/** @type {any} */ event) => stamp(event.currentTarget.checked)} />${STAMPED}</label></div>`;
}

/** What goes out now. */
function Speed() {
  const { x, y, yaw } = speedOf(together(held.value.values()), driveLimits.value);
  return html`<dl class="teleop-speed">
    ${speedPart("teleop.forward", x, "m/s")}
    ${driveLimits.value.sideways && speedPart("teleop.left", y, "m/s")}
    ${speedPart("teleop.turn", yaw, "rad/s")}</dl>`;
}

/** @param {string} word @param {number} speed @param {string} unit */
const speedPart = (word, speed, unit) =>
  html`<div><dt>${t(word)}</dt><dd title=${allDigits(speed)}>${shownNumber(speed)} <span class="muted">${unit}</span></dd></div>`;

/** @param {typeof BOUNDS[number]} bound a slider */
function Limit({ name, unit, min, max, step }) {
  const value = driveLimits.value[name];
  const label = t(`teleop.${name}`);
  const text = `${shownNumber(value)} ${unit}`;
  return html`<span>${label}</span><output>${text}</output><${Slider} label=${label} min=${min} max=${max} step=${step} value=${value} text=${text} disabled=${!mayEdit.value}
    onMove=${(/** @type {number} */ moved) => {
      driveLimits.value = { ...driveLimits.peek(), [name]: moved };
    }} onEnd=${async () => {}} />`;
}
