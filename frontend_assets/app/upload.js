/** Sends files to the studio, in one request, and goes to the robot that is among them. */

/** @import { DroppedFile } from "../lib/dropped.js" */

import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { mayEdit } from "../model/connection.js";
import { goTo } from "../model/requests.js";
import { dialog, notify } from "../model/view.js";
import { sending } from "./state/sending.js";

/** @param {readonly DroppedFile[]} files */
export async function uploadFiles(files) {
  if (!mayEdit.value || sending.value) return;
  if (files.length === 0) {
    notify(t("upload.nothing"), { bad: true });
    return;
  }
  dialog.value = null;
  try {
    const document = await send(bodyOf(files), nameOf(files));
    if (document) goTo(document);
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
 * @param {Blob} body @param {string} name
 * @returns {Promise<string>} id of the document; empty when it was cancelled
 */
function send(body, name) {
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
    request.open("POST", "/api/uploads");
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
