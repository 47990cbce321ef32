/** How topics are listened to: as fits their publishers, or as somebody chose. */

/** @import { Signal } from "vendor/preact.js" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon, MenuButton } from "../lib/ui.js";

/** @typedef {{reliable: boolean | null, latched: boolean | null}} Listening null: as fits the publishers */

/** @type {readonly (Listening & {word: string})[]} */
const WAYS = [
  { word: "auto", reliable: null, latched: null },
  { word: "reliable", reliable: true, latched: false },
  { word: "best_effort", reliable: false, latched: false },
  { word: "latched", reliable: true, latched: true },
];

/** @param {{label: string, listening: Signal<Listening>, hint?: string, disabled?: boolean}} props `hint`: how it is listened to now */
export function ListeningMenu({ label, listening, hint = label, disabled = false }) {
  const now = listening.value;
  const items = () => [
    { label, heading: true },
    ...WAYS.map(({ word, reliable, latched }) => ({
      label: t(`topics.qos.${word}`),
      checked: now.reliable === reliable && now.latched === latched,
      run: () => {
        listening.value = { reliable, latched };
      },
    })),
  ];
  return html`<${MenuButton} label=${label} hint=${hint} disabled=${disabled} items=${items}><${Icon} name="listening" /><${Icon} name="chevronDown" size=${12} /><//>`;
}
