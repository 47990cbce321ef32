/** What is done with a row of a live display or of a group of them: by menu, and by keys. */

/** @import { MenuItem } from "../../lib/ui.js" */

import { html, signal, useEffect, useRef } from "vendor/preact.js";
import {
  freeName,
  intoMove,
  inwardMove,
  isWithin,
  outerGroup,
  outwardMove,
  stepMove,
} from "../../lib/display-groups.js";
import { t } from "../../lib/i18n.js";
import { Icon, openMenu } from "../../lib/ui.js";
import {
  dissolveGroup,
  duplicateDisplay,
  groupsNow,
  liveDisplays,
  moveLive,
  removeDisplay,
  removeGroup,
  renameDisplay,
  renameGroup,
} from "../../model/live-displays.js";
import { rowId } from "./tree.js";

/** Id of the row whose name is being written; empty: none. */
export const renaming = signal("");

/** Keys as RViz's buttons have them, and those of lists. @param {string} display @param {string} name */
export const displayKeys = (display, name) => ({
  ...rowKeys(`display:${display}`),
  Delete: () => void removeDisplay(display, name),
  "Ctrl+x": () => void removeDisplay(display, name),
  "Ctrl+d": () => void duplicateDisplay(display),
});

/** @param {string} group */
export const groupKeys = (group) => ({
  ...rowKeys(`group:${group}`),
  Delete: () => void removeGroup(group),
  "Ctrl+x": () => void removeGroup(group),
});

/** @param {string} row @returns {Record<string, () => void>} */
function rowKeys(row) {
  const move =
    (
      /** @type {(displays: typeof liveDisplays.value) => import("../../lib/display-groups.js").Move | null} */ to,
    ) =>
    () =>
      void moveLive(to(liveDisplays.value));
  return {
    F2: () => startRenaming(row),
    "Ctrl+r": () => startRenaming(row),
    "Alt+ArrowUp": move((all) => stepMove(all, row, -1)),
    "Alt+ArrowDown": move((all) => stepMove(all, row, 1)),
    "Alt+ArrowRight": move((all) => inwardMove(all, row)),
    "Alt+ArrowLeft": move((all) => outwardMove(all, row)),
    ...menuKeys(row),
  };
}

/** @param {string} row */
function menuKeys(row) {
  const open = () => {
    const button = document.getElementById(rowId(row))?.querySelector(".tree-menu");
    if (button instanceof HTMLElement) button.click();
  };
  return { ContextMenu: open, "Shift+F10": open };
}

/** @param {string} row */
export function startRenaming(row) {
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
  const { group, name } = liveDisplays.value.find(({ id }) => id === display) ?? {
    group: "",
    name: "",
  };
  return [
    renameItem(`display:${display}`),
    {
      label: t("live.duplicate"),
      icon: "copy",
      hint: "Ctrl D",
      run: () => void duplicateDisplay(display),
    },
    ...moveItems(`display:${display}`, group),
    {
      label: t("live.remove"),
      icon: "trash",
      hint: t("live.key.delete"),
      run: () => void removeDisplay(display, name),
    },
  ];
}

/** @param {string} row @returns {MenuItem} */
const renameItem = (row) => ({
  label: t("live.rename"),
  icon: "pencil",
  hint: "F2",
  run: () => startRenaming(row),
});

/** @param {string} row @param {string} group that it stands in @returns {MenuItem[]} */
function moveItems(row, group) {
  const all = liveDisplays.value;
  /** @param {string} words @param {string} hint @param {import("../../lib/display-groups.js").Move | null} move @returns {MenuItem} */
  const item = (words, hint, move) => ({
    label: t(words),
    hint,
    disabled: move === null,
    run: () => void moveLive(move),
  });
  return [
    item("live.up", "Alt ↑", stepMove(all, row, -1)),
    item("live.down", "Alt ↓", stepMove(all, row, 1)),
    item("live.outward", "Alt ←", outwardMove(all, row)),
    { label: t("live.group"), icon: "folder", more: () => groupChoices(row, group) },
  ];
}

/** @param {string} row @param {string} current @returns {MenuItem[]} */
function groupChoices(row, current) {
  const own = row.startsWith("group:") ? row.slice("group:".length) : null;
  const known = groupsNow().filter((group) => own === null || !isWithin(group, own));
  /** @param {string} label @param {string} group @returns {MenuItem} */
  const choice = (label, group) => ({
    label,
    checked: group === current,
    run: () => void moveLive(group === current ? null : intoMove(liveDisplays.value, row, group)),
  });
  return [
    choice(t("live.group.none"), ""),
    ...known.map((group) => choice(group.replaceAll("/", " › "), group)),
    { label: t("live.group.new"), icon: "plus", run: () => newGroup(row, current) },
  ];
}

/** @param {string} row @param {string} around the group it stands in, in which the new one is made; its name is written at once */
async function newGroup(row, around) {
  const stem = [around, t("live.group.name")].filter(Boolean).join("/");
  const group = freeName(groupsNow(), stem);
  if (await moveLive(intoMove(liveDisplays.value, row, group))) startRenaming(`group:${group}`);
}

/** @param {string} group @returns {MenuItem[]} */
function groupItems(group) {
  const row = `group:${group}`;
  return [
    renameItem(row),
    ...moveItems(row, outerGroup(group)),
    { label: t("live.ungroup"), icon: "folderOpen", run: () => void dissolveGroup(group) },
    {
      label: t("live.remove_all"),
      icon: "trash",
      hint: t("live.key.delete"),
      run: () => void removeGroup(group),
    },
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
