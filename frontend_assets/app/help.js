/** The way to the help: its pages by name, and the commands and buttons that open them. */

/** @import { Command } from "../lib/commands.js" */

import { html } from "vendor/preact.js";
import { ICON_OF, OF_DIALOG, OTHER_PAGES } from "../lib/help-pages.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
import { dialog } from "../model/view.js";
import { PANELS, panelTitle } from "./panels.js";
import { help, helpTrail } from "./state/help.js";

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

/** @param {string} page @returns {string} */
export const helpTitle = (page) => (page in PANELS ? panelTitle(page) : t(`help.page.${page}`));

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
