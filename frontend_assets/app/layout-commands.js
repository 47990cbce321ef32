/** What is done with panels and their layouts by a name or a key: next, move, close, switch. */

/** @import { Dock, Place } from "../lib/dock.js" */
/** @import { MenuItem } from "../lib/ui.js" */
/** @import { Command } from "../lib/commands.js" */

import { effect } from "vendor/preact.js";
import { addCommands, commandById, replaceCommands } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { openMenu } from "../lib/ui.js";
import { dialog, fullView, isFree, layoutControl, size } from "../model/view.js";
import { helpTitle, openHelp } from "./help.js";
import { LIVE, layoutInUse, ownLayouts } from "./layouts.js";
import { PANELS, panelTitle } from "./panels.js";

/** So many layouts have a key of their own. */
const KEYS_MOST = 9;
const NAMES_SHOWN = 3;

/** @param {Dock} dock @param {HTMLElement} element that holds it */
export function addLayoutCommands(dock, element) {
  addCommands([
    ...showCommands(dock),
    ...focusCommands(dock),
    ...placeCommands(dock),
    helpCommand(dock),
  ]);
  effect(() => replaceCommands("layout.", layoutCommands()));
  element.addEventListener("contextmenu", (event) => {
    const id = dock.panelOfTab(event.target);
    if (!id || size.value === "phone") return;
    event.preventDefault();
    openPanelMenu(dock, id);
  });
  followFullView(dock);
}

/** The 3D view alone, as RViz's full screen, and the browser's with it where it may be had. @param {Dock} dock */
function followFullView(dock) {
  let wasOn = false;
  /** Whether the browser's full screen is that of the view: one that just ends says so late. */
  let isOurs = false;
  const enter = async () => {
    await document.documentElement.requestFullscreen?.();
    isOurs = fullView.value;
    // Whoever left meanwhile found no full screen yet that could be ended.
    if (!isOurs && document.fullscreenElement) await document.exitFullscreen();
  };
  effect(() => {
    const on = fullView.value && size.value !== "phone";
    if (on === wasOn) return;
    wasOn = on;
    dock.showAlone(on ? "scene" : null);
    if (on) return void enter().catch(() => {}); // without it the view is alone on the page
    isOurs = false;
    if (document.fullscreenElement) document.exitFullscreen();
  });
  document.addEventListener("fullscreenchange", () => {
    if (!document.fullscreenElement && isOurs) fullView.value = false;
  });
}

/** @param {Dock} dock @returns {Command[]} */
function showCommands(dock) {
  return Object.entries(PANELS).map(([id, { icon }]) => ({
    id: `panel.${id}`,
    icon,
    run: () => dock.show(id),
  }));
}

/** @param {Dock} dock @returns {Command[]} */
function focusCommands(dock) {
  return [
    { id: "next_panel", icon: "layout", keys: ["F6"], inText: true, run: () => dock.focusNext(1) },
    {
      id: "previous_panel",
      icon: "layout",
      keys: ["Shift+F6"],
      inText: true,
      run: () => dock.focusNext(-1),
    },
  ];
}

/** @param {Dock} dock @returns {Command[]} */
function placeCommands(dock) {
  const wide = () => size.value !== "phone";
  const shown = () => wide() && isFree() && dock.active() !== null;
  return [
    {
      id: "maximize",
      icon: "maximize",
      keys: ["Mod+Enter"],
      enabled: shown,
      run: dock.toggleMaximized,
    },
    {
      id: "move_panel",
      icon: "jump",
      keys: ["Mod+Shift+M"],
      inText: true,
      enabled: shown,
      run: () => openPanelMenu(dock, dock.active() ?? ""),
    },
    {
      id: "float_panel",
      icon: "float",
      keys: ["Mod+Shift+Enter"],
      label: () =>
        t(dock.isFloating(dock.active() ?? "") ? "command.dock_panel" : "command.float_panel"),
      inText: true,
      enabled: () => shown() && !PANELS[dock.active() ?? ""]?.keepsFrame,
      run: () => dock.toggleFloating(dock.active() ?? ""),
    },
    {
      id: "close_panel",
      icon: "close",
      enabled: shown,
      run: () => dock.close(dock.active() ?? ""),
    },
    {
      id: "fullscreen",
      icon: "fullscreen",
      keys: ["F11"],
      inText: true,
      enabled: () => wide() && isFree(),
      run: () => {
        fullView.value = !fullView.value;
      },
    },
    {
      id: "leave_fullscreen",
      icon: "minimize",
      keys: ["Escape"],
      enabled: () => fullView.value && isFree(),
      run: () => {
        fullView.value = false;
      },
    },
    { id: "reset_layout", icon: "reset", enabled: wide, run: () => layoutControl.value?.reset() },
    {
      id: "layouts",
      icon: "layout",
      enabled: wide,
      run: () => {
        dialog.value = { kind: "layouts" };
      },
    },
  ];
}

