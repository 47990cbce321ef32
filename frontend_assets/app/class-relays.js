/** The relays of a class: each as it stands, one more by its line, and what they are for. */

/** @import { RelayView } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import { addRelay, relays, removeRelay } from "../model/relays.js";
import { dialog, notify } from "../model/view.js";

/** What is typed in a terminal of the other machine. */
const COMMAND = "studio relay";
const BEHIND_MS = 1000;
/** Icon and tone of each state. @type {Record<RelayView["state"], [string, string]>} */
const MARKS = {
  connecting: ["reload", ""],
  there: ["check", "good"],
  lost: ["alert", "amber"],
  refused: ["error", "bad"],
};

/** Part of the window of a class; nothing where the studio told of none. */
export function Relays() {
  const all = relays.value;
  if (!all) return null;
  return html`<section class="class-relays" aria-labelledby="class-relays">
    <h3 id="class-relays">${t("relays")}</h3>
    ${
      all.length > 0
        ? html`<ul>${all.map((one) => html`<${Relay} key=${one.endpoint} relay=${one} />`)}</ul>`
        : html`<p>${t("relays.what")} <span class="class-relay-line"><code>${COMMAND}</code>
      <${IconButton} icon="copy" size=${14} label=${t("copy.command")} onClick=${copying(COMMAND)} /></span></p>`
    }
    <${AddRelay} />
  </section>`;
}

/** @param {string} text */
const copying = (text) => async () => {
  const done = await copyText(text);
  notify(t(done ? "copied" : "copy.failed"), { bad: !done });
};

/** @param {{relay: RelayView}} props */
function Relay({ relay }) {
  const { endpoint, state, reason, address, people = 0, lag_ms: lag = 0 } = relay;
  const [icon, tone] = MARKS[state];
  const isThere = state === "there";
  return html`<li><div><div class="class-relay"><code>${endpoint}</code>
      <span class=${`class-relay-state ${tone}`} role="status"><${Icon} name=${icon} size=${14} />${t(`relays.${state}`)}</span>
      ${isThere && html`<span class="muted">${t("relays.people", { count: people })}</span>`}
      ${isThere && lag > BEHIND_MS && html`<span class="class-relay-state amber"><${Icon} name="history" size=${14} />${t("relays.behind", { seconds: Math.round(lag / 1000) })}</span>`}</div>
    ${reason && html`<small class=${tone}>${reason}</small>`}
    ${
      address &&
      html`<span class="class-relay-line"><a href=${address} target="_blank" rel="noopener noreferrer">${address}</a>
      <${IconButton} icon="copy" size=${14} label=${t("relays.copy", { endpoint })} onClick=${copying(address)} /></span>`
    }</div>
    <${IconButton} icon="close" size=${14} label=${t("relays.remove.of", { endpoint })} onClick=${() => askToRemove(endpoint)} /></li>`;
}

/** @param {string} endpoint */
function askToRemove(endpoint) {
  dialog.value = {
    kind: "confirm",
    title: t("relays.remove"),
    text: t("relays.remove.text"),
    details: [endpoint],
    action: t("relays.remove"),
    danger: true,
    run: () => void removeRelay(endpoint),
  };
}

/** The line holds a key: it is not shown, and not kept once it is sent. */
function AddRelay() {
  const typed = useSignal("");
  const add = (/** @type {Event} */ event) => {
    event.preventDefault();
    const line = typed.value.trim();
    typed.value = "";
    if (line) addRelay(line);
  };
  return html`<form class="class-relay-add" onSubmit=${add}><label for="class-relay-add">${t("relays.line")}</label>
    <input id="class-relay-add" type="password" class="box" maxlength="300" autocomplete="off" spellcheck=${false} value=${typed.value}
      onInput=${(/** @type {any} */ event) => {
        typed.value = event.currentTarget.value;
      }} />
    <button type="submit" class="button small" disabled=${typed.value.trim() === ""}><${Icon} name="plus" size=${14} />${t("relays.add")}</button></form>`;
}
