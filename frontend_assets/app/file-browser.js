/** The served folders, to walk through and to choose from. */

/** @import { Folder, FolderEntry } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName, isFilePath, pastedPath } from "../lib/paths.js";
import { recall, remember } from "../lib/remembered.js";
import { EmptyState, Icon, IconButton, moveFocus, ProgressBar, SearchBox } from "../lib/ui.js";
import { dialog } from "../model/view.js";
import { RefusedError, send } from "../model/wire.js";

/**
 * @typedef {{folder: Signal<Folder | null>, roots: Signal<readonly string[]>, error: Signal<string>,
 *   words: Signal<string>, everything: Signal<boolean>, go: (path: string) => Promise<void>, onFile?: (path: string) => Promise<unknown>}} Browser `onFile`: opens a path that was written
 */
/** @typedef {((entry: FolderEntry, tab: boolean) => void) | null} OnOpen null: only folders can be entered */

const ICONS = {
  folder: "folder",
  package: "package",
  robot: "robot",
  bag: "bag",
  zip: "zip",
  file: "file",
};
const LAST = "open.folder";

/** @param {{everything?: boolean}} [options] @returns {Browser} the folder that is shown, and the way to another one */
export function useBrowser({ everything = false } = {}) {
  const browser = {
    folder: useSignal(/** @type {Folder | null} */ (null)),
    roots: useSignal(/** @type {readonly string[]} */ ([])),
    error: useSignal(""),
    words: useSignal(""),
    everything: useSignal(everything),
  };
  const asked = useRef(0); // lists, so far
  /** @param {Folder} folder */
  const show = (folder) => {
    browser.folder.value = folder;
    browser.error.value = "";
    browser.words.value = "";
    remember(LAST, folder.path);
  };
  /** @param {string} path empty: the served folders */
  const go = async (path) => {
    asked.current += 1;
    const number = asked.current;
    const isNewest = () => number === asked.current; // else one has gone elsewhere since
    try {
      const answer = await send({ type: "list_folder", path });
      if (answer.type !== "folder") return;
      if (path === "") browser.roots.value = answer.entries.map((entry) => entry.path);
      if (isNewest()) show(answer);
    } catch (refusal) {
      if (isNewest()) browser.error.value = refusalText(refusal);
    }
  };
  useEffect(() => {
    const last = recall(LAST);
    const begin = async () => {
      await go("");
      // A folder remembered from another day may be gone: then the served folders stay.
      if (typeof last !== "string" || last === "" || asked.current > 1) return;
      await go(last);
      browser.error.value = "";
    };
    begin();
  }, []);
  return { ...browser, go };
}

/** @param {unknown} refusal @returns {string} */
const refusalText = (refusal) =>
  refusal instanceof RefusedError ? refusal.message : t("connection.lost");

/** @param {{browser: Browser}} props the way to the folder, and what is shown of it */
function FolderBar({ browser }) {
  const folder = browser.folder.value;
  const crumbs = crumbsOf(folder?.path ?? "", browser.roots.value);
  return html`<div class="open-bar">
    <${IconButton} icon="up" label=${t("open.up")} disabled=${!folder || folder.path === ""} onClick=${() => browser.go(folder?.parent ?? "")} />
    <nav class="crumbs" aria-label=${t("open.crumbs")}>
      <button type="button" class="crumb" aria-current=${folder?.path === "" ? "location" : null} onClick=${() => browser.go("")}>
        <${Icon} name="home" size=${14} /><span>${t("open.roots")}</span></button>
      ${crumbs.map(
        (
          { name, path },
          at,
        ) => html`<${Icon} name="chevronRight" size=${12} /><button key=${path} type="button" class="crumb" title=${path}
          aria-current=${at === crumbs.length - 1 ? "location" : null} onClick=${() => browser.go(path)}><span>${name}</span></button>`,
      )}
    </nav>
    <${SearchBox} label=${t("open.filter")} value=${browser.words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      browser.words.value = text;
    }} />
  </div>`;
}

/** @param {{browser: Browser}} props */
export function EverythingSwitch({ browser }) {
  return html`<label class="open-everything"><input type="checkbox" checked=${browser.everything.value}
    onChange=${(/** @type {any} */ event) => {
      browser.everything.value = event.currentTarget.checked;
    }} />${t("open.everything")}</label>`;
}

