/**
 * The bar above: what is open, undo and redo with the list of steps, saving, the panels and their
 * layouts, and the page's own settings.
 */

/** @import { MenuItem } from "../lib/ui.js" */

import { html } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { tabsOf } from "../lib/arrangement.js";
import { commandById, onMac, shortcutText } from "../lib/commands.js";
import { LANGUAGES, language, t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { Icon, IconButton, MenuButton } from "../lib/ui.js";
import { control, you } from "../model/class.js";
import { documentId, mayEdit, mayManage, role } from "../model/connection.js";
import { isCopy } from "../model/copies.js";
import { documents, history, title, unsaved } from "../model/document.js";
import { ask, goTo, redo, reload, save, undo } from "../model/requests.js";
import { configItems } from "../model/rviz-configs.js";
import { dialog, languageChoice, layoutControl, size, theme, themeChoice } from "../model/view.js";
import { ClassButtons } from "./control.js";
import { ExportMenu, exportItems } from "./export.js";
import { graphicsItems } from "./graphics.js";
import { commandItem, layoutItems, layoutName } from "./layout-commands.js";
import { LIVE, layoutInUse } from "./layouts.js";
import { PANEL_GROUPS, PANELS, panelTitle } from "./panels.js";
import { closeAsking } from "./rviz-commands.js";

export function TopBar() {
  const { unsaved_count: count } = history.value;
  return html`<header class="top-bar">
    <div class="bar-left">
    <h1><a class="brand" href=${address("/")} aria-label=${t("brand.home")}><span class="logo"><${Icon} name="robot" size=${17} /></span>
      <span class="brand-name">${t("brand")}</span></a></h1>
    <${DocumentMenu} />
    ${
      unsaved.value &&
      !isCopy.value && // it is handed in, not saved
      html`<span class="unsaved" title=${t("unsaved.count", { count })}><span class="dot"></span>
      <span class="wide-only">${t("unsaved.count", { count })}</span></span>`
    }
    </div>
    <${PaletteButton} />
    <div class="bar-right">
    ${role.value !== "guest" && html`<${EditButtons} />`}
    <${ClassButtons} />
    ${size.value !== "phone" && html`<${ExportMenu} />`}
    ${size.value !== "phone" && html`<${LayoutSwitch} />`}
    <${PanelsMenu} />
    <${SettingsMenu} />
    <${ThemeButton} />
    </div>
  </header>`;
}

function DocumentMenu() {
  // Until the studio has said what is open there is nothing to read, and so nothing to move.
  const name = title.value || (documentId.value === "" ? t("document.none") : "");
  return html`<${MenuButton} class="document-button" label=${t("documents.menu")} value=${name} hint=${name} items=${documentItems}>
    <${Icon} name="fileCode" /><span class="document-title">${name}</span>${name && html`<${Icon} name="chevronDown" size=${13} />`}
  <//>`;
}

/** @returns {MenuItem[]} */
function documentItems() {
  /** @type {MenuItem[]} */
  const open = documents.value.map((one) => ({
    label: `${one.title}${one.unsaved ? " •" : ""}`,
    hint: folderOf(one.path),
    checked: one.id === documentId.value,
    run: () => one.id !== documentId.value && goTo(one.id),
  }));
  const locked = !mayManage.value;
  const none = locked || documentId.value === "";
  const unedited = !mayEdit.value || documentId.value === "";
  return [
    ...(open.length > 0 ? [{ label: t("documents.open"), heading: true }, ...open] : []),
    { label: t("document"), heading: true },
    {
      label: `${t("command.open")}…`,
      icon: "open",
      hint: keyOf("open"),
      disabled: locked,
      run: () => commandById("open")?.run(),
    },
    ...["new_robot", "new_pasted"].map((id) => ({
      label: `${t(`command.${id}`)}…`,
      icon: commandById(id)?.icon ?? "filePlus",
      disabled: locked,
      run: () => commandById(id)?.run(),
    })),
    {
      label: `${t("command.save_as")}…`,
      icon: "disk",
      disabled: none,
      run: () => commandById("save_as")?.run(),
    },
    {
      label: `${t("command.arguments")}…`,
      icon: "arguments",
      disabled: none,
      run: () => commandById("arguments")?.run(),
    },
    {
      label: `${t("command.copy_link")}…`,
      icon: "link",
      disabled: unedited,
      run: () => commandById("copy_link")?.run(),
    },
    // The bar of a phone has no room for the menu's own button.
    ...(size.value === "phone"
      ? [
          {
            label: `${t("export")}…`,
            icon: "download",
            disabled: documentId.value === "",
            more: exportItems,
          },
        ]
      : []),
    { label: t("command.reload"), icon: "reload", disabled: unedited, run: reload },
    { label: t("rviz.config"), icon: "list", disabled: documentId.value === "", more: configItems },
    { label: t("document.close"), icon: "close", disabled: none, run: closeAsking },
  ];
}

/** Folders that every package has: they tell nobody which robot it is. */
const USUAL = new Set([
  "urdf",
  "xacro",
  "robot",
  "robots",
  "model",
  "models",
  "description",
  "src",
]);

/** @param {string} path @returns {string} the name of the nearest folder that tells robots apart */
function folderOf(path) {
  const folders = path.split(/[/\\]/).slice(0, -1);
  return folders.findLast((name) => !USUAL.has(name.toLowerCase())) ?? folders.at(-1) ?? "";
}

/** @param {string} id of a command @returns {string} its key, as keyboards are labelled */
function keyOf(id) {
  const key = commandById(id)?.keys?.[0];
  return key ? shortcutText(key, onMac) : "";
}

function PaletteButton() {
  const show = () => {
    dialog.value = { kind: "palette" };
  };
  return html`<button type="button" class="palette-button" onClick=${show} aria-label=${`${t("palette.button")} ${keyOf("palette")}`}>
    <${Icon} name="search" /><span>${t("palette.button")}</span>${" "}<kbd>${keyOf("palette")}</kbd></button>`;
}

function EditButtons() {
  const { undo: done, redo: undone } = history.value;
  const off = !mayEdit.value;
  return html`<div class="edit-buttons">
    <${IconButton} icon="undo" label=${t("command.undo")} hint=${hinted("undo", done.at(-1))} disabled=${off || done.length === 0} onClick=${() => undo()} />
    <${IconButton} icon="redo" label=${t("command.redo")} hint=${hinted("redo", undone.at(-1))} disabled=${off || undone.length === 0} onClick=${() => redo()} />
    <${HistoryMenu} />
    ${
      !isCopy.value &&
      html`<button type="button" class="button save" aria-label=${t("command.save")} title=${`${t("command.save")} (${keyOf("save")})`}
      disabled=${off || !unsaved.value} onClick=${save}>
      <${Icon} name="disk" /><span class="label">${t("command.save")}</span></button>`
    }
  </div>`;
}

/** @param {string} id @param {string | undefined} step @returns {string} */
function hinted(id, step) {
  return `${t(`command.${id}`)}${step ? `: ${step}` : ""} (${keyOf(id)})`;
}

/** From the studio's own layout for a model to that for a robot that runs, and back. */
function LayoutSwitch() {
  return html`<div class="layout-switch" role="group" aria-label=${t("layouts.title")}>
    ${["", LIVE].map(
      (name) => html`<button key=${name} type="button" aria-pressed=${layoutInUse.value === name}
      title=${t("layouts.use", { name: layoutName(name) })} onClick=${() => layoutControl.value?.use(name)}>${layoutName(name)}</button>`,
    )}
  </div>`;
}

function ThemeButton() {
  const next = theme.value === "dark" ? "light" : "dark";
  const toggle = () => {
    themeChoice.value = next;
  };
  return html`<${IconButton} icon=${next === "light" ? "sun" : "moon"} label=${t(`theme.to_${next}`)} class="theme-button" onClick=${toggle} />`;
}

const SHOWN = 200;

/** @param {number} position how many steps are done then @param {number} of how many there are in all */
async function goToStep(position, of) {
  await allSettled();
  await ask({ type: "undo_to", position, of });
}

/** @returns {MenuItem[]} a click goes to how it was after that step */
function stepItems() {
  const { undo: done, redo: undone } = history.value;
  const of = done.length + undone.length;
  const steps = [t("undo.start"), ...done, ...[...undone].reverse()];
  const items = steps.map((label, position) => ({
    label,
    checked: position === done.length,
    run: () => void goToStep(position, of),
  }));
  return [
    { label: t("undo.list"), heading: true },
    ...items.slice(Math.max(0, Math.min(done.length - SHOWN / 2, items.length - SHOWN))).reverse(),
  ];
}

/** The undo list: every step by its name, the newest first, with a mark at where one is. */
function HistoryMenu() {
  const { undo: done, redo: undone } = history.value;
  const none = done.length + undone.length === 0;
  return html`<${MenuButton} class="icon-button narrow" label=${t("undo.list")} disabled=${!mayEdit.value || none} items=${stepItems}>
    <${Icon} name="chevronDown" size=${12} /><//>`;
}

function PanelsMenu() {
  if (size.value === "phone") return null;
  return html`<${MenuButton} label=${t("panels.menu")} items=${panelItems}><${Icon} name="layout" /><//>`;
}

function SettingsMenu() {
  return html`<${MenuButton} label=${t("settings")} items=${settingsItems}><${Icon} name="settings" /><//>`;
}

/** @returns {MenuItem[]} */
function panelItems() {
  const open = openPanels();
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
      ...items.map(([id, { icon }]) => ({
        ...commandItem(`panel.${id}`, icon, panelTitle(id)),
        ...(open.has(id) && { mark: t("panels.is_open") }),
      })),
    ]),
  ];
}

