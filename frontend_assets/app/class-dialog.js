/** The window of a class: how others join, for a projector; its settings; pausing and ending it. */

/** @import { ClassState } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { Dialog, EmptyState, Icon, Switch } from "../lib/ui.js";
import {
  classState,
  endClass,
  hereCount,
  pauseClass,
  renewCode,
  setClass,
  setName,
  startClass,
  you,
} from "../model/class.js";
import { startNodes, stopNodes, studentNodes } from "../model/student-nodes.js";
import { dialog, notify } from "../model/view.js";
import { Relays } from "./class-relays.js";

/** What is typed in a terminal. */
const SHARED = "studio open --share";

/** @param {{onClose: () => void}} props */
export function ClassDialog({ onClose }) {
  const state = classState.value;
  const isOpen = state?.open ?? false;
  return html`<${Dialog} title=${t("class.title")} closeLabel=${t("close")} class=${`class-dialog ${isOpen ? "open" : ""}`} onClose=${onClose}>
    ${state === null ? html`<${EmptyState} icon="users" title=${t("class.unknown")} />` : isOpen ? html`<${Open} state=${state} onClose=${onClose} />` : html`<${Begin} state=${state} onClose=${onClose} />`}
  <//>`;
}

/** Nobody may join yet. @param {{state: ClassState, onClose: () => void}} props */
function Begin({ state, onClose }) {
  const again = state.members.length > 0;
  return html`<p class="dialog-text">${again ? t("class.paused", { count: state.members.length }) : t("class.begin")}</p>
    <ul class="class-points"><li>${t("class.begin.look")}</li><li>${t("class.begin.control")}</li><li>${t("class.begin.kept")}</li></ul>
    ${state.only_here && html`<${OnlyHere} />`}
    <footer>${again && html`<button type="button" class="button danger" onClick=${askToEnd}>${t("class.end")}…</button>`}<span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" data-first onClick=${startClass}><${Icon} name="users" />${t(again ? "class.resume" : "class.start")}</button></footer>`;
}

/** No other machine reaches the studio: how it is started so that they do. */
function OnlyHere() {
  return html`<p class="note">${t("class.only_here")} <code>${SHARED}</code></p>`;
}

/** @param {{state: ClassState, onClose: () => void}} props */
function Open({ state, onClose }) {
  const showPeople = () => {
    onClose();
    commandById("panel.people")?.run();
  };
  return html`<div class="class-open"><${JoinBlock} state=${state} />
    ${state.only_here && html`<${OnlyHere} />`}
    <${JoinSettings} state=${state} />
    <${Relays} /></div>
    <footer><button type="button" class="button danger" onClick=${askToEnd}>${t("class.end")}…</button>
      <button type="button" class="button" onClick=${pauseClass}>${t("class.pause")}</button><span class="push"></span>
      <button type="button" class="button primary" data-first onClick=${showPeople}><${Icon} name="users" />${t("class.people", { count: hereCount.value })}</button></footer>`;
}

/** What is shown by the projector. @param {{state: ClassState}} props */
function JoinBlock({ state }) {
  const copy = async () => {
    if (await copyText(state.link)) notify(t("class.link.copied"));
  };
  const picture = `data:image/svg+xml,${encodeURIComponent(state.qr)}`;
  const [first = "", ...others] = state.addresses;
  return html`<div class="class-join">
    <img class="class-qr" src=${picture} alt=${t("class.qr", { address: first })} />
    <div class="class-ways">
      <p class="class-step">${t("class.join.address")}</p>
      <p class="class-address">${shown(first)}</p>
      <p class="class-step">${t("class.join.code")}</p>
      <p class="class-code" aria-label=${[...state.code].join(" ")}>${state.code}</p>
      ${others.length > 0 && html`<p class="muted">${t("class.or")} ${others.map(shown).join(", ")}</p>`}
      <div class="class-buttons"><button type="button" class="button small" onClick=${copy}><${Icon} name="copy" size=${14} />${t("class.link.copy")}</button>
        <button type="button" class="button small" onClick=${renewCode}><${Icon} name="reload" size=${14} />${t("class.code.renew")}</button></div>
    </div></div>
    ${state.fingerprint && html`<p class="class-fingerprint">${t("class.fingerprint")} <code>${state.fingerprint}</code></p>`}`;
}