/** @param {Browser} browser @returns {FolderEntry[]} */
function shownEntries(browser) {
  const words = browser.words.value.trim().toLowerCase();
  return (browser.folder.value?.entries ?? []).filter(
    (entry) =>
      (browser.everything.value || entry.openable) && entry.name.toLowerCase().includes(words),
  );
}

/** @param {{browser: Browser, opening: string, onOpen: OnOpen}} props */
export function FolderList({ browser, opening, onOpen }) {
  const whole = useRef(/** @type {HTMLElement | null} */ (null));
  const folder = browser.folder.value;
  useEffect(() => {
    const first = whole.current?.querySelector("button.entry-main:not(:disabled)");
    if (first instanceof HTMLElement) first.focus();
  }, [folder?.path]);
  if (!folder && browser.error.value === "")
    return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const shown = shownEntries(browser);
  /** @param {FolderEntry} entry */
  const take = (entry) => {
    if (isEntered(entry)) browser.go(entry.path);
    else if (entry.openable) onOpen?.(entry, false);
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (onBrowserKey(event, whole.current, browser, () => shown[0] && take(shown[0])))
      event.preventDefault();
  };
  /** @param {ClipboardEvent} event a path may be pasted anywhere into the list */
  const onPaste = (event) => {
    const path = pastedPath(event.clipboardData?.getData("text/plain") ?? "");
    if (path === "" || event.target instanceof HTMLInputElement) return;
    event.preventDefault();
    event.stopPropagation();
    browser.words.value = path;
    whole.current?.querySelector("input")?.focus();
  };
  return html`<div class="folder-view" ref=${whole} onKeyDown=${onKeyDown} onPaste=${onPaste}>
    <${FolderBar} browser=${browser} />
    ${browser.error.value && html`<p class="note bad" role="alert">${browser.error.value}</p>`}
    <ul class="entries">
      ${shown.map((entry) => html`<${Entry} key=${entry.path} entry=${entry} busy=${opening === entry.path} onOpen=${onOpen} onEnter=${() => browser.go(entry.path)} />`)}
      ${shown.length === 0 && html`<${Nothing} browser=${browser} />`}
    </ul>
  </div>`;
}

/** @param {{browser: Browser}} props why the list is empty, and what to do */
function Nothing({ browser }) {
  const words = browser.words.value;
  const hidden = (browser.folder.value?.entries.length ?? 0) > 0;
  const path = pastedPath(words);
  if (path !== "") {
    const label = t(isFilePath(path) && browser.onFile ? "open.path" : "open.path.folder", {
      path,
    });
    return html`<${EmptyState} icon="folder" title=${t("open.path.hint")}>
      <button type="button" class="button primary" onClick=${() => takePath(browser, path)}>${label}</button><//>`;
  }
  if (words) return html`<${EmptyState} icon="search" title=${t("filter.nothing", { words })} />`;
  if (!hidden) return html`<${EmptyState} icon="folder" title=${t("open.empty")} />`;
  return html`<${EmptyState} icon="robot" title=${t("open.no_robot")}>
    <button type="button" class="button" onClick=${() => {
      browser.everything.value = true;
    }}>${t("open.show_everything")}</button><//>`;
}

/** A path goes to its folder, or opens its file; other words have filtered the list. @param {Browser} browser @param {() => void} takeFirst */
function takeTyped(browser, takeFirst) {
  const path = pastedPath(browser.words.value);
  if (path === "") takeFirst();
  else takePath(browser, path);
}

/** @param {Browser} browser @param {string} path */
async function takePath(browser, path) {
  if (isFilePath(path) && browser.onFile) await browser.onFile(path);
  else await browser.go(path);
}

/** @param {FolderEntry} entry @returns {boolean} */
const isEntered = ({ kind }) => kind === "folder" || kind === "package";

/**
 * @param {KeyboardEvent} event @param {HTMLElement | null} whole @param {Browser} browser
 * @param {() => void} takeFirst
 * @returns {boolean} it was ours
 */
function onBrowserKey(event, whole, browser, takeFirst) {
  const { key, target } = event;
  const typing = target instanceof HTMLInputElement;
  const step = {
    ArrowDown: 1,
    ArrowUp: -1,
    Home: Number.NEGATIVE_INFINITY,
    End: Number.POSITIVE_INFINITY,
  }[key];
  if (step && !(typing && Math.abs(step) > 1)) return moveFocus(whole, step);
  if (typing && key === "Enter") takeTyped(browser, takeFirst);
  else if (!typing && key === "Backspace") browser.go(browser.folder.value?.parent ?? "");
  else if (!typing && isLetter(event)) whole?.querySelector("input")?.focus();
  else return false;
  // A letter goes into the box that has the focus by now.
  return key.length > 1;
}

