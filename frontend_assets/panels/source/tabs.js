/** The tabs of the source panel: a file each, what is unsaved in it, and all files of the robot. */

import { html, useComputed } from "vendor/preact.js";
import { commandById, onMac, shortcutText } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { documentState, history, problems } from "../../model/document.js";
import {
  closeFile,
  heldBack,
  litPlaces,
  openFile,
  openFiles,
  shownFile,
} from "../../model/source.js";
import { ACTIONS } from "./language.js";
import { findInFiles } from "./search.js";

/** @param {{find: () => void, goToLine: () => void, fold: () => void, unfold: () => void, children: import("vendor/preact.js").ComponentChildren}} props what the menu offers for the text in front, and what stands beside the tabs */
export function SourceTabs({ find, children, ...more }) {
  const names = tabNames(openFiles.value);
  const ready = shownFile.value !== "";
  return html`<div class="source-bar">
    <div class="source-tabs" onKeyDown=${onTabKey}>
      <div role="tablist" aria-label=${t("source.files")} aria-owns=${openFiles.value.map((_, at) => tabId(at)).join(" ")}></div>
      ${openFiles.value.map((file, at) => html`<${FileTab} key=${file} id=${tabId(at)} file=${file} ...${names.get(file)} />`)}
    </div>
    ${children}
    <${MenuButton} label=${t("source.all_files")} items=${fileItems}><${Icon} name="chevronDown" /><//>
    <${IconButton} icon="search" label=${t("source.find")} disabled=${!ready} onClick=${find}
      hint=${`${t("source.find")} (${shortcutText("Mod+F", onMac)})`} />
    <${MenuButton} label=${t("source.menu")} items=${() => menuItems(more)}><${Icon} name="dots" /><//>
  </div>`;
}

/** Of a tab: the list owns the tabs by it, for the buttons that close them are none of its own. @param {number} at */
const tabId = (at) => `source-tab-${at}`;

/** @param {{id: string, file: string, name: string, folder: string}} props */
function FileTab({ id, file, name, folder }) {
  const shown = shownFile.value === file;
  const unsaved = history.value.unsaved_files.includes(file);
  const locked = documentState.value?.read_only.includes(file);
  const root = documentState.value?.root ?? "";
  const bad =
    !heldBack.value &&
    problems.value.some(({ severity, place }) => severity === "error" && place?.file === file);
  /** @param {MouseEvent} event the middle button closes */
  const onAux = (event) => {
    if (event.button !== 1) return;
    event.preventDefault();
    closeFile(file);
  };
  const lit = useComputed(() => litPlaces.value.some((place) => place.file === file)).value;
  const states = [shown && "shown", bad && "bad", lit && "lit"].filter(Boolean).join(" ");
  return html`<div class=${`source-tab ${states}`} role="none" onAuxClick=${onAux}>
    <button type="button" role="tab" id=${id} aria-selected=${shown} tabindex=${shown ? 0 : -1}
      title=${shortPath(file, root)} data-file=${file} onClick=${() => openFile(file)}>
      ${bad && html`<${Icon} name="error" size=${12} /><span class="hidden-words">${t("severity.error")}</span>`}
      ${locked && html`<${Icon} name="lock" size=${12} />`}
      <span>${name}</span>${folder && html`<span class="muted">${folder}</span>`}
      ${unsaved && html`<span class="dot" role="img" aria-label=${t("source.unsaved")} title=${t("source.unsaved")}></span>`}
    </button>
    <${IconButton} icon="close" size=${12} class="tab-close" label=${t("source.close", { name })} onClick=${() => closeFile(file)} />
  </div>`;
}

