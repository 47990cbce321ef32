/** Says that unsaved edits of an earlier run were brought back, and gives them up when that was not wanted. */

import { html } from "vendor/preact.js";
import { language, t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { restored } from "../model/document.js";
import { ask } from "../model/requests.js";

const discard = () => ask({ type: "discard_restored" });

export function RestoredBar() {
  const told = restored.value;
  if (!told) return null;
  const hide = () => {
    restored.value = null;
  };
  return html`<div class="bar restored" role="status"><${Icon} name="reset" />
    <span>${t("restored", { time: timeText(told.at) })}</span><span class="push"></span>
    ${mayEdit.value && html`<button type="button" class="button small" onClick=${discard}>${t("restored.discard")}</button>`}
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${hide} /></div>`;
}

/** @param {string} at ISO 8601 @returns {string} the time of today, or date and time */
export function timeText(at) {
  const then = new Date(at);
  const today = then.toDateString() === new Date().toDateString();
  return then.toLocaleString(language.value, {
    timeStyle: "short",
    ...(today ? {} : { dateStyle: "medium" }),
  });
}
