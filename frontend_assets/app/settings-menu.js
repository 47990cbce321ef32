/** The menus at the right of the bar above: the panels and their layouts; and the page's own settings. */

/** @import { MenuItem } from "../lib/ui.js" */

import { html } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { LANGUAGES, language, t } from "../lib/i18n.js";
import { Icon, MenuButton } from "../lib/ui.js";
import { mayEdit, role } from "../model/connection.js";
import { languageChoice, size, themeChoice } from "../model/view.js";
import { graphicsItems } from "./graphics.js";
import { layoutItems } from "./layout-commands.js";
import { PANEL_GROUPS, PANELS, panelTitle } from "./panels.js";

export function PanelsMenu() {
  if (size.value === "phone") return null;
  return html`<${MenuButton} label=${t("panels.menu")} items=${panelItems}><${Icon} name="layout" /><//>`;
}

export function SettingsMenu() {
  return html`<${MenuButton} label=${t("settings")} items=${settingsItems}><${Icon} name="settings" /><//>`;
}

/** @param {string} id of a command @param {string} icon @param {string} [label] @returns {MenuItem} */
const commandItem = (id, icon, label = t(`command.${id}`)) => ({
  label,
  icon,
  run: () => commandById(id)?.run(),
});

/** @returns {MenuItem[]} */
function panelItems() {
  const groups = PANEL_GROUPS.map((group) => ({
    label: t(`panels.group.${group}`),
    heading: true,
    items: Object.entries(PANELS).filter(([, one]) => one.group === group),
  }));
  return [
    { label: t("command.layouts"), heading: true },
    ...layoutItems(),
    commandItem("reset_layout", "reset"),
    commandItem("layouts", "disk", `${t("layouts.manage")}…`),
    ...groups.flatMap(({ items, ...heading }) => [
      heading,
      ...items.map(([id, { icon }]) => commandItem(`panel.${id}`, icon, panelTitle(id))),
    ]),
  ];
}

/** @returns {MenuItem[]} */
function settingsItems() {
  return [
    // The bar of a phone has no room for the palette's button.
    ...(size.value === "phone" ? [commandItem("palette", "search", t("palette.hint"))] : []),
    ...(size.value === "phone" ? [commandItem("help_panel", "help")] : []),
    commandItem("help", "help"),
    { ...commandItem("keys", "keyboard"), hint: "?" },
    { label: t("theme"), heading: true },
    ...themeItems(),
    { label: t("graphics"), heading: true },
    ...graphicsItems(),
    { label: t("language"), heading: true },
    ...languageItems(),
    ...(role.value === "presenter" ? logOutItems() : []),
  ];
}

/** @returns {MenuItem[]} */
function logOutItems() {
  return [
    { label: t("access"), heading: true },
    { ...commandItem("log_out", "lock", `${t("command.log_out")}…`), disabled: !mayEdit.value },
  ];
}

/** @returns {MenuItem[]} */
function languageItems() {
  return Object.entries(LANGUAGES).map(([id, label]) => ({
    label,
    checked: language.value === id,
    run: () => {
      languageChoice.value = id;
    },
  }));
}

/** @returns {MenuItem[]} */
function themeItems() {
  return /** @type {const} */ (["system", "dark", "light"]).map((choice) => ({
    label: t(`theme.${choice}`),
    checked: themeChoice.value === choice,
    run: () => {
      themeChoice.value = choice;
    },
  }));
}
