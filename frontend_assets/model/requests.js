/** What a person can ask of the studio about the open document. A refusal is shown as a notice. */

/** @import { Command } from "../types/wire.d.ts" */
/** @import { Answer, Asked } from "./wire.js" */

import { documentAddress } from "../lib/address.js";
import { t } from "../lib/i18n.js";
import { allSettled, latestSender } from "../lib/latest.js";
import { documentId, mayEdit, mayManage, role } from "./connection.js";
import {
  animating,
  documentProblems,
  documentState,
  gone,
  history,
  packageProblems,
  showBeforeSaving,
  unsaved,
} from "./document.js";
import { selected } from "./selection.js";
import { dialog, notify } from "./view.js";
import { RefusedError, send } from "./wire.js";

/**
 * @param {Asked<Command>} command
 * @returns {Promise<Answer | null>} null when it was refused (which is said) or the studio is gone
 */
export async function ask(command) {
  try {
    return await send(command);
  } catch (error) {
    if (error instanceof RefusedError) notify(error.message, { bad: true });
    return null;
  }
}

/** @param {string} site @param {string} text @param {string} [gesture] */
export const editSite = (site, text, gesture = "") =>
  ask({ type: "edit_site", site, text, gesture });
/** @param {string} site */
export const resetSite = (site) => ask({ type: "reset_site", site });
/** @param {string} name @param {string | null} value null: the default in the file counts again */
export const setArgument = (name, value) => ask({ type: "set_argument", name, value });
export const zeroJoints = () => ask({ type: "zero_joints" });
export const randomizeJoints = () => ask({ type: "randomize_joints" });
export const toggleAnimation = () => ask({ type: "animate_joints", running: !animating.value });
/** @param {"grid" | "robot" | "ghost"} display @param {string} name @param {boolean | number | string} value */
export const setDisplay = (display, name, value) =>
  ask({ type: "set_display", display, name, value });
/** @param {string} name @param {string} folder */
export const choosePackage = (name, folder) => ask({ type: "choose_package", name, folder });

/** @type {ReturnType<typeof latestSender<Record<string, number>>>} */
const jointSender = latestSender((positions) => ask({ type: "set_joints", positions }));
/** @type {Record<string, number>} */
let movedJoints = {};

/** @param {string} joint @param {number} value rad or m; sent at most once per frame, newest first */
export function moveJoint(joint, value) {
  movedJoints = jointSender.busy() ? { ...movedJoints, [joint]: value } : { [joint]: value };
  jointSender.push(movedJoints);
}

/** @returns {Promise<void>} when the studio has answered the last move */
export const jointsSettled = () => jointSender.settled();

/** @param {number} [steps] */
export async function undo(steps = 1) {
  await allSettled();
  for (let n = 0; n < steps && history.value.undo.length > 0; n += 1) {
    if (!(await ask({ type: "undo" }))) return;
  }
}

/** @param {number} [steps] */
export async function redo(steps = 1) {
  await allSettled();
  for (let n = 0; n < steps && history.value.redo.length > 0; n += 1) {
    if (!(await ask({ type: "redo" }))) return;
  }
}

/** Show what saving writes, or write it at once, as was chosen. */
export async function save() {
  await allSettled();
  if (!mayEdit.value || !unsaved.value) return;
  const { unsaved_count: places, unsaved_files: files } = history.value;
  const choice = showBeforeSaving.value;
  if (choice === "always" || (choice === "several" && Math.max(places, files.length) > 1))
    dialog.value = { kind: "save" };
  else await saveFiles(null);
}

/** @param {readonly string[] | null} files null: all */
export async function saveFiles(files) {
  await allSettled();
  const count = Math.max((files ?? history.value.unsaved_files).length, 1);
  if (await ask({ type: "save", files: files && [...files] })) notify(t("saved", { count }));
}

export function reload() {
  const run = () => ask({ type: "reload" });
  if (!unsaved.value) return run();
  dialog.value = {
    kind: "confirm",
    title: t("reload"),
    text: t("reload.unsaved"),
    action: t("reload.discard"),
    danger: true,
    run,
  };
  return undefined;
}

let going = false;

/** @returns {boolean} the page is on its way to another document of the studio, or to another relay */
export const isGoing = () => going;

/** @param {string} other address, where all goes on as it is here */
export function leaveTo(other) {
  going = true;
  location.assign(other);
}

