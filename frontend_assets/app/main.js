/** Begins the page: words, theme, frame, dock, keys, and the lane to the studio. */

import { effect, html, render } from "vendor/preact.js";
import { documentOf } from "../lib/address.js";
import {
  addCommands,
  commandById,
  matches,
  onKey,
  takesSpace,
  takesText,
} from "../lib/commands.js";
import { createDock } from "../lib/dock.js";
import { nearestLanguage, t, useLanguage } from "../lib/i18n.js";
import { anyUnderWay } from "../lib/latest.js";
import { iconElement } from "../lib/ui.js";
import { documentId, mayEdit, role } from "../model/connection.js";
import { isCopy } from "../model/copies.js";
import { history, movable, title, unsaved } from "../model/document.js";
import { followPresenter } from "../model/following.js";
import { addMeasuring } from "../model/measuring.js";
import {
  clearSelection,
  isGoing,
  redo,
  save,
  toggleAnimation,
  undo,
  watch,
  zeroJoints,
} from "../model/requests.js";
import { mayMove } from "../model/ros.js";
import { configUnsaved } from "../model/rviz-configs.js";
import { selected } from "../model/selection.js";
import { addTools } from "../model/tools.js";
import { activePanel, dialog, fullView, isFree, languageChoice, theme } from "../model/view.js";
import { addViewCommands } from "../model/views.js";
import { connect } from "../model/wire.js";
import { followMissing } from "./dialogs.js";
import { followGraphics } from "./graphics.js";
import { helpCommands, helpTitle, openHelp } from "./help.js";
import { addLayoutCommands, openPanelMenu } from "./layout-commands.js";
import { followSize } from "./layouts.js";
import { menuCommands } from "./menu-commands.js";
import { followDisk } from "./merge-dialog.js";
import { followPagePart } from "./page-part.js";
import { dockPanels, PANELS, panelTitle } from "./panels.js";
import { followLink } from "./share.js";
import { Shell } from "./shell.js";
import { listenToDrops } from "./uploads.js";

const EDITING = { enabled: () => mayEdit.value && isFree() };

/** @param {HTMLElement} element */
function startDock(element) {
  /** @type {{keep: () => void} | null} */
  let arrangement = null;
  const dock = createDock(element, dockPanels(), {
    moreLabel: () => t("tabs.more"),
    title: panelTitle,
    maximizeLabel: () => t("maximize"),
    restoreLabel: () => t("restore"),
    helpLabel: (id) => t("help.of", { page: helpTitle(id) }),
    onHelp: openHelp,
    floatLabel: (id) => t("panel.float", { panel: panelTitle(id) }),
    dockLabel: (id) => t("panel.dock", { panel: panelTitle(id) }),
    closeLabel: (id) => t("panel.close_named", { panel: panelTitle(id) }),
    menuLabel: (id) => t("panel.menu", { panel: panelTitle(id) }),
    alonePanel: () => "scene",
    aloneLabel: () => t("command.fullscreen"),
    onKey: onKeyDown,
    onAlone: () => commandById("fullscreen")?.run(),
    onFloat: (id) => dock.toggleFloating(id),
    onClose: (id) => dock.close(id),
    onMenu: (id, button) => openPanelMenu(dock, id, button),
    icon: iconElement,
    onChange: () => arrangement?.keep(),
    onActive: (id) => {
      activePanel.value = id;
    },
  });
  arrangement = followSize(dock, element, PANELS);
  addLayoutCommands(dock, element);
  // `--fullscreen` is said in the address, and once.
  if (fullView.peek()) window.history.replaceState(null, "", location.pathname + location.hash);
}

