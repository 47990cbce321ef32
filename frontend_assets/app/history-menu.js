/** The undo list: every step by its name, the newest first, with a mark at where one is. */

/** @import { MenuItem } from "../lib/ui.js" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { Icon, MenuButton } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { history } from "../model/document.js";
import { ask } from "../model/requests.js";

const SHOWN = 200;

/** @param {number} position how many steps are done then @param {number} of how many there are in all */
async function goTo(position, of) {
  await allSettled();
  await ask({ type: "undo_to", position, of });
}

/** @returns {MenuItem[]} a click goes to how it was after that step */
function stepItems() {
  const { undo: done, redo: undone } = history.value;
  const of = done.length + undone.length;
  const steps = [t("undo.start"), ...done, ...[...undone].reverse()];
  const items = steps.map((label, position) => ({
    label,
    checked: position === done.length,
    run: () => void goTo(position, of),
  }));
  return [
    { label: t("undo.list"), heading: true },
    ...items.slice(Math.max(0, Math.min(done.length - SHOWN / 2, items.length - SHOWN))).reverse(),
  ];
}

export function HistoryMenu() {
  const { undo: done, redo: undone } = history.value;
  const none = done.length + undone.length === 0;
  return html`<${MenuButton} class="icon-button narrow" label=${t("undo.list")} disabled=${!mayEdit.value || none} items=${stepItems}>
    <${Icon} name="chevronDown" size=${12} /><//>`;
}