/** @returns {ReadonlySet<string>} panels that stand somewhere now */
function openPanels() {
  const { parts, floating = [] } = layoutControl.value?.present() ?? { parts: [] };
  return new Set([...parts.flatMap(tabsOf), ...floating.flatMap(({ tabs }) => tabs)]);
}

/** @returns {MenuItem[]} */
function settingsItems() {
  return [
    // The bar of a phone has no room for the palette's button.
    ...(size.value === "phone" ? [commandItem("palette", "search", t("palette.hint"))] : []),
    ...(size.value === "phone" ? [...classItems(), commandItem("help_panel", "help")] : []),
    commandItem("help", "help"),
    { ...commandItem("keys", "keyboard"), hint: "?" },
    { label: t("theme"), heading: true },
    ...themeItems(),
    { label: t("graphics"), heading: true },
    ...graphicsItems(),
    { label: t("language"), heading: true },
    ...languageItems(),
    ...(role.value === "presenter" ? logOutItems() : []),
    ...(you.value.name ? nameItems() : []),
  ];
}

/** @returns {MenuItem[]} */
function logOutItems() {
  return [
    { label: t("access"), heading: true },
    { ...commandItem("log_out", "lock", `${t("command.log_out")}…`), disabled: !mayManage.value },
  ];
}

/** @returns {MenuItem[]} as buttons where the bar has room for them */
function classItems() {
  if (role.value !== "presenter") return [];
  const stop = commandItem("stop_robot", "stopSign");
  return [commandItem("share_class", "users"), ...(control.value.class_open ? [stop] : [])];
}

/** @returns {MenuItem[]} */
function nameItems() {
  return [{ label: you.value.name, heading: true }, commandItem("class_name", "pencil")];
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