/** @param {KeyboardEvent} event @returns {boolean} */
function isLetter({ key, ctrlKey, metaKey, altKey }) {
  return key.length === 1 && key !== " " && !ctrlKey && !metaKey && !altKey;
}

/** @param {{entry: FolderEntry, busy: boolean, onEnter: () => void, onOpen: OnOpen}} props */
function Entry({ entry, busy, onEnter, onOpen }) {
  const enters = isEntered(entry);
  const opens = onOpen !== null && entry.openable;
  const off = busy || (!enters && !opens);
  // A served folder comes with its whole path as its name.
  const note = entry.reason || (entry.name === baseName(entry.name) ? "" : entry.path);
  /** @param {MouseEvent} event */
  const onClick = (event) => {
    if (enters) onEnter();
    else onOpen?.(entry, event.ctrlKey || event.metaKey);
  };
  return html`<li class=${`entry ${entry.kind} ${off ? "off" : ""}`}>
    <button type="button" class="entry-main" disabled=${off} onClick=${onClick} title=${entry.path}>
      <${Icon} name=${ICONS[entry.kind]} /><span class="entry-name">${baseName(entry.name)}</span>
      ${entry.kind === "package" && html`<span class="entry-chip">${t("open.package")}</span>`}
      ${note && html`<span class="entry-reason">${note}</span>`}
      ${busy && html`<span class="spinner"></span>`}
    </button>
    ${opens && html`<${EntryButtons} entry=${entry} busy=${busy} onOpen=${onOpen} />`}
  </li>`;
}

/** @param {{entry: FolderEntry, busy: boolean, onOpen: OnOpen}} props */
function EntryButtons({ entry, busy, onOpen }) {
  const name = baseName(entry.name);
  const likely = ["robot", "package", "bag"].includes(entry.kind);
  return html`<button type="button" class=${`button small ${likely ? "primary" : ""}`} disabled=${busy}
      aria-label=${t("open.entry", { name })} onClick=${() => onOpen?.(entry, false)}>${t("open.here")}</button>
    ${entry.kind === "bag" ? null : html`<${WaysToOpen} entry=${entry} busy=${busy} onOpen=${onOpen} />`}`;
}

/** What has arguments is also opened with others, or beside the page. @param {{entry: FolderEntry, busy: boolean, onOpen: OnOpen}} props */
function WaysToOpen({ entry, busy, onOpen }) {
  const name = baseName(entry.name);
  return html`<button type="button" class="button small wide-only" disabled=${busy} aria-label=${t("open.entry_tab", { name })}
      onClick=${() => onOpen?.(entry, true)}>${t("open.tab")}</button>
    <${IconButton} icon="arguments" label=${t("open.entry_arguments", { name })} disabled=${busy} onClick=${() => {
      dialog.value = { kind: "launch", path: entry.path };
    }} />`;
}

/**
 * The way from a served folder down to the one that is shown.
 *
 * @param {string} path
 * @param {readonly string[]} roots the served folders
 * @returns {{name: string, path: string}[]} the served folder first; nothing for the list of these
 */
export function crumbsOf(path, roots) {
  if (path === "") return [];
  const root = roots.filter((one) => isAtOrBelow(path, one)).sort((a, b) => a.length - b.length)[0];
  const begin = root ?? path;
  const separator = path.includes("\\") && !path.includes("/") ? "\\" : "/";
  const steps = path.slice(begin.length).split(separator).filter(Boolean);
  const crumbs = [{ name: lastStep(begin), path: begin }];
  for (const step of steps) {
    const above = crumbs.at(-1)?.path ?? begin;
    crumbs.push({ name: step, path: `${above.replace(/[/\\]$/, "")}${separator}${step}` });
  }
  return crumbs;
}

/** @param {string} path @param {string} root @returns {boolean} */
function isAtOrBelow(path, root) {
  return path === root || (path.startsWith(root) && /[/\\]/.test(path[root.length] ?? ""));
}

/** @param {string} path @returns {string} */
const lastStep = (path) => path.split(/[/\\]/).filter(Boolean).at(-1) ?? path;
