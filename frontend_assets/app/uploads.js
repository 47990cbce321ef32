/**
 * Files that come to the studio: dropped anywhere on the page, chosen in a file window, or pasted
 * as text; they open as robots, or as types of ROS.
 */

/** @import { DroppedFile } from "../lib/files.js" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, html, signal, useRef } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { takesText } from "../lib/commands.js";
import { chosenFiles, droppedFiles, holdsFiles } from "../lib/files.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { Icon, ProgressBar } from "../lib/ui.js";
import { documentId, mayManage } from "../model/connection.js";
import { takeDroppedTypes, takePastedType } from "../model/interfaces.js";
import { openingBag } from "../model/recording.js";
import { ask, goTo } from "../model/requests.js";
import { isConfig } from "../model/rviz-configs.js";
import { dialog, notify } from "../model/view.js";
import { viewport } from "../model/viewport.js";
import { holdsBag, takeBag } from "./dropped-bags.js";
import { takeConfig } from "./rviz-commands.js";

const MEGABYTE = 1 << 20;
/** The studio reads no longer command; longer texts come as a file. */
const PASTED_AT_MOST = 700_000;

/** Listens on the page, and on the frame of the 3D view, which keeps its events to itself. */
export function listenToDrops() {
  listenOn(window);
  effect(() => {
    const frame = viewport.value && document.querySelector("iframe")?.contentWindow;
    if (frame) listenOn(frame);
  });
}

/** @param {Window} view */
function listenOn(view) {
  view.addEventListener("dragenter", onDrag);
  view.addEventListener("dragover", onDrag);
  view.addEventListener("dragleave", onLeave);
  view.addEventListener("drop", onDrop);
  view.addEventListener("paste", onPaste);
}

/** @param {DragEvent} event */
function onDrag(event) {
  if (!holdsFiles(event.dataTransfer)) return;
  // Not prevented, the browser would leave the page and show the file itself.
  event.preventDefault();
  const takes = mayManage.value && sending.value === null;
  if (event.dataTransfer) event.dataTransfer.dropEffect = takes ? "copy" : "none";
  dropping.value = takes;
}

/** @param {DragEvent} event the pointer left the window, or went from one element to the next */
function onLeave(event) {
  if (event.relatedTarget === null) dropping.value = false;
}

/** @param {DragEvent} event */
async function onDrop(event) {
  if (!event.dataTransfer || !holdsFiles(event.dataTransfer)) return;
  event.preventDefault();
  dropping.value = false;
  if (!mayManage.value) return;
  await takeFiles(await droppedFiles(event.dataTransfer));
}

/** @param {readonly import("../lib/files.js").DroppedFile[]} files a robot, or types of ROS */
async function takeFiles(files) {
  const [only] = files;
  if (only && files.length === 1 && isConfig(only.path) && documentId.value !== "") {
    takeConfig(only.file);
    return;
  }
  if (!(await takeDroppedTypes(files))) await openFiles(files);
}

/** @param {ClipboardEvent} event */
async function onPaste(event) {
  if (event.defaultPrevented || takesText(event.target) || dialog.value !== null) return;
  if (!mayManage.value || !event.clipboardData) return;
  const files = [...event.clipboardData.files];
  const text = event.clipboardData.getData("text/plain");
  if (files.length === 0 && text === "") return;
  event.preventDefault();
  if (files.length > 0) await takeFiles(chosenFiles(files));
  else if (!takePastedType(text)) await openText(text);
}

/** @param {string} text @returns {Promise<boolean>} it is open, as an untitled robot */
export async function openText(text) {
  if (!text.includes("<")) {
    notify(t("paste.no_robot"), { bad: true });
    return false;
  }
  if (text.length > PASTED_AT_MOST) {
    await uploadFiles([{ path: "pasted.urdf.xacro", file: new File([text], "pasted") }]);
    return true;
  }
  const opened = await ask({ type: "new_untitled", text });
  if (opened?.type !== "opened") return false;
  goTo(opened.document);
  return true;
}

/** What lies over the page while files are held over it, or are on their way, or a bag is read. */
export function DropLayer() {
  if (openingBag.value) return html`<${Reading} of=${openingBag.value} />`;
  if (sending.value) return html`<${Sending} />`;
  if (!dropping.value) return null;
  return html`<div class="drop-layer" aria-hidden="true"><div class="drop-card">
    <${Icon} name="upload" size=${34} />
    <strong>${t("drop.title")}</strong><span>${t("drop.text")}</span></div></div>`;
}

/** @param {{of: {name: string, done: number}}} props */
function Reading({ of: { name, done } }) {
  const label = t("upload.reading", { name, share: Math.round(done * 100) });
  return html`<div class="sending-card" role="status">
    <p>${label}</p>
    <${ProgressBar} label=${label} done=${Math.round(done * 100)} total=${100} />
  </div>`;
}