/** @param {Dock} dock @returns {Command} help on what one is at */
function helpCommand(dock) {
  return {
    id: "help_panel",
    icon: "help",
    keys: ["F1"],
    inText: true,
    run: () => {
      const id = dock.panelOfTab(document.activeElement) ?? dock.active() ?? "";
      openHelp(id, dock.tab(id));
    },
  };
}

/** @returns {Command[]} the studio's own layouts and each that was saved */
function layoutCommands() {
  return layoutNames().map((name, at) => ({
    id: `layout.${at}`,
    icon: "layout",
    label: () => t("layouts.use", { name: layoutName(name) }),
    ...(at < KEYS_MOST ? { keys: [`Mod+${at + 1}`], inText: true } : {}),
    enabled: () => size.value !== "phone" && isFree(),
    run: () => layoutControl.value?.use(name),
  }));
}

/** @returns {string[]} the studio's own, then those that were saved */
const layoutNames = () => ["", LIVE, ...ownLayouts.value.map(({ name }) => name)];

/** @param {string} name @returns {string} */
export const layoutName = (name) =>
  name === LIVE ? t("layouts.live") : name || t("layouts.model");

/** @returns {MenuItem[]} for a menu, with the one in use ticked */
export function layoutItems() {
  return layoutNames().map((name) => ({
    label: layoutName(name),
    checked: layoutInUse.value === name,
    run: () => layoutControl.value?.use(name),
  }));
}

/** @param {Dock} dock @param {string} id what can be done with a panel, under its tab @param {HTMLElement | null} [button] that opens it, if not the tab */
export function openPanelMenu(dock, id, button = dock.tab(id)) {
  if (!button) return;
  const isFloating = dock.isFloating(id);
  /** @type {MenuItem[]} */
  const moves = dock.places(id).map((place) => ({
    label: placeName(place),
    icon: place.kind === "beside" ? "layout" : "jump",
    run: () => dock.move(id, place),
  }));
  openMenu(button, t("panel.menu", { panel: panelTitle(id) }), [
    ...(moves.length > 0
      ? [{ label: t("panel.move", { panel: panelTitle(id) }), heading: true }]
      : []),
    ...moves,
    { label: panelTitle(id), heading: true },
    ...(PANELS[id]?.keepsFrame
      ? [commandItem("fullscreen")]
      : [
          {
            label: t(isFloating ? "command.dock_panel" : "command.float_panel"),
            icon: isFloating ? "dock" : "float",
            run: () => dock.toggleFloating(id),
          },
        ]),
    ...(isFloating
      ? []
      : [
          {
            label: t("maximize"),
            icon: "maximize",
            run: () => {
              dock.show(id);
              dock.toggleMaximized();
            },
          },
        ]),
    {
      label: t("help.of", { page: helpTitle(id) }),
      icon: "help",
      run: () => openHelp(id, button),
    },
    { label: t("panel.close"), icon: "close", run: () => dock.close(id) },
  ]);
}

/** @param {string} id of a command @param {string} [icon] @param {string} [label] @returns {MenuItem} */
export const commandItem = (
  id,
  icon = commandById(id)?.icon ?? "box",
  label = t(`command.${id}`),
) => ({
  label,
  icon,
  run: () => commandById(id)?.run(),
});

/** @param {Place} place @returns {string} */
function placeName(place) {
  if (place.kind !== "beside") return t(`place.${place.kind}.${place.edge}`);
  const names = place.names.slice(0, NAMES_SHOWN).map(panelTitle).join(", ");
  return t("place.beside", { names: place.names.length > NAMES_SHOWN ? `${names} …` : names });
}