function addPageCommands() {
  addCommands([
    {
      id: "palette",
      icon: "search",
      keys: ["Mod+K"],
      inText: true,
      run: () => show({ kind: "palette" }),
    },
    {
      id: "open",
      icon: "open",
      keys: ["Mod+O"],
      inText: true,
      enabled: () => role.value === "presenter",
      run: () => show({ kind: "open" }),
    },
    {
      id: "save",
      icon: "disk",
      keys: ["Mod+S"],
      inText: true,
      enabled: () => mayEdit.value && !isCopy.value && (unsaved.value || anyUnderWay()),
      run: save,
    },
    {
      id: "undo",
      icon: "undo",
      keys: ["Mod+Z"],
      enabled: () => EDITING.enabled() && (history.value.undo.length > 0 || anyUnderWay()),
      run: () => void undo(),
    },
    {
      id: "redo",
      icon: "redo",
      keys: ["Mod+Shift+Z", "Mod+Y"],
      enabled: () => EDITING.enabled() && history.value.redo.length > 0,
      run: () => void redo(),
    },
    {
      id: "zero_joints",
      icon: "zero",
      enabled: () => EDITING.enabled() && mayMove.value && movable.value.length > 0,
      run: zeroJoints,
    },
    {
      id: "animate_joints",
      icon: "animate",
      enabled: () => EDITING.enabled() && mayMove.value && movable.value.length > 0,
      run: toggleAnimation,
    },
    {
      id: "deselect",
      icon: "close",
      keys: ["Escape"],
      // The key leaves the full screen first, as in RViz.
      enabled: () => selected.value !== null && isFree() && !fullView.value,
      run: clearSelection,
    },
    { id: "keys", icon: "keyboard", keys: ["?"], run: () => show({ kind: "keys" }) },
    ...helpCommands(),
    ...menuCommands(),
  ]);
}

/** @param {import("../model/view.js").Shown} shown */
function show(shown) {
  dialog.value = shown;
}

/** @param {KeyboardEvent} event */
function onKeyDown(event) {
  if (event.defaultPrevented || belongsToWindow(event)) return;
  if (event.key === " " && takesSpace(event.target)) return;
  const inText = takesText(event.target);
  if (onKey(event, { inText })) event.preventDefault();
  else if (!inText && matches("Mod+A", event)) selectAllOf(event);
}

/**
 * Who leaves the studio with unsaved edits, or a config file that is not saved, is asked, as by RViz. The studio keeps them, but one who
 * closes a tab may have meant to save; the way to another document of the studio asks nothing.
 */
function askBeforeLeaving() {
  const ask = (/** @type {Event} */ event) => {
    if (!isGoing()) event.preventDefault();
  };
  effect(() => {
    const edits = unsaved.value && mayEdit.value && !isCopy.value;
    if (edits || configUnsaved.value) addEventListener("beforeunload", ask);
    else removeEventListener("beforeunload", ask);
  });
}

/** @param {KeyboardEvent} event @returns {boolean} a dialog has its keys, and Escape is also that of a box with text */
function belongsToWindow({ key, target, ctrlKey, metaKey }) {
  if (dialog.value !== null) return key === "Escape" || !(ctrlKey || metaKey);
  return key === "Escape" && takesText(target);
}

/** Ctrl+A takes the text that has the focus; the labels of the page are no text. @param {KeyboardEvent} event */
function selectAllOf(event) {
  event.preventDefault();
  const text = event.target instanceof Element ? event.target.closest("pre") : null;
  if (text) getSelection()?.selectAllChildren(text);
}

function followState() {
  effect(() => {
    document.documentElement.dataset.theme = theme.value;
  });
  effect(() => {
    const mark = unsaved.value || configUnsaved.value ? "•" : "";
    document.title = [mark, title.value, title.value ? "–" : "", t("brand")]
      .filter(Boolean)
      .join(" ");
  });
}

documentId.value = documentOf(location.pathname);
await useLanguage(nearestLanguage(languageChoice.value || navigator.language));
effect(() => {
  if (languageChoice.value) useLanguage(nearestLanguage(languageChoice.value));
});
addMeasuring();
addTools();
addPageCommands();
addViewCommands();
followState();
addEventListener("keydown", onKeyDown);
askBeforeLeaving();
const root = document.getElementById("app");
if (root) render(html`<${Shell} onDock=${startDock} />`, root);
followMissing();
followDisk();
followGraphics();
followPagePart();
followPresenter();
listenToDrops();
connect(async () => {
  await watch();
  followLink();
});
