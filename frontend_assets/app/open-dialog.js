/** The window to open a robot from the served folders, or to point at the folder of a package. */

/** @import { Folder, FolderEntry } from "../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { parseArguments } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { recall, remember } from "../lib/remembered.js";
import { Dialog, EmptyState, Icon, IconButton, ProgressBar, SearchBox } from "../lib/ui.js";
import { choosePackage, openPath } from "./actions.js";
import { dialog } from "./state/view.js";
import { RefusedError, send } from "./wire.js";

/** @import { Signal } from "vendor/preact.js" */
/** @typedef {{folder: Signal<Folder | null>, error: Signal<string>, go: (path: string) => Promise<void>}} Browser */

const ICONS = { folder: "folder", package: "package", robot: "robot", zip: "zip", file: "file" };
const LAST = "open.folder";

/** @returns {Browser} the folder that is shown, and the way to another one */
function useBrowser() {
  const folder = useSignal(/** @type {Folder | null} */ (null));
  const error = useSignal("");
  /** @param {string} path empty: the served folders */
  const go = async (path) => {
    try {
      const answer = await send({ type: "list_folder", path });
      if (answer.type !== "folder") return;
      folder.value = answer;
      error.value = "";
      remember(LAST, path);
    } catch (refusal) {
      // A folder remembered from another day may be gone: begin at the top again.
      if (folder.value === null && path !== "") return go("");
      error.value = refusal instanceof RefusedError ? refusal.message : t("connection.lost");
    }
  };
  useEffect(() => {
    const last = recall(LAST);
    go(typeof last === "string" ? last : "");
  }, []);
  return { folder, error, go };
}

/** @param {{onClose: () => void}} props */
export function OpenDialog({ onClose }) {
  const browser = useBrowser();
  const words = useSignal("");
  const values = useSignal("");
  const opening = useSignal("");
  /** @param {FolderEntry} entry @param {boolean} tab */
  const open = async (entry, tab) => {
    opening.value = entry.path;
    const opened = await openPath(entry.path, parseArguments(values.value), { tab });
    opening.value = "";
    if (opened && tab) onClose();
  };
  return html`<${Dialog} title=${t("open.title")} closeLabel=${t("close")} class="open-dialog" onClose=${onClose}>
    <${Bar} browser=${browser} words=${words} />
    <${Entries} browser=${browser} words=${words.value} opening=${opening.value} onOpen=${open} />
    <label class="field"><span>${t("open.arguments")}</span>
      <input type="text" class="box wide" placeholder="name:=value" spellcheck=${false} value=${values.value}
        onInput=${(/** @type {any} */ event) => {
          values.value = event.currentTarget.value;
        }} /></label>
  <//>`;
}

/** @param {{name: string, onClose: () => void}} props */
export function PackageDialog({ name, onClose }) {
  const browser = useBrowser();
  const words = useSignal("");
  // A missing package often lies where nothing is served: its folder can be written, too.
  const written = useSignal("");
  const path = written.value.trim() || browser.folder.value?.path;
  const choose = async () => {
    if (path && (await choosePackage(name, path))) onClose();
  };
  return html`<${Dialog} title=${t("package.title", { name })} closeLabel=${t("close")} class="open-dialog" onClose=${onClose}>
    <p class="dialog-text">${t("package.text", { name })}</p>
    <${Bar} browser=${browser} words=${words} />
    <${Entries} browser=${browser} words=${words.value} opening="" onOpen=${null} />
    <label class="field"><span>${t("package.path")}</span>
      <input type="text" class="box wide" placeholder=${browser.folder.value?.path ?? ""} spellcheck=${false} value=${written.value}
        onInput=${(/** @type {any} */ event) => {
          written.value = event.currentTarget.value;
        }} /></label>
    <footer><span class="place">${path ?? ""}</span><span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" disabled=${!path} onClick=${choose}>${t("package.use")}</button></footer>
  <//>`;
}

