/** Config files of the 3D view by name: open, save, download, and what was shown before. */

/** @import { Command } from "../lib/commands.js" */

import { t } from "../lib/i18n.js";
import { documentId, mayEdit, mayManage } from "../model/connection.js";
import { isCopy } from "../model/copies.js";
import { closeDocument } from "../model/requests.js";
import {
  configChanged,
  downloadConfig,
  openConfigOf,
  RVIZ,
  rvizConfig,
  STUDIO,
  saveConfig,
  undoConfig,
} from "../model/rviz-configs.js";
import { dialog, isFree, notify } from "../model/view.js";

const onDocument = () => documentId.value !== "" && isFree();
const mayOpen = () => onDocument() && mayEdit.value && !isCopy.value;
const maySave = () => onDocument() && mayManage.value;

/** @returns {Command[]} */
export function rvizCommands() {
  return [
    { id: "rviz_open", icon: "open", enabled: mayOpen, run: showOpen },
    { id: "rviz_save", icon: "disk", enabled: maySave, run: () => void save() },
    { id: "rviz_save_as", icon: "disk", enabled: maySave, run: askWhere },
    {
      id: "rviz_download",
      icon: "download",
      enabled: onDocument,
      run: () => void downloadConfig(RVIZ),
    },
    {
      id: "studio_download",
      icon: "download",
      enabled: onDocument,
      run: () => void downloadConfig(STUDIO),
    },
    {
      id: "rviz_undo",
      icon: "undo",
      enabled: () => mayOpen() && rvizConfig.value.undo,
      run: () => void undoConfig(),
    },
  ];
}

/** What would be lost is asked about first. */
function showOpen() {
  ifSaved(() => {
    dialog.value = { kind: "rviz_open" };
  });
}

/** @param {File} file that was dropped on the page */
export function takeConfig(file) {
  ifSaved(() => void openConfigOf(file));
}

/** @param {() => void} run at once where nothing is unsaved; else once the person says so */
function ifSaved(run) {
  const { name } = rvizConfig.value;
  if (!configChanged.value) return run();
  dialog.value = {
    kind: "confirm",
    title: t("rviz.unsaved.title"),
    text: t("rviz.unsaved.text", { name }),
    action: t("rviz.unsaved.go_on"),
    run,
  };
}

/** The view is kept with the document; only its file would lack what was changed. */
export const closeAsking = () => ifSaved(() => void closeDocument());

function askWhere() {
  dialog.value = { kind: "rviz_save" };
}

/** Without a file of this machine it is asked for; what others wrote into it is lost only by a yes. */
async function save(replace = false) {
  if (rvizConfig.value.path === "") return askWhere();
  const saved = await saveConfig("", { replace });
  if (!saved?.isThere) return saved && notify(t("rviz.saved", { file: saved.path }));
  const { changed, path } = saved;
  dialog.value = {
    kind: "confirm",
    title: t("rviz.save.title"),
    text: t(changed ? "rviz.changed" : "rviz.is_there", { file: path }),
    action: t("rviz.replace"),
    danger: true,
    run: () => void save(true),
  };
}