/** @param {string} address @returns {string} as people type it */
const shown = (address) => address.replace(/^http:\/\//, "").replace(/\/$/, "");

/** @param {{state: ClassState}} props */
function JoinSettings({ state }) {
  /** @param {string} role */
  const joinAs = (role) => setClass({ join_as: role === "guest" ? "guest" : "student" });
  return html`<div class="class-settings">
    <div class="class-setting"><span>${t("class.locked")}<small>${t("class.locked.hint")}</small></span>
      <${Switch} label=${t("class.locked")} checked=${state.locked} onChange=${(/** @type {boolean} */ locked) => setClass({ locked })} /></div>
    <label class="class-setting"><span>${t("class.join_as")}<small>${t("class.join_as.hint")}</small></span>
      <select class="box" value=${state.join_as} onChange=${(/** @type {any} */ event) => joinAs(event.currentTarget.value)}>
        ${["student", "guest"].map((one) => html`<option key=${one} value=${one} selected=${one === state.join_as}>${t(`class.role.${one}`)}</option>`)}
      </select></label>
    <${Password} isSet=${state.has_password} />
    <${StudentNodes} />
  </div>`;
}

/** Whether nodes of students may join, where, and how many have asked. */
function StudentNodes() {
  const nodes = studentNodes.value;
  if (!nodes) return null;
  const { state, endpoint, given, limit, trouble } = nodes;
  const isOn = state === "on" || state === "starting";
  return html`<div class="class-setting"><span class="class-nodes">${t("class.nodes")}<small>${t("class.nodes.hint")}</small>
      ${state === "on" && html`<small role="status">${t("class.nodes.on", { endpoint, given, limit })}</small>`}
      ${state === "on" && nodes.only_here && html`<small>${t("class.nodes.only_here")} <code>${SHARED}</code></small>`}
      ${trouble && html`<small class="bad" role="alert">${trouble}</small>`}</span>
    <${Switch} label=${t("class.nodes")} checked=${isOn} disabled=${state === "starting"} onChange=${(/** @type {boolean} */ on) => (on ? startNodes() : askToStopNodes(given))} /></div>`;
}

/** @param {number} given */
function askToStopNodes(given) {
  if (given === 0) {
    stopNodes();
    return;
  }
  dialog.value = {
    kind: "confirm",
    title: t("class.nodes.stop"),
    text: t("class.nodes.stop.text"),
    action: t("class.nodes.stop"),
    danger: true,
    run: () => void stopNodes(),
  };
}

/** @param {{isSet: boolean}} props */
function Password({ isSet }) {
  const typed = useSignal("");
  const set = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (typed.value === "") return;
    await setClass({ password: typed.value });
    typed.value = "";
    notify(t("class.password.set"));
  };
  return html`<form class="class-setting" onSubmit=${set}><span>${t("class.password")}<small>${t(isSet ? "class.password.is_set" : "class.password.hint")}</small></span>
    <span class="class-password"><input type="password" class="box" aria-label=${t("class.password")} maxlength="200" autocomplete="new-password" value=${typed.value}
      onInput=${(/** @type {any} */ event) => {
        typed.value = event.currentTarget.value;
      }} />
    <button type="submit" class="button small" disabled=${typed.value === ""}>${t("class.password.take")}</button>
    ${isSet && html`<button type="button" class="button small" onClick=${() => setClass({ password: "" })}>${t("class.password.remove")}</button>`}</span></form>`;
}

function askToEnd() {
  dialog.value = {
    kind: "confirm",
    title: t("class.end"),
    text: t("class.end.text"),
    details: [t("class.end.names"), t("class.end.cookies")],
    action: t("class.end"),
    danger: true,
    run: () => void endClass(),
  };
}

/** One's own name. @param {{onClose: () => void}} props */
export function NameDialog({ onClose }) {
  const name = useSignal(you.value.name);
  const take = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (await setName(name.value)) onClose();
  };
  return html`<${Dialog} title=${t("command.class_name")} closeLabel=${t("close")} onClose=${onClose}>
    <form onSubmit=${take}><label class="field"><span>${t("class.name")}</span>
      <input class="box wide" data-first required maxlength="40" value=${name.value} onInput=${(
        /** @type {any} */ event,
      ) => {
        name.value = event.currentTarget.value;
      }} /></label>
    <footer><span class="push"></span><button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="submit" class="button primary" disabled=${name.value.trim() === ""}>${t("class.name.take")}</button></footer></form>
  <//>`;
}