/** @param {{browser: Browser, words: Signal<string>}} props */
function Bar({ browser, words }) {
  const folder = browser.folder.value;
  /** @param {string} path */
  const go = (path) => {
    words.value = "";
    return browser.go(path);
  };
  return html`<div class="open-bar">
    <${IconButton} icon="home" label=${t("open.home")} disabled=${!folder?.path} onClick=${() => go("")} />
    <${IconButton} icon="up" label=${t("open.up")} disabled=${!folder || folder.path === ""} onClick=${() => go(folder?.parent ?? "")} />
    <span class="open-path" title=${folder?.path}><bdi>${folder?.path || t("open.roots")}</bdi></span>
    <${SearchBox} label=${t("open.filter")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} />
  </div>`;
}

/**
 * @param {{browser: Browser, words: string, opening: string,
 *   onOpen: ((entry: FolderEntry, tab: boolean) => void) | null}} props null: only folders can be entered
 */
function Entries({ browser, words, opening, onOpen }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const folder = browser.folder.value;
  useEffect(() => {
    list.current?.querySelector("button")?.focus();
  }, [folder?.path]);
  if (browser.error.value) return html`<p class="note bad" role="alert">${browser.error.value}</p>`;
  if (!folder) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const shown = folder.entries.filter(({ name }) =>
    name.toLowerCase().includes(words.trim().toLowerCase()),
  );
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.key === "Backspace" && folder.path !== "") browser.go(folder.parent ?? "");
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && moveFocus(list.current, step)) event.preventDefault();
  };
  return html`<ul class="entries" ref=${list} onKeyDown=${onKeyDown}>
    ${shown.map((entry) => html`<${Entry} key=${entry.path} entry=${entry} busy=${opening === entry.path} onOpen=${onOpen} onEnter=${() => browser.go(entry.path)} />`)}
    ${shown.length === 0 && html`<${EmptyState} icon="folder" title=${words ? t("filter.nothing", { words }) : t("open.empty")} />`}
  </ul>`;
}

/** @param {HTMLElement | null} list @param {number} step @returns {boolean} */
function moveFocus(list, step) {
  /** @type {HTMLElement[]} */
  const all = [...(list?.querySelectorAll("button.entry-main:not(:disabled)") ?? [])].filter(
    (one) => one instanceof HTMLElement,
  );
  const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  const next = all[at + step];
  next?.focus();
  return next !== undefined;
}

/**
 * @param {{entry: FolderEntry, busy: boolean, onEnter: () => void,
 *   onOpen: ((entry: FolderEntry, tab: boolean) => void) | null}} props
 */
function Entry({ entry, busy, onEnter, onOpen }) {
  const enters = entry.kind === "folder" || entry.kind === "package";
  const opens = onOpen !== null && entry.openable;
  const off = busy || (!enters && !opens);
  // A served folder comes with its whole path as its name.
  const note = entry.reason || (entry.name === baseName(entry.name) ? "" : entry.path);
  /** @param {MouseEvent} event */
  const onClick = (event) => {
    if (enters) onEnter();
    else onOpen?.(entry, event.ctrlKey || event.metaKey);
  };
  return html`<li class=${`entry ${off ? "off" : ""}`}>
    <button type="button" class="entry-main" disabled=${off} onClick=${onClick} title=${entry.path}>
      <${Icon} name=${ICONS[entry.kind]} /><span class="entry-name">${baseName(entry.name)}</span>
      ${note && html`<span class="entry-reason">${note}</span>`}
      ${busy && html`<span class="spinner"></span>`}
    </button>
    ${
      opens &&
      html`<button type="button" class=${`button small ${entry.kind === "robot" || entry.kind === "package" ? "primary" : ""}`} disabled=${busy}
      aria-label=${t("open.entry", { name: baseName(entry.name) })} onClick=${() => onOpen?.(entry, false)}>${t("open.here")}</button>
      <button type="button" class="button small" disabled=${busy} aria-label=${t("open.entry_tab", { name: baseName(entry.name) })}
        onClick=${() => onOpen?.(entry, true)}>${t("open.tab")}</button>
      <${IconButton} icon="properties" label=${t("open.entry_arguments", { name: baseName(entry.name) })} disabled=${busy} onClick=${() => {
        dialog.value = { kind: "launch", path: entry.path };
      }} />`
    }
  </li>`;
}