/** @param {KeyboardEvent} event arrows move along the tabs, Delete closes one */
function onTabKey(event) {
  const files = openFiles.value;
  const at = files.indexOf(shownFile.value);
  /** @type {Record<string, number>} */
  const moves = {
    ArrowRight: at + 1,
    ArrowLeft: at - 1 + files.length,
    Home: 0,
    End: files.length - 1,
  };
  const to = moves[event.key];
  const isTab = event.target instanceof Element && event.target.role === "tab";
  if (event.key === "Delete" && isTab) closeFile(shownFile.value);
  else if (to !== undefined) openFile(files[to % files.length] ?? shownFile.value);
  else return;
  event.preventDefault();
  const list = /** @type {HTMLElement} */ (event.currentTarget);
  requestAnimationFrame(() => {
    /** @type {HTMLElement | null} */ (list.querySelector('[aria-selected="true"]'))?.focus();
  });
}

/** @returns {import("../../lib/ui.js").MenuItem[]} the files of the robot, then others that have a tab */
function fileItems() {
  const own = documentState.value?.files ?? [];
  const root = documentState.value?.root ?? "";
  const files = [...own, ...openFiles.value.filter((file) => !own.includes(file))];
  return [
    { label: t("source.files_of"), heading: true },
    ...files.map((file) => ({
      label: shortPath(file, root),
      checked: shownFile.value === file,
      run: () => openFile(file),
    })),
  ];
}

/** @param {{goToLine: () => void, fold: () => void, unfold: () => void}} runs @returns {import("../../lib/ui.js").MenuItem[]} */
function menuItems({ goToLine, fold, unfold }) {
  const file = shownFile.value;
  const others = openFiles.value.filter((one) => one !== file);
  const closeOthers = () => {
    for (const one of others) closeFile(one);
  };
  return [
    ...ACTIONS.map(({ id, icon, key, run }) => ({
      label: t(`command.${id}`),
      icon,
      disabled: file === "",
      hint: shortcutText(key, onMac),
      run,
    })),
    {
      label: t("command.find_in_files"),
      icon: "search",
      hint: shortcutText("Mod+Shift+F", onMac),
      run: findInFiles,
    },
    { label: t("command.fold_all"), icon: "collapse", disabled: file === "", run: fold },
    { label: t("command.unfold_all"), icon: "expand", disabled: file === "", run: unfold },
    {
      label: t("source.go_to_line"),
      icon: "jump",
      disabled: file === "",
      hint: shortcutText("Ctrl+G", false),
      run: goToLine,
    },
    {
      label: t("source.show_urdf"),
      icon: "urdf",
      run: () => commandById("panel.urdf")?.run(),
    },
    {
      label: t("source.close_others"),
      icon: "close",
      disabled: others.length === 0,
      run: closeOthers,
    },
    {
      label: t("source.tab_key", { keys: shortcutText(onMac ? "Shift+Alt+M" : "Mod+M", onMac) }),
      heading: true,
    },
  ];
}

/**
 * Short names for the tabs of files, with as much of the folder as tells two apart.
 *
 * @param {readonly string[]} files
 * @returns {Map<string, {name: string, folder: string}>} `folder` only where needed
 */
export function tabNames(files) {
  /** @type {Map<string, number>} */
  const counts = new Map();
  for (const file of files) counts.set(baseName(file), (counts.get(baseName(file)) ?? 0) + 1);
  return new Map(
    files.map((file) => {
      const name = baseName(file);
      return [file, { name, folder: (counts.get(name) ?? 0) > 1 ? lastFolder(file, files) : "" }];
    }),
  );
}

/** @param {string} file @param {readonly string[]} files @returns {string} */
function lastFolder(file, files) {
  const parts = file.split(/[/\\]/);
  const rivals = files.filter((one) => one !== file && baseName(one) === baseName(file));
  for (let depth = 2; depth < parts.length; depth += 1) {
    const tail = parts.slice(-depth).join("/");
    if (!rivals.some((one) => one.split(/[/\\]/).slice(-depth).join("/") === tail))
      return parts.slice(-depth, -1).join("/");
  }
  return parts.slice(0, -1).join("/");
}
