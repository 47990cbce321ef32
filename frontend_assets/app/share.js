/**
 * A link that opens this robot with its arguments and unsaved edits, at the moment of its bag and as
 * this page shows it, and what happens at following one.
 */

/** @import { Link, LinkLook } from "../types/wire.d.ts" */

import { effect, html } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { baseName } from "../lib/paths.js";
import { recall, remember } from "../lib/remembered.js";
import { sinceStart } from "../lib/timeline.js";
import { Dialog } from "../lib/ui.js";
import { documentId, role } from "../model/connection.js";
import { documentState, robot } from "../model/document.js";
import { ask, goTo } from "../model/requests.js";
import { part, selectPart } from "../model/selection.js";
import { dialog, layoutControl, notify, size } from "../model/view.js";
import { viewport } from "../model/viewport.js";
import { takePanels, toldPanels } from "./page-part.js";

const MARK = "#robot=";
const LEFT_OUT = "link.left_out";
const LOOK = "link.look";
/** Of the panels in a link; the studio takes no more. */
const LAYOUT_CHARACTERS = 50_000;
/** Longer ones are cut by chat programs and mail. */
const LONG = 2000;
/** Of the arguments in a link so many are told before it is opened. */
const ARGUMENTS_SHOWN = 6;
/** A link may come from anybody, and hold texts of any length. */
const DETAIL_CHARACTERS = 200;

export async function copyLink() {
  await allSettled();
  const answer = await ask({ type: "get_link", look: lookNow() });
  if (answer?.type === "link") dialog.value = { kind: "share", link: answer };
}

/** @returns {LinkLook} how this page shows the robot */
function lookNow() {
  const pose = viewport.peek()?.getCamera();
  const camera = pose && {
    ...{ eye: [...pose.position], target: [...pose.target], up: [...pose.up] },
    ...{ flat: pose.flat, field: pose.field },
  };
  const layout = size.peek() === "phone" ? "" : toldPanels();
  return {
    camera: /** @type {LinkLook["camera"]} */ (camera ?? null),
    part: part.peek() ?? "",
    layout: layout.length > LAYOUT_CHARACTERS ? "" : layout,
  };
}

/** @param {{link: Link, onClose: () => void}} props */
export function ShareDialog({ link, onClose }) {
  const text = `${location.origin}${address("/")}${MARK}${link.text}`;
  const copy = async () => {
    if (await copyText(text)) notify(t("share.copied"));
    onClose();
  };
  return html`<${Dialog} title=${t("share.title")} closeLabel=${t("close")} class="share" onClose=${onClose}>
    <p class="dialog-text">${t("share.text")}</p>
    <ul class="share-list">
      <li>${link.arguments > 0 ? t("share.arguments", { count: link.arguments }) : t("share.no_arguments")}</li>
      <li>${link.edits > 0 ? t("share.edits", { count: link.edits }) : t("share.no_edits")}${link.files.length > 0 ? `: ${link.files.map(baseName).join(", ")}` : ""}</li>
      ${link.bag && html`<li>${t("share.moment", { bag: link.bag, time: sinceStart(link.at_s, 3) })}</li>`}
      <li>${t("share.look")}</li>
    </ul>
    <label class="field"><span>${t("share.address")}</span>
      <input type="text" class="box wide" readonly value=${text} onFocus=${(/** @type {any} */ event) => event.currentTarget.select()} /></label>
    ${text.length > LONG && html`<p class="note">${t("share.long", { count: text.length })}</p>`}
    <footer><span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" data-first onClick=${copy}>${t("share.copy")}</button></footer>
  <//>`;
}

/** Follow the link that this page was opened by; a viewer is told what to do. */
export async function followLink() {
  sayLeftOut();
  showLook();
  if (!location.hash.startsWith(MARK)) return;
  const text = location.hash.slice(MARK.length);
  window.history.replaceState(null, "", location.pathname);
  if (role.value !== "presenter") {
    notify(t("share.viewer"), { bad: true });
    return;
  }
  const holds = await linkContents(text);
  const file = holds && baseName(holds.file);
  dialog.value = {
    kind: "confirm",
    title: file ? t("share.open.file", { file }) : t("share.open"),
    text: t("share.open.text"),
    details: holds ? detailsOf(holds) : [],
    action: t("share.open.action"),
    run: () => void openLink(text),
  };
}

