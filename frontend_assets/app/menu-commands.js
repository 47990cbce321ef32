/** What stands in menus and has no key of its own, so that the palette finds it by name, too. */

/** @import { Command } from "./commands.js" */

import { LANGUAGES, language } from "../lib/i18n.js";
import { closeDocument, reload } from "./actions.js";
import { commandById } from "./commands.js";
import { copyLink } from "./share.js";
import { mayEdit } from "./state/connection.js";
import { documentId } from "./state/document.js";
import { canCompare } from "./state/variants.js";
import { dialog, isFree, languageChoice, themeChoice } from "./state/view.js";
import { compareSides } from "./variants.js";

const onDocument = () => mayEdit.value && isFree() && documentId.value !== "";

/** @returns {Command[]} */
export function menuCommands() {
  return [...documentCommands(), ...themeCommands(), ...languageCommands()];
}

/** @returns {Command[]} */
function documentCommands() {
  return [
    { id: "arguments", icon: "properties", enabled: onDocument, run: showArguments },
    { id: "copy_link", icon: "link", enabled: onDocument, run: () => void copyLink() },
    { id: "reload", icon: "reload", enabled: onDocument, run: () => void reload() },
    {
      id: "compare",
      icon: "compare",
      enabled: () => onDocument() && canCompare.value,
      run: () => compareWith({ kind: "saved", name: "" }),
    },
    { id: "close_document", icon: "close", enabled: onDocument, run: () => void closeDocument() },
  ];
}

function showArguments() {
  dialog.value = { kind: "launch", path: "" };
}

/** @param {import("../types/wire.d.ts").Side} side is compared with the robot as it is now, in the panel for it */
export function compareWith(side) {
  commandById("panel.variants")?.run();
  compareSides({ kind: "present", name: "" }, side);
}

/** @returns {Command[]} */
function themeCommands() {
  return /** @type {const} */ (["system", "dark", "light"]).map((choice) => ({
    id: `theme.${choice}`,
    icon: choice === "dark" ? "moon" : "sun",
    enabled: () => themeChoice.value !== choice,
    run: () => {
      themeChoice.value = choice;
    },
  }));
}

/** @returns {Command[]} */
function languageCommands() {
  return Object.keys(LANGUAGES).map((id) => ({
    id: `language.${id}`,
    icon: "info",
    enabled: () => language.value !== id,
    run: () => {
      languageChoice.value = id;
    },
  }));
}
