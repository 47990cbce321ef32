/** What is done with a row of a live display or of a group of them: by menu, and by keys. */

/** @import { MenuItem } from "../../lib/ui.js" */

import { html, signal, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { freeName, moveOfDisplay, moveOfGroup } from "../../lib/live-displays.js";
import { Icon, openMenu } from "../../lib/ui.js";
import {
  duplicateDisplay,
  groupDisplay,
  groupsNow,
  liveDisplays,
  moveDisplay,
  moveGroup,
  removeDisplay,
  removeGroup,
  renameDisplay,
  renameGroup,
} from "../../model/live-displays.js";
import { rowId } from "./tree.js";

/** Id of the row whose name is being written; empty: none. */
export const renaming = signal("");

/** @param {string} display */
export const displayKeys = (display) => ({
  F2: () => startRenaming(`display:${display}`),
  Delete: () => void removeDisplay(display),
  "Ctrl+d": () => void duplicateDisplay(display),
  "Alt+ArrowUp": () => void moveDisplay(display, -1),
  "Alt+ArrowDown": () => void moveDisplay(display, 1),
  ...menuKeys(`display:${display}`),
});

/** @param {string} group */
export const groupKeys = (group) => ({
  F2: () => startRenaming(`group:${group}`),
  "Alt+ArrowUp": () => void moveGroup(group, -1),
  "Alt+ArrowDown": () => void moveGroup(group, 1),
  ...menuKeys(`group:${group}`),
});

/** @param {string} row */
function menuKeys(row) {
  const open = () => {
    const button = document.getElementById(rowId(row))?.querySelector(".tree-menu");
    if (button instanceof HTMLElement) button.click();
  };
  return { ContextMenu: open, "Shift+F10": open };
}

/** @param {string} row */
function startRenaming(row) {
  renaming.value = row;
}

/** @param {{row: string, name: string}} props */
export function RowMenu({ row, name }) {
  const menu = useRef(/** @type {import("../../lib/ui.js").MenuHandle | null} */ (null));
  useEffect(() => () => menu.current?.close(), []);
  const label = t("live.menu", { name });
  const toggle = (/** @type {MouseEvent} */ event) => {
    const button = /** @type {HTMLElement} */ (event.currentTarget);
    if (button.getAttribute("aria-expanded") === "true") menu.current?.close();
    else menu.current = openMenu(button, label, itemsOf(row));
  };
  // Its keys are the row's, so this is not one more stop for the Tab key.
  return html`<button type="button" class="tree-menu" aria-label=${label} title=${label} aria-haspopup="menu"
    aria-expanded="false" tabindex=${-1} onClick=${toggle}><${Icon} name="dots" size=${15} /></button>`;
}

/** @param {string} row @returns {MenuItem[]} */
function itemsOf(row) {
  const of = row.slice(row.indexOf(":") + 1);
  return row.startsWith("group:") ? groupItems(of) : displayItems(of);
}

/** @param {string} display @returns {MenuItem[]} */
function displayItems(display) {
  const { group } = liveDisplays.value.find(({ id }) => id === display) ?? { group: "" };
  const move = (/** @type {1 | -1} */ step) => ({
    disabled: moveOfDisplay(liveDisplays.value, display, step) === null,
    run: () => void moveDisplay(display, step),
  });
  return [
    {
      label: t("live.rename"),
      icon: "pencil",
      hint: "F2",
      run: () => startRenaming(`display:${display}`),
    },
    {
      label: t("live.duplicate"),
      icon: "copy",
      hint: "Ctrl D",
      run: () => void duplicateDisplay(display),
    },
    { label: t("live.up"), hint: "Alt ↑", ...move(-1) },
    { label: t("live.down"), hint: "Alt ↓", ...move(1) },
    { label: t("live.group"), icon: "folder", more: () => groupChoices(display, group) },
    {
      label: t("live.remove"),
      icon: "trash",
      hint: t("live.key.delete"),
      run: () => void removeDisplay(display),
    },
  ];
}

/** @param {string} display @param {string} current @returns {MenuItem[]} */
function groupChoices(display, current) {
  const known = groupsNow();
  /** @param {string} label @param {string} group @returns {MenuItem} */
  const choice = (label, group) => ({
    label,
    checked: group === current,
    run: () => void groupDisplay(display, group),
  });
  return [
    choice(t("live.group.none"), ""),
    ...known.map((group) => choice(group, group)),
    { label: t("live.group.new"), icon: "plus", run: () => newGroup(display) },
  ];
}

/** @param {string} display its name is written at once */
async function newGroup(display) {
  const group = freeName(groupsNow(), t("live.group.name"));
  if (await groupDisplay(display, group)) startRenaming(`group:${group}`);
}

/** @param {string} group @returns {MenuItem[]} */
function groupItems(group) {
  const move = (/** @type {1 | -1} */ step) => ({
    disabled: moveOfGroup(liveDisplays.value, group, step) === null,
    run: () => void moveGroup(group, step),
  });
  return [
    {
      label: t("live.rename"),
      icon: "pencil",
      hint: "F2",
      run: () => startRenaming(`group:${group}`),
    },
    { label: t("live.up"), hint: "Alt ↑", ...move(-1) },
    { label: t("live.down"), hint: "Alt ↓", ...move(1) },
    { label: t("live.ungroup"), icon: "folderOpen", run: () => void renameGroup(group, "") },
    { label: t("live.remove_all"), icon: "trash", run: () => void removeGroup(group) },
  ];
}

/** The name of a row as it is being written: Enter and leaving it write, Escape does not. @param {{row: string, text: string}} props */
export function NameBox({ row, text }) {
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  useEffect(() => {
    // A menu that closes gives the focus back to its button after this.
    const asked = requestAnimationFrame(() => box.current?.select());
    return () => cancelAnimationFrame(asked);
  }, []);
  const end = () => {
    renaming.value = "";
    requestAnimationFrame(() => document.getElementById(rowId(row))?.focus());
  };
  const write = () => {
    if (renaming.peek() !== row) return;
    renaming.value = "";
    const typed = box.current?.value.trim() ?? "";
    if (typed !== "" && typed !== text) rename(row, typed);
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Enter" && event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "Enter") write();
    end();
  };
  return html`<span class="tree-control name-box" onClick=${(/** @type {Event} */ event) => event.stopPropagation()}>
    <input ref=${box} type="text" class="box wide" aria-label=${t("live.name", { name: text })} maxlength="80"
      spellcheck=${false} autocomplete="off" defaultValue=${text} onKeyDown=${onKeyDown} onBlur=${write} /></span>`;
}

/** @param {string} row @param {string} name */
function rename(row, name) {
  const of = row.slice(row.indexOf(":") + 1);
  if (row.startsWith("group:")) renameGroup(of, name);
  else renameDisplay(of, name);
}
