/** The stick and the buttons of the Teleop panel; keys drive while the focus is among them. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import {
  CENTRE,
  driveLimits,
  halt,
  held,
  hold,
  ofStick,
  release,
  together,
  useDrivingKeys,
} from "../model/driving.js";

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

export function Hands() {
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
    if (event.button !== 0 || !mayEdit.peek()) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    pull(event);
  };
  const onPointerMove = (/** @type {any} */ event) => {
    if (held.peek().has("stick")) pull(event);
  };
  return html`<div class="teleop-stick" role="application" aria-label=${t("teleop.stick")} title=${t("teleop.stick")} tabindex=${mayEdit.value ? 0 : -1} aria-disabled=${!mayEdit.value}
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
  return html`<button type="button" class=${`button teleop-${id}`} aria-label=${t(wordOf(id))} title=${t(wordOf(id))} disabled=${!mayEdit.value}
    aria-pressed=${stops ? null : held.value.has(hand)} onPointerDown=${onPointerDown} onPointerUp=${end} onPointerCancel=${end} onLostPointerCapture=${end}
    onKeyDown=${onKeyDown} onKeyUp=${end} onBlur=${end} onContextMenu=${(/** @type {Event} */ event) => event.preventDefault()}><${Icon} name=${icon} size=${20} /></button>`;
}

/** @param {string} id what an arrow to the side does depends on the robot */
function wordOf(id) {
  const turns = !driveLimits.value.sideways && (id === "left" || id === "right");
  return `teleop.pad.${turns ? `turn_${id}` : id}`;
}
