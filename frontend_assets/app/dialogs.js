/** The windows over the page: one at a time. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shortcutText } from "../lib/keys.js";
import { Dialog } from "../lib/ui.js";
import { commandLabel, commands, onMac } from "./commands.js";
import { LaunchDialog } from "./launch-dialog.js";
import { MergeDialog } from "./merge-dialog.js";
import { OpenDialog, PackageDialog } from "./open-dialog.js";
import { Palette } from "./palette.js";
import { ShareDialog } from "./share.js";
import { dialog } from "./state/view.js";

/** @import { Shown } from "./state/view.js" */

const close = () => {
  dialog.value = null;
};

export function Dialogs() {
  const shown = dialog.value;
  switch (shown?.kind) {
    case "open":
      return html`<${OpenDialog} onClose=${close} />`;
    case "choose_package":
      return html`<${PackageDialog} name=${shown.name} onClose=${close} />`;
    case "launch":
      return html`<${LaunchDialog} path=${shown.path} onClose=${close} />`;
    case "merge":
      return html`<${MergeDialog} file=${shown.file} onClose=${close} />`;
    case "share":
      return html`<${ShareDialog} link=${shown.link} onClose=${close} />`;
    case "keys":
      return html`<${KeysDialog} />`;
    case "palette":
      return html`<${Palette} onClose=${close} />`;
    case "confirm":
      return html`<${ConfirmDialog} ...${shown} />`;
    default:
      return null;
  }
}

/** @param {Extract<Shown, {kind: "confirm"}>} props */
function ConfirmDialog({ title, text, action, run }) {
  const confirm = () => {
    close();
    run();
  };
  return html`<${Dialog} title=${title} closeLabel=${t("close")} class="confirm" onClose=${close}>
    <p class="dialog-text">${text}</p>
    <footer><span class="push"></span>
      <button type="button" class="button" data-first onClick=${close}>${t("cancel")}</button>
      <button type="button" class="button danger" onClick=${confirm}>${action}</button></footer>
  <//>`;
}

const STEPS = /** @type {const} */ ([
  ["keys.step", ["↑", "↓"]],
  ["keys.coarse", ["Shift", "↑"]],
  ["keys.fine", ["Alt", "↑"]],
  ["keys.write", ["Enter"]],
  ["keys.tree", ["←", "→"]],
  ["keys.eye", ["Space"]],
]);

function KeysDialog() {
  const named = commands.value.filter(({ keys }) => keys && keys.length > 0);
  return html`<${Dialog} title=${t("command.keys")} closeLabel=${t("close")} class="keys" onClose=${close}>
    <dl class="keys-list">
      ${named.map(
        (command) => html`<dt>${commandLabel(command)}</dt>
        <dd><kbd>${shortcutText(command.keys?.[0] ?? "", onMac)}</kbd></dd>`,
      )}
      ${STEPS.map(([key, strokes]) => html`<dt>${t(key)}</dt><dd>${strokes.map((one) => html`<kbd>${one}</kbd>`)}</dd>`)}
    </dl>
  <//>`;
}
