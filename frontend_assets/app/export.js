/** The robot for other programs: files that the studio makes, and pictures that this page takes. */

/** @import { Command } from "../lib/commands.js" */
/** @import { MenuItem } from "../lib/ui.js" */

import { html } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { Icon, MenuButton } from "../lib/ui.js";
import { connection, documentId, mayManage } from "../model/connection.js";
import { robot, title } from "../model/document.js";
import { isFree, notify, theme } from "../model/view.js";
import { viewport } from "../model/viewport.js";

const KEPT_MS = 60_000;
const SCALES = [1, 2, 4];

/** @param {Blob} data @param {string} name */
function keep(data, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(data);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), KEPT_MS);
}

/** @param {string} what behind the document's address: a refusal comes as a sentence, a file is kept under its own name */
async function download(what) {
  await allSettled();
  notify(t("export.begun"));
  const path = address(`/api/documents/${encodeURIComponent(documentId.value)}/export/${what}`);
  try {
    const answer = await fetch(path, { cache: "no-store" });
    if (answer.ok) keep(await answer.blob(), nameOf(answer));
    else notify((await answer.json()).reason ?? t("export.failed"), { bad: true });
  } catch {
    notify(t("export.failed"), { bad: true });
  }
}

/** @param {Response} answer @returns {string} as its header says (RFC 6266) */
function nameOf(answer) {
  const disposition = answer.headers.get("content-disposition") ?? "";
  const coded = disposition.split("filename*=UTF-8''")[1];
  return coded ? decodeURIComponent(coded) : "robot";
}

/** @param {number} scale @param {boolean} transparent */
async function takePicture(scale, transparent) {
  const picture = await viewport.value?.picture(scale, transparent);
  if (!picture) return notify(t("export.no_picture"), { bad: true });
  const name = title.value.replace(/(\.urdf)?(\.xacro)?$/, "") || "robot";
  keep(picture, `${name}${scale > 1 ? `@${scale}x` : ""}.png`);
  return undefined;
}

const there = () => documentId.value !== "" && connection.value === "connected" && isFree();
const withRobot = () => there() && robot.value !== null;
const byPresenter = () => withRobot() && mayManage.value;
const withView = () => withRobot() && viewport.value !== null;

/** Behind the document's address, by the command's name. @type {Record<string, string>} */
const FILES = {
  urdf: "urdf?meshes=package",
  urdf_absolute: "urdf?meshes=absolute",
  urdf_copied: "urdf?meshes=copied",
  package: "package?packages=entry",
  packages: "package?packages=used",
};

/** @returns {Command[]} by name in the palette, and in the menu */
export function exportCommands() {
  const files = Object.entries(FILES).map(([id, what]) => ({
    id: `export_${id}`,
    icon: what.startsWith("urdf") ? "urdf" : "box",
    enabled: what.startsWith("urdf") ? byPresenter : () => there() && mayManage.value,
    run: () => void download(what),
  }));
  const pictures = SCALES.map((scale) => ({
    id: `export_picture_${scale}`,
    icon: "scene",
    enabled: withView,
    run: () => void takePicture(scale, false),
  }));
  return [
    ...files,
    {
      id: "export_page",
      icon: "scene",
      enabled: withRobot,
      run: () => void download(`page?theme=${theme.value}`),
    },
    ...pictures,
    {
      id: "export_picture_clear",
      icon: "scene",
      enabled: withView,
      run: () => void takePicture(2, true),
    },
  ];
}

const VIEW = ["page", ...SCALES.map((scale) => `picture_${scale}`), "picture_clear"];

/** @returns {MenuItem[]} */
export function exportItems() {
  return [
    { label: t("export.files"), heading: true },
    ...Object.keys(FILES).map(exportItem),
    { label: t("export.view"), heading: true },
    ...VIEW.map(exportItem),
  ];
}

/** @param {string} id @returns {MenuItem} */
function exportItem(id) {
  const command = commandById(`export_${id}`);
  return {
    label: t(`export.${id}`),
    icon: command?.icon ?? "download",
    disabled: !(command?.enabled?.() ?? false),
    run: () => command?.run(),
  };
}

export function ExportMenu() {
  return html`<${MenuButton} label=${t("export")} disabled=${documentId.value === ""} items=${exportItems}><${Icon} name="download" /><//>`;
}
