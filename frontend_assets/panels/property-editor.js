/** The widget of a property of a display, a tool or the like, by its kind. */

/** @import { PropertyView } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { niceStep, parseNumber, shownNumber } from "../lib/numbers.js";
import { PickBox } from "../lib/pick-box.js";
import { TextBox } from "../lib/slider.js";
import { Switch } from "../lib/ui.js";
import { FIXED_FRAME } from "../lib/view-poses.js";
import { framesNow, markerServersNow, topicsNow } from "../model/live-displays.js";

/** @typedef {boolean | number | string} Value */

/** @param {{label: string, value: string, disabled: boolean, choices: readonly (readonly [string, string])[], onChoose: (value: string) => void}} props */
export function Choice({ label, value, disabled, choices, onChoose }) {
  return html`<select class="box" aria-label=${label} value=${value} disabled=${disabled}
    onChange=${(/** @type {any} */ event) => onChoose(event.currentTarget.value)}>
    ${choices.map(([one, words]) => html`<option key=${one} value=${one} selected=${one === value}>${words}</option>`)}
  </select>`;
}

/**
 * @param {{label: string, property: PropertyView, value: Value, disabled: boolean, set: (value: Value) => void,
 *   topics?: string, short?: boolean}} props `topics`: of which type topics are offered for a text; `short`: one of several in a row
 */
export function PropertyEditor({ label, property, value, disabled, set, topics, short = false }) {
  switch (property.kind) {
    case "switch":
      return html`<${Switch} label=${label} checked=${value === true} disabled=${disabled} onChange=${set} />`;
    case "colour":
      return html`<input type="color" class="colour" aria-label=${label} title=${String(value)} value=${String(value)} disabled=${disabled}
        onInput=${(/** @type {any} */ event) => set(event.currentTarget.value)} />`;
    case "choice":
      return html`<${Choice} label=${label} value=${String(value)} disabled=${disabled} choices=${property.choices.map((one) => [one, one])} onChoose=${set} />`;
    case "frame":
      return html`<${PickBox} label=${label} text=${String(value) || FIXED_FRAME} disabled=${disabled} onWrite=${set} none=${t("live.frame.none")}
        choices=${async () => [FIXED_FRAME, ...(await framesNow()).map(({ name }) => name)]} />`;
    case "topic":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${disabled} onWrite=${set} placeholder=${t("live.topic.none")}
        choices=${() => topicsOf(property.choices)} none=${t("live.topic.nothing", { type: property.choices[0] ?? "" })} />`;
    case "fact":
      return html`<output class="fact" aria-label=${label} title=${String(value)}>${String(value)}</output>`;
    case "marker_server":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${disabled} onWrite=${set} none=${t("live.marker_servers.none")}
        choices=${markerServersNow} />`;
    case "text":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${disabled} onWrite=${set} placeholder=""
        ...${property.choices.length > 0 && { choices: async () => property.choices }}
        ...${topics && { choices: () => topicsOf([topics]), none: t("live.topic.nothing", { type: topics }) }} />`;
    default:
      return html`<${NumberEditor} label=${label} property=${property} value=${Number(value)} disabled=${disabled} set=${set} short=${short} />`;
  }
}

/** @param {readonly string[]} wanted types @returns {Promise<string[]>} */
async function topicsOf(wanted) {
  const topics = (await topicsNow()) ?? [];
  return topics
    .filter(({ types }) => types.some((type) => wanted.includes(type)))
    .map(({ name }) => name);
}

/** @param {{label: string, property: PropertyView, value: number, disabled: boolean, set: (value: number) => void, short: boolean}} props */
function NumberEditor({ label, property, value, disabled, set, short }) {
  const { low, high, unit, kind } = property;
  if (low === 0 && high === 1 && kind === "number")
    return html`<input type="range" class="slider short" min="0" max="1" step="0.01" value=${value} aria-label=${label}
      title=${shownNumber(value)} disabled=${disabled} style=${`--fill:${value * 100}%`}
      onInput=${(/** @type {any} */ event) => set(Number(event.currentTarget.value))} />`;
  const step = kind === "whole" ? 1 : niceStep(0, Math.max(Math.abs(value), 0.01) * 4);
  /** @param {string} typed */
  const write = (typed) => {
    const number = parseNumber(typed);
    if (number === null) return;
    const within = Math.min(Math.max(number, low ?? number), high ?? number);
    set(kind === "whole" ? Math.round(within) : within);
  };
  return html`<${TextBox} class=${`number ${short ? "third" : "narrow"}`} label=${label} text=${shownNumber(value)} number=${value} step=${step}
    disabled=${disabled} onWrite=${write} />${unit && !short && html`<span class="unit">${unit}</span>`}`;
}
