/** The bar above a copy: whose it is, and what its owner and those who lead can do with it. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon } from "../lib/ui.js";
import { leads } from "../model/class.js";
import { documentId, role } from "../model/connection.js";
import {
  discardCopy,
  handIn,
  isCopy,
  isHandedIn,
  isOwnCopy,
  sendBack,
  showCopy,
  shownCopy,
} from "../model/copies.js";
import { goTo } from "../model/requests.js";
import { canCompare } from "../model/variants.js";
import { dialog } from "../model/view.js";
import { NodesButton } from "./control.js";
import { compareWith } from "./menu-commands.js";

export function CopyBar() {
  if (!isCopy.value) return null;
  return html`<div class=${`bar copy-bar ${isOwnCopy.value ? "own" : ""}`} role="status"><${Icon} name="fork" />
    <span class="control-words">${stateWords()}</span>
    ${isOwnCopy.value ? html`<${OwnButtons} />` : leads.value && html`<${LeaderButtons} />`}
    <span class="push"></span>
    <button type="button" class="button small" onClick=${back}>${t("copy.back")}</button></div>
    ${isOwnCopy.value && shownCopy.value?.remark && html`<p class="bar copy-remark" role="status"><${Icon} name="info" /><span>${t("copy.remark", { remark: shownCopy.value.remark })}</span></p>`}`;
}

const back = () => goTo(documentId.value.split("~")[0] ?? "");

/** @returns {string} */
function stateWords() {
  const copy = shownCopy.value;
  // Only those who lead are told whose the copies are.
  if (!isOwnCopy.value && !copy) return t("copy.shown");
  const whose = isOwnCopy.value ? t("copy.yours") : t("copy.of", { name: copy?.name ?? "" });
  if (!copy?.handed_s) return whose;
  const time = new Date(copy.handed_s * 1000).toLocaleTimeString([], { timeStyle: "short" });
  return `${whose} · ${t(isHandedIn(copy) ? "copy.handed_at" : "copy.sent_back", { time, count: copy.changes })}`;
}

function OwnButtons() {
  return html`<button type="button" class="button small primary" onClick=${handIn}><${Icon} name="send" size=${14} />${t("copy.hand_in")}</button>
    <button type="button" class="button small" onClick=${askToDiscard}>${t("copy.discard")}…</button>
    <${NodesButton} />`;
}

function askToDiscard() {
  const document = documentId.value;
  dialog.value = {
    kind: "confirm",
    title: t("copy.discard.title"),
    text: t("copy.discard.text"),
    action: t("copy.discard"),
    danger: true,
    run: () => void discardCopy(document),
  };
}

function LeaderButtons() {
  const copy = shownCopy.value;
  const document = documentId.value;
  const shown = copy?.shown ?? false;
  const remark = () => {
    dialog.value = { kind: "remark", document };
  };
  return html`${role.value === "presenter" && html`<button type="button" class="button small" disabled=${!canCompare.value} onClick=${() => compareWith({ kind: "saved", name: "" })}><${Icon} name="compare" size=${14} />${t("copy.compare")}</button>`}
    ${role.value === "presenter" && html`<button type="button" class="button small" aria-pressed=${shown} onClick=${() => showCopy(document, !shown)}><${Icon} name="users" size=${14} />${t(shown ? "copy.hide" : "copy.show")}</button>`}
    <button type="button" class="button small" onClick=${remark}>${t("copy.send_back")}…</button>`;
}

/** What is said to the owner. @param {{document: string, onClose: () => void}} props */
export function RemarkDialog({ document, onClose }) {
  const text = useSignal("");
  const send = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (await sendBack(document, text.value)) onClose();
  };
  return html`<${Dialog} title=${t("copy.send_back")} closeLabel=${t("close")} onClose=${onClose}>
    <form onSubmit=${send}><label class="field"><span>${t("copy.remark.label")}</span>
      <textarea class="box wide" data-first rows="5" maxlength="2000" value=${text.value} onInput=${(
        /** @type {any} */ event,
      ) => {
        text.value = event.currentTarget.value;
      }}></textarea></label>
    <footer><span class="push"></span><button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="submit" class="button primary">${t("copy.send_back")}</button></footer></form>
  <//>`;
}
