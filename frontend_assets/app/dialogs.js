/** The windows over the page: one at a time. */

/** @import { Shown } from "../model/view.js" */

import { effect, html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { later } from "../lib/loading.js";
import { Dialog, DialogParts } from "../lib/ui.js";
import { role } from "../model/connection.js";
import { documentState, problems } from "../model/document.js";
import { dialog } from "../model/view.js";
import { RemarkDialog } from "./copy-bar.js";
import { GraphicsDialog } from "./graphics.js";
import { DialogHelp } from "./help.js";
import { MergeDialog } from "./merge-dialog.js";
import { Notices } from "./notices.js";
import { Palette } from "./palette.js";
import { ShareDialog } from "./share.js";

const AddDisplayDialog = later(async () => (await import("./add-display.js")).AddDisplayDialog);
const ClassDialog = later(async () => (await import("./class-dialog.js")).ClassDialog);
const NameDialog = later(async () => (await import("./class-dialog.js")).NameDialog);
const KeysDialog = later(async () => (await import("./keys-dialog.js")).KeysDialog);
const LaunchDialog = later(async () => (await import("./launch-dialog.js")).LaunchDialog);
const LayoutsDialog = later(async () => (await import("./layouts-dialog.js")).LayoutsDialog);
const NodesDialog = later(async () => (await import("./nodes-dialog.js")).NodesDialog);
const OpenDialog = later(async () => (await import("./open-dialog.js")).OpenDialog);
const PackageDialog = later(async () => (await import("./open-dialog.js")).PackageDialog);
const NewPackageDialog = later(async () => (await import("./package-dialogs.js")).NewPackageDialog);
const AddToPackageDialog = later(
  async () => (await import("./package-dialogs.js")).AddToPackageDialog,
);
const OpenConfigDialog = later(async () => (await import("./rviz-dialogs.js")).OpenConfigDialog);
const OpenedConfigDialog = later(
  async () => (await import("./rviz-dialogs.js")).OpenedConfigDialog,
);
const SaveConfigDialog = later(async () => (await import("./rviz-dialogs.js")).SaveConfigDialog);
const RosDialog = later(async () => (await import("./ros-dialog.js")).RosDialog);
const SaveAsDialog = later(async () => (await import("./save-as.js")).SaveAsDialog);
const SaveDialog = later(async () => (await import("./save-dialog.js")).SaveDialog);

const close = () => {
  dialog.value = null;
};

const PARTS = { help: DialogHelp, notices: Notices };

/** The window that is open, with the way to its help in its head, and the notices over it. */
export function Dialogs() {
  return html`<${DialogParts.Provider} value=${PARTS}><${ShownDialog} /><//>`;
}

function ShownDialog() {
  const shown = dialog.value;
  switch (shown?.kind) {
    case "open":
      return html`<${OpenDialog} tab=${shown.tab} onClose=${close} />`;
    case "save_as":
      return html`<${SaveAsDialog} onClose=${close} />`;
    case "choose_package":
      return html`<${PackageDialog} name=${shown.name} onClose=${close} />`;
    case "launch":
      return html`<${LaunchDialog} path=${shown.path} onClose=${close} />`;
    case "merge":
      return html`<${MergeDialog} file=${shown.file} onClose=${close} />`;
    case "save":
      return html`<${SaveDialog} onClose=${close} />`;
    case "share":
      return html`<${ShareDialog} link=${shown.link} onClose=${close} />`;
    case "class":
      return html`<${ClassDialog} onClose=${close} />`;
    case "remark":
      return html`<${RemarkDialog} document=${shown.document} onClose=${close} />`;
    case "class_name":
      return html`<${NameDialog} onClose=${close} />`;
    case "nodes":
      return html`<${NodesDialog} onClose=${close} />`;
    case "graphics":
      return html`<${GraphicsDialog} onClose=${close} />`;
    case "ros":
      return html`<${RosDialog} onClose=${close} />`;
    case "add_display":
      return html`<${AddDisplayDialog} onClose=${close} />`;
    case "rviz_open":
      return html`<${OpenConfigDialog} onClose=${close} />`;
    case "rviz_save":
      return html`<${SaveConfigDialog} onClose=${close} />`;
    case "rviz_opened":
      return html`<${OpenedConfigDialog} opened=${shown.opened} onClose=${close} />`;
    case "new_package":
      return html`<${NewPackageDialog} onClose=${close} />`;
    case "add_to_package":
      return html`<${AddToPackageDialog} what=${shown.what} folder=${shown.folder} name=${shown.name} onClose=${close} />`;
    case "layouts":
      return html`<${LayoutsDialog} onClose=${close} />`;
    case "keys":
      return html`<${KeysDialog} onClose=${close} />`;
    case "palette":
      return html`<${Palette} onClose=${close} />`;
    case "confirm":
      return html`<${ConfirmDialog} ...${shown} />`;
    default:
      return null;
  }
}

/** @param {Extract<Shown, {kind: "confirm"}>} props */
function ConfirmDialog({ title, text, details = [], action, danger = false, run, other }) {
  const closing = (/** @type {() => void} */ work) => () => {
    close();
    work();
  };
  return html`<${Dialog} title=${title} closeLabel=${t("close")} class="confirm" onClose=${close}>
    <p class="dialog-text">${text}</p>
    ${details.length > 0 && html`<ul class="confirm-details">${details.map((one) => html`<li key=${one}>${one}</li>`)}</ul>`}
    <footer><span class="push"></span>
      <button type="button" class="button" data-first onClick=${close}>${t("cancel")}</button>
      ${other && html`<button type="button" class="button" onClick=${closing(other.run)}>${other.action}</button>`}
      <button type="button" class=${`button ${danger ? "danger" : "primary"}`} onClick=${closing(run)}>${action}</button></footer>
  <//>`;
}

/** Show the form by itself when the robot that was opened cannot be without a value. */
export function followMissing() {
  let asked = "";
  effect(() => {
    const state = documentState.value;
    const lacking = problems.value.find(({ fix }) => fix?.action === "give_arguments");
    const what = lacking && state ? `${state.id} ${lacking.sentence}` : "";
    if (what === "" || what === asked || role.value !== "presenter") return;
    asked = what;
    if (dialog.peek() === null) dialog.value = { kind: "launch", path: "" };
  });
}