/** @param {LinkContents} holds @returns {string[]} the file, what it is given, how much is edited, and its bag */
function detailsOf({ file, arguments: given, edits, bag }) {
  const passed = Object.entries(given).map(([name, value]) => `${name}:=${value}`);
  const some = passed.slice(0, ARGUMENTS_SHOWN);
  if (passed.length > some.length)
    some.push(t("variants.more", { count: passed.length - some.length }));
  const changes = edits > 0 ? [t("share.edits", { count: edits })] : [];
  const moments = bag ? [t("share.open.moment", { bag })] : [];
  return [file, ...some, ...changes, ...moments].map((one) => one.slice(0, DETAIL_CHARACTERS));
}

/** @param {string} text */
async function openLink(text) {
  const answer = await ask({ type: "open_link", link: text });
  if (answer?.type !== "link_opened") return;
  remember(LEFT_OUT, answer.left_out);
  remember(LOOK, { document: answer.document, look: answer.look });
  goTo(answer.document);
}

/** The page that the link led to says which edits it could not make. */
function sayLeftOut() {
  const sentences = recall(LEFT_OUT);
  if (!Array.isArray(sentences) || sentences.length === 0) return;
  remember(LEFT_OUT, []);
  for (const one of sentences.slice(0, 3)) notify(String(one), { bad: true });
}

/** The page that the link led to looks as the one where it was made. */
function showLook() {
  const { document, look } = /** @type {{document?: string, look?: LinkLook}} */ (
    recall(LOOK) ?? {}
  );
  remember(LOOK, undefined);
  if (!look || document !== documentId.peek()) return;
  const { camera, part: chosen, layout } = look;
  if (layout)
    once(
      () => documentState.value && layoutControl.value,
      () => showPanels(layout),
    );
  if (chosen)
    once(
      () => robot.value,
      () => selectPart(chosen, "", "", ""),
    );
  if (!camera) return;
  const { eye, ...rest } = camera;
  once(
    () => viewport.value,
    (view) => view.setCamera({ position: eye, ...rest }),
  );
}

/** @param {string} layout of the link; the person's own comes back by one press */
function showPanels(layout) {
  const before = toldPanels();
  takePanels(layout);
  if (toldPanels() === before) return;
  const run = () => takePanels(before);
  notify(t("share.panels"), { long: true, action: { label: t("share.panels.back"), run } });
}

/** @template T @param {() => T | null | undefined | false} ready @param {(found: T) => void} run once it is there */
function once(ready, run) {
  const end = effect(() => {
    const found = ready();
    if (!found) return;
    queueMicrotask(() => {
      end();
      run(found);
    });
  });
}

const VERSION = "1";
/** The studio packs no more into one. */
const UNPACKED_CHARACTERS = 2 << 20;

/** @typedef {{file: string, arguments: Record<string, string>, edits: number, bag: string}} LinkContents `file` with its package, where it has one; `bag`: its name, empty without one */

/**
 * What a link to a robot holds, read here so that it can be told before anything is opened.
 *
 * @param {string} text as it stands in the address
 * @returns {Promise<LinkContents | null>} null: it cannot be read
 */
export async function linkContents(text) {
  if (!text.startsWith(VERSION)) return null;
  try {
    const {
      entry,
      arguments: given = {},
      files = [],
      moment,
    } = /** @type {Shared} */ (JSON.parse(await unpacked(text.slice(1))));
    return {
      file: nameOf(moment?.own ? moment.bag : entry),
      bag: moment ? baseName(String(moment.bag.path)) : "",
      arguments: Object.fromEntries(
        Object.entries(given).map(([name, one]) => [name, String(one)]),
      ),
      edits: files.flatMap((one) => one.edits).length,
    };
  } catch {
    return null;
  }
}

/** @typedef {{path: string, package?: string, inside?: string}} SharedPath */
/** @typedef {{entry: SharedPath, arguments?: Record<string, unknown>, files?: {edits: unknown[]}[], moment?: {bag: SharedPath, own?: boolean}}} Shared as anybody may have written it */

/** @param {SharedPath} shared @returns {string} */
const nameOf = (shared) =>
  shared.package ? `${shared.package}/${shared.inside}` : String(shared.path);

/** @param {string} packed base64url of compressed text @returns {Promise<string>} */
async function unpacked(packed) {
  const bytes = Uint8Array.from(atob(packed.replaceAll("-", "+").replaceAll("_", "/")), (one) =>
    one.charCodeAt(0),
  );
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = stream.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    text += part.value;
    if (text.length > UNPACKED_CHARACTERS) throw new RangeError("too large");
  }
  return text;
}
