/** Driving by hand: a stick, buttons or keys become speeds on a topic for as long as they are held. */

import { html, useEffect } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { allDigits, shownNumber } from "../../lib/numbers.js";
import { Slider } from "../../lib/slider.js";
import { Icon, Switch } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayAct } from "../../model/connection.js";
import {
  CENTRE,
  chosenDrive,
  driveLimits,
  driveTarget,
  driveTopics,
  drivingRefused,
  followDrivable,
  halt,
  held,
  hold,
  ofStick,
  release,
  speedOf,
  together,
  useDrivingKeys,
} from "../../model/driving.js";
import { ConnectFirst, isWireAway, PastNote, RouterAway } from "../parts.js";

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
    <${PastNote} />
    ${isWireAway() ? html`<${ConnectFirst} icon="compass" />` : html`<${Content} />`}
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
    ${!mayAct.value && html`<p class="note">${t("teleop.viewer")}</p>`}
    <${Hands} />
    <${Speed} />
    ${drivingRefused.value && html`<p class="note bad" role="alert">${drivingRefused.value}</p>`}
    <div class="teleop-limits">${BOUNDS.map((bound) => html`<${Limit} key=${bound.name} ...${bound} />`)}</div>
    <div class="teleop-line"><span>${t("teleop.sideways")}</span><${Switch} label=${t("teleop.sideways")} checked=${driveLimits.value.sideways} disabled=${!mayAct.value}
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
    <label>${t("teleop.topic")}<input class="box wide" list="teleop-topics" value=${name} disabled=${!mayAct.value} spellcheck=${false} autocomplete="off"
      onChange=${(/** @type {any} */ event) => choose(event.currentTarget.value.trim())} /></label>
    <datalist id="teleop-topics">${driveTopics.value.map((one) => html`<option key=${one.name} value=${one.name}></option>`)}</datalist>
    <label class="teleop-stamped"><input type="checkbox" checked=${stamped} disabled=${!mayAct.value}
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
  return html`<span>${label}</span><output>${text}</output><${Slider} label=${label} min=${min} max=${max} step=${step} value=${value} text=${text} disabled=${!mayAct.value}
    onMove=${(/** @type {number} */ moved) => {
      driveLimits.value = { ...driveLimits.peek(), [name]: moved };
    }} onEnd=${async () => {}} />`;
}

/** @typedef {{id: string, icon: string, x?: number, y?: number, turn?: number, aside?: boolean}} Arrow */

/** By rows; `aside`: only for what can move to its left. @type {Arrow[]} */
const ARROWS = [
  { id: "turn_left", icon: "undo", turn: 1, aside: true },
  { id: "forward", icon: "arrow", x: 1 },
  { id: "turn_right", icon: "redo", turn: -1, aside: true },
  { id: "left", icon: "arrow", y: 1 },
  { id: "stop", icon: "stop" },
  { id: "right", icon: "arrow", y: -1 },
  { id: "back", icon: "arrow", x: -1 },
];

/** The stick and the buttons of the Teleop panel; keys drive while the focus is among them. */
function Hands() {
  return html`<div class="teleop-hands" ...${useDrivingKeys()}>
    <${Stick} /><${Pad} /></div>`;
}

/** A knob that is pulled from the middle of its field. */
function Stick() {
  const { x, y, turn } = together(held.value.values());
  const aside = driveLimits.value.sideways ? y : Math.max(-1, Math.min(1, y + turn));
  const pull = (/** @type {any} */ event) => {
    const { left, top, width, height } = event.currentTarget.getBoundingClientRect();
    const right = event.clientX - left - width / 2;
    hold("stick", ofStick(right, event.clientY - top - height / 2, width / 2));
  };
  const onPointerDown = (/** @type {any} */ event) => {
    if (event.button !== 0 || !mayAct.peek()) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    pull(event);
  };
  const onPointerMove = (/** @type {any} */ event) => {
    if (held.peek().has("stick")) pull(event);
  };
  return html`<div class="teleop-stick" role="application" aria-label=${t("teleop.stick")} title=${t("teleop.stick")} tabindex=${mayAct.value ? 0 : -1} aria-disabled=${!mayAct.value}
    style=${`--aside:${(-aside).toFixed(3)};--ahead:${(-x).toFixed(3)}`} onPointerDown=${onPointerDown} onPointerMove=${onPointerMove}
    onPointerUp=${() => release("stick")} onPointerCancel=${() => release("stick")} onLostPointerCapture=${() => release("stick")}><span class="teleop-knob"></span></div>`;
}

function Pad() {
  const { sideways } = driveLimits.value;
  return html`<div class="teleop-pad" role="group" aria-label=${t("teleop.pad")}>
    ${ARROWS.filter(({ aside }) => !aside || sideways).map((arrow) => html`<${Arrow} key=${arrow.id} ...${arrow} />`)}</div>`;
}

/** @param {Arrow} props a button that drives while it is held, by a pointer or by Enter */
function Arrow({ id, icon, x = 0, y = 0, turn = 0 }) {
  const stops = id === "stop";
  const hand = `pad.${id}`;
  const press = () => (stops ? halt() : hold(hand, { ...CENTRE, x, y, turn }));
  const end = () => release(hand);
  const onPointerDown = (/** @type {any} */ event) => {
    if (event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    press();
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Enter" && !event.repeat) press();
  };
  return html`<button type="button" class=${`button teleop-${id}`} aria-label=${t(wordOf(id))} title=${t(wordOf(id))} disabled=${!mayAct.value}
    aria-pressed=${stops ? null : held.value.has(hand)} onPointerDown=${onPointerDown} onPointerUp=${end} onPointerCancel=${end} onLostPointerCapture=${end}
    onKeyDown=${onKeyDown} onKeyUp=${end} onBlur=${end} onContextMenu=${(/** @type {Event} */ event) => event.preventDefault()}><${Icon} name=${icon} size=${20} /></button>`;
}

/** @param {string} id what an arrow to the side does depends on the robot */
function wordOf(id) {
  const turns = !driveLimits.value.sideways && (id === "left" || id === "right");
  return `teleop.pad.${turns ? `turn_${id}` : id}`;
}