function Sending() {
  const now = sending.value;
  if (!now) return null;
  const { name, done, total, cancel } = now;
  const sent = done >= total;
  const megabytes = (/** @type {number} */ bytes) => (bytes / MEGABYTE).toFixed(1);
  const label = sent ? t("upload.opening", { name }) : t("upload.sending", { name });
  return html`<div class="sending-card" role="status">
    <p>${label}</p>
    <${ProgressBar} label=${label} done=${sent ? 0 : done} total=${sent ? 0 : total} />
    <footer><span>${t("upload.done", { done: megabytes(done), total: megabytes(total) })}</span>
      ${!sent && html`<button type="button" class="button small" onClick=${cancel}>${t("cancel")}</button>`}</footer>
  </div>`;
}

/** @param {readonly DroppedFile[]} files a robot, or a bag */
async function openFiles(files) {
  if (await holdsBag(files)) takeBag(files, (beside) => void uploadFiles(files, beside));
  else await uploadFiles(files);
}

/** @param {readonly DroppedFile[]} files @param {string} [beside] the document that shows a bag among them */
async function uploadFiles(files, beside = "") {
  if (!mayManage.value || sending.value) return;
  if (files.length === 0) {
    notify(t("upload.nothing"), { bad: true });
    return;
  }
  dialog.value = null;
  try {
    const document = await send(bodyOf(files), nameOf(files), beside);
    if (document && document !== beside) goTo(document);
  } catch (error) {
    notify(error instanceof Error ? error.message : String(error), { bad: true });
  } finally {
    sending.value = null;
  }
}

/** @param {readonly DroppedFile[]} files @returns {string} what the person dropped */
function nameOf(files) {
  const tops = new Set(files.map(({ path }) => path.split("/")[0] ?? path));
  const [first] = tops;
  return tops.size === 1 && first ? first : t("upload.files", { count: files.length });
}

/** @param {readonly DroppedFile[]} files @returns {Blob} a line that announces them, then their bytes */
function bodyOf(files) {
  const announced = files.map(({ path, file }) => ({ path, size: file.size }));
  return new Blob([`${JSON.stringify(announced)}\n`, ...files.map(({ file }) => file)]);
}

/**
 * @param {Blob} body @param {string} name @param {string} beside
 * @returns {Promise<string>} id of the document; empty when it was cancelled
 */
function send(body, name, beside) {
  // `fetch` does not tell how much of a body has gone out.
  const request = new XMLHttpRequest();
  const cancel = () => request.abort();
  sending.value = { name: baseName(name), done: 0, total: body.size, cancel };
  return new Promise((resolve, reject) => {
    request.upload.onprogress = ({ loaded }) => {
      if (sending.value) sending.value = { ...sending.value, done: loaded };
    };
    request.onabort = () => resolve("");
    request.onerror = () => reject(new Error(t("upload.broken")));
    request.onload = () => {
      const answer = answerOf(request);
      if (answer.document) resolve(answer.document);
      else reject(new Error(answer.reason || t("upload.broken")));
    };
    const query = beside && `?${new URLSearchParams({ beside })}`;
    request.open("POST", address(`/api/uploads${query}`));
    request.send(body);
  });
}

/** @param {XMLHttpRequest} request @returns {{document?: string, reason?: string}} */
function answerOf(request) {
  try {
    return JSON.parse(request.responseText);
  } catch {
    return {};
  }
}

/** The browser's own windows for files and for a folder; what is chosen is sent to the studio. */
export function FileButtons() {
  const files = useRef(/** @type {HTMLInputElement | null} */ (null));
  const folder = useRef(/** @type {HTMLInputElement | null} */ (null));
  /** @param {any} event */
  const onChange = (event) => {
    void openFiles(chosenFiles(event.currentTarget.files));
    event.currentTarget.value = "";
  };
  return html`<div class="file-buttons">
    <button type="button" class="button" onClick=${() => files.current?.click()}><${Icon} name="upload" />${t("upload.choose")}</button>
    <button type="button" class="button" onClick=${() => folder.current?.click()}><${Icon} name="folderOpen" />${t("upload.choose_folder")}</button>
    <p class="file-hint">${t("upload.hint")}</p>
    <input ref=${files} type="file" hidden multiple aria-label=${t("upload.choose")} onChange=${onChange} />
    <input ref=${folder} type="file" hidden webkitdirectory aria-label=${t("upload.choose_folder")} onChange=${onChange} />
  </div>`;
}

/** @typedef {{name: string, done: number, total: number, cancel: () => void}} FilesOnTheWay bytes */

/** @type {Signal<FilesOnTheWay | null>} */
export const sending = signal(null);
/** Files are held over the page. */
const dropping = signal(false);