/** @param {string} id */
export const goTo = (id) => leaveTo(documentAddress(id));

export async function closeDocument() {
  if (!unsaved.value) return closeNow(false);
  const run = () => void closeNow(true);
  dialog.value = {
    kind: "confirm",
    title: t("document.close"),
    text: t("document.close.unsaved"),
    action: t("document.close.discard"),
    danger: true,
    run,
  };
  return undefined;
}

/** @param {boolean} discard */
async function closeNow(discard) {
  if (await ask({ type: "close_document", discard })) goTo("");
}

/** @param {string} path @param {Record<string, string>} values @param {{tab?: boolean}} [options] */
export async function openPath(path, values, { tab = false } = {}) {
  const opened = await ask({ type: "open_path", path, arguments: values });
  if (opened?.type !== "opened") return false;
  if (tab) window.open(documentAddress(opened.document), "_blank", "noopener");
  else goTo(opened.document);
  return true;
}

/** @param {Asked<Command>} command that opens something by its name @returns {Promise<boolean>} it was opened */
export async function openNamed(command) {
  const opened = await ask(command);
  if (opened?.type === "opened") goTo(opened.document);
  return opened?.type === "opened";
}

/** Ask for the whole document; after a restart of the studio, open its file again. */
export async function watch() {
  if (documentId.value === "") return;
  try {
    await send({ type: "watch" });
  } catch (error) {
    if (error instanceof RefusedError) await openAgain(error);
  }
}

/** @param {RefusedError} refusal */
async function openAgain(refusal) {
  const known = documentState.value;
  if (known && role.value === "presenter" && refusal.kind === "UnknownDocumentError") {
    const answer = await ask({ type: "open_path", path: known.path, arguments: known.arguments });
    if (answer?.type === "opened") return follow(answer.document);
  }
  gone.value = true;
}

/** @param {string} id the same file under its new id */
async function follow(id) {
  documentId.value = id;
  window.history.replaceState(null, "", documentAddress(id));
  await ask({ type: "watch" });
}

/** Have every error and warning mended that an edit mends, in one step. */
export async function mendAll() {
  await allSettled();
  return ask({ type: "mend_all" });
}

/** @param {import("../types/wire.d.ts").Problem} problem one that has a fix */
async function applyFix({ code, sentence, fix }) {
  await allSettled();
  return ask({ type: "apply_fix", code, sentence, label: fix?.label ?? "" });
}

/** Mends what is wrong in packages; who knows them puts it here. @type {{mend: (problem: import("../types/wire.d.ts").Problem) => Promise<unknown>}} */
export const packageMender = { mend: async () => {} };

const MENDED_BY_EDITS = ["edit", "undo", "resolve_collisions"];

/** @param {import("../types/wire.d.ts").Problem} problem @returns {boolean} this person may have it mended */
export const canMend = (problem) =>
  problem.fix !== null &&
  (packageProblems.value.includes(problem) ? mayManage.value : mayMend(problem.fix));

/** @param {NonNullable<import("../types/wire.d.ts").Problem["fix"]>} fix of the document's own */
const mayMend = (fix) => (MENDED_BY_EDITS.includes(fix.action) ? mayEdit.value : mayManage.value);

/** @param {import("../types/wire.d.ts").Problem} problem */
export function mend(problem) {
  const { fix } = problem;
  if (!fix) return undefined;
  if (packageProblems.value.includes(problem)) return packageMender.mend(problem);
  if (fix.action === "edit") return applyFix(problem);
  if (fix.action === "undo") return undo();
  if (fix.action === "choose_package") dialog.value = { kind: "choose_package", name: fix.target };
  if (fix.action === "resolve_collisions") dialog.value = { kind: "merge", file: fix.target };
  if (fix.action === "give_arguments") dialog.value = { kind: "launch", path: "" };
  if (fix.action === "open_file") return openPath(fix.target, {});
  return undefined;
}

/** @returns {import("../types/wire.d.ts").Problem | undefined} what hinders the robot most */
export function worstProblem() {
  const order = ["error", "warning", "info"];
  return [...documentProblems.value].sort(
    (a, b) => order.indexOf(a.severity) - order.indexOf(b.severity),
  )[0];
}

export function clearSelection() {
  selected.value = null;
}
