/**
 * The help: which pages there are, which one is shown, and the commands and buttons that open
 * them.
 */

/** @import { Command } from "../lib/commands.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
import { dialog } from "../model/view.js";
import { PANELS, panelTitle } from "./panels.js";

const TRAIL_MOST = 20;
/** What had the focus before. @type {Element | null} */
let before = null;

/** @returns {Record<string, readonly string[]>} all pages by the name of their group */
export const helpGroups = () => ({
  panels: Object.keys(PANELS),
  ...OTHER_PAGES,
});

/** @returns {string[]} */
const allPages = () => Object.values(helpGroups()).flat();

/** @param {string} page @returns {boolean} its texts and picture are in the folder of that panel */
export const isOfPanel = (page) => Object.hasOwn(PANELS, page);

/** @param {string} page @returns {string} */
export const helpTitle = (page) => (isOfPanel(page) ? panelTitle(page) : t(`help.page.${page}`));

/** @param {string} page @returns {string} name of its icon */
export const helpIcon = (page) => PANELS[page]?.icon ?? ICON_OF[page] ?? "help";

/**
 * @param {string} page empty: the list of all
 * @param {Element | null} [about] what it is about, which shall not be covered
 */
export function openHelp(page, about = null) {
  if (help.value === null) {
    before = document.activeElement;
    helpTrail.value = [];
  }
  help.value = { page, side: sideAwayFrom(about), modal: dialog.value !== null };
}

/** Go on to another page. @param {string} page */
export function goToHelp(page) {
  const now = help.value;
  if (!now || now.page === page) return;
  helpTrail.value = [...helpTrail.value, now.page].slice(-TRAIL_MOST);
  help.value = { ...now, page };
}

/** To the page read before this one. */
export function goBackInHelp() {
  const page = helpTrail.value.at(-1);
  if (page === undefined || !help.value) return;
  helpTrail.value = helpTrail.value.slice(0, -1);
  help.value = { ...help.value, page };
}

/** The focus goes back to where it was, unless it is somewhere else by now. @param {HTMLDialogElement} sheet */
export function closeHelp(sheet) {
  const hadFocus = sheet.contains(document.activeElement);
  // As long as it lies over a window, nothing in that one can take the focus.
  sheet.close();
  help.value = null;
  if (hadFocus && before instanceof HTMLElement && before.isConnected) before.focus();
  before = null;
}

/** @param {Element | null} about @returns {"left" | "right"} */
function sideAwayFrom(about) {
  if (!about) return "right";
  const { left, width } = about.getBoundingClientRect();
  return left + width / 2 > innerWidth / 2 ? "left" : "right";
}

/** @returns {Command[]} */
export function helpCommands() {
  const pages = allPages().map((page) => ({
    id: `help.${page}`,
    icon: "help",
    label: () => t("help.of", { page: helpTitle(page) }),
    run: () => openHelp(page),
  }));
  return [{ id: "help", icon: "help", run: () => openHelp("") }, ...pages];
}

/** @returns {import("vendor/preact.js").VNode | null} stands in the head of the window that is open */
export function DialogHelp() {
  const page = OF_DIALOG[dialog.value?.kind ?? ""];
  if (!page) return null;
  return html`<${IconButton} icon="help" label=${t("help.of", { page: helpTitle(page) })} onClick=${() => openHelp(page)} />`;
}

/**
 * @typedef {object} ShownHelp
 * @property {string} page empty: the list of all pages
 * @property {"left" | "right"} side of the window, away from what is asked about
 * @property {boolean} modal over a window that would have all keys and clicks otherwise
 */

/** @type {Signal<ShownHelp | null>} */
export const help = signal(null);
/** The pages read before this one, the newest last. @type {Signal<readonly string[]>} */
export const helpTrail = signal([]);

/** Pages that are not about one panel, with their icons, by the heading above them. */
const OTHERS = {
  tasks: {
    open: "open",
    arguments: "sliders",
    saving: "disk",
    export: "download",
    measuring: "measure",
    search: "search",
    ros: "link",
    live: "radar",
    markers: "hand",
    rviz: "list",
    keys: "keyboard",
    class: "users",
    own_nodes: "node",
    layouts: "layout",
    timeline: "history",
    graphics: "system",
  },
  words: { xacro: "macro", links: "joints", frame: "axes", units: "info" },
};
export const OTHER_PAGES = {
  tasks: Object.keys(OTHERS.tasks),
  words: Object.keys(OTHERS.words),
};
/** Icons of these pages. @type {Record<string, string>} */
const ICON_OF = { ...OTHERS.tasks, ...OTHERS.words };
/** The page about each window that has a head; the search finds its own help. @type {Record<string, string>} */
export const OF_DIALOG = {
  open: "open",
  choose_package: "open",
  launch: "arguments",
  save: "saving",
  save_as: "saving",
  merge: "saving",
  share: "export",
  keys: "keys",
  layouts: "layouts",
  graphics: "graphics",
  class: "class",
  class_name: "class",
  nodes: "own_nodes",
  remark: "class",
  ros: "ros",
  add_display: "live",
  new_package: "packages",
  add_to_package: "packages",
  rviz_open: "rviz",
  rviz_save: "rviz",
  rviz_opened: "rviz",
};
