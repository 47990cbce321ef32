/** What was done or went wrong, in a corner; in a window that is open, which would cover it. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import { dismiss, notices } from "../model/view.js";

export function Notices() {
  return html`<div class="notices" aria-live="polite">${notices.value.map(
    (
      notice,
    ) => html`<div key=${notice.id} class=${`notice ${notice.bad ? "bad" : ""}`} role=${notice.bad ? "alert" : "status"}>
    <${Icon} name=${notice.bad ? "error" : "check"} /><span>${notice.text}</span>
    ${notice.action && html`<button type="button" class="text-button" onClick=${() => act(notice)}>${notice.action.label}</button>`}
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${() => dismiss(notice.id)} /></div>`,
  )}</div>`;
}

/** @param {import("../model/view.js").Notice} notice */
function act({ id, action }) {
  dismiss(id);
  action?.run();
}
