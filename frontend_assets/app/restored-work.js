/**
 * Says that unsaved edits of an earlier run were brought back, and offers the unsaved work on
 * files that are not open.
 */

/** @import { LeftWorkEntry } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { language, t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import { leftWork, restored } from "../model/document.js";
import { ask, openPath } from "../model/requests.js";
import { dialog } from "../model/view.js";

/** @param {LeftWorkEntry} one */
function giveUp({ path, title }) {
  dialog.value = {
    kind: "confirm",
    title: t("left.discard"),
    text: t("left.discard.text", { title }),
    details: [path],
    action: t("restored.discard"),
    danger: true,
    run: () => void ask({ type: "forget_work", path }),
  };
}

/** One file at a time, the newest first. */
export function LeftWorkBar() {
  const one = leftWork.value[0];
  if (!one || !mayManage.value) return null;
  const hide = () => {
    leftWork.value = leftWork.value.slice(1);
  };
  return html`<div class="bar restored" role="status"><${Icon} name="reset" />
    <span title=${one.path}>${t("left", { title: one.title, time: timeText(one.at) })}</span><span class="push"></span>
    <button type="button" class="button small" onClick=${() => openPath(one.path, {})}>${t("left.open")}</button>
    <button type="button" class="button small" onClick=${() => giveUp(one)}>${t("restored.discard")}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${hide} /></div>`;
}

const discard = () => ask({ type: "discard_restored" });

export function RestoredBar() {
  const work = restored.value;
  if (!work) return null;
  const hide = () => {
    restored.value = null;
  };
  return html`<div class="bar restored" role="status"><${Icon} name="reset" />
    <span>${t("restored", { time: timeText(work.at) })}</span><span class="push"></span>
    ${mayManage.value && html`<button type="button" class="button small" onClick=${discard}>${t("restored.discard")}</button>`}
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${hide} /></div>`;
}

/** @param {string} at ISO 8601 @returns {string} the time of today, or date and time */
function timeText(at) {
  const then = new Date(at);
  const today = then.toDateString() === new Date().toDateString();
  return then.toLocaleString(language.value, {
    timeStyle: "short",
    ...(today ? {} : { dateStyle: "medium" }),
  });
}
