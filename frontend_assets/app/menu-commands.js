/** What stands in menus and has no key of its own, so that the palette finds it by name, too. */

/** @import { Command } from "../lib/commands.js" */

import { address } from "../lib/address.js";
import { commandById } from "../lib/commands.js";
import { LANGUAGES, language, t } from "../lib/i18n.js";
import { documentId, mayEdit, mayManage } from "../model/connection.js";
import { unsaved } from "../model/document.js";
import { paused, pauseScene, resetScene } from "../model/live-displays.js";
import { goTo, reload } from "../model/requests.js";
import { canCompare, compareSides } from "../model/variants.js";
import { dialog, isFree, languageChoice, notify, themeChoice } from "../model/view.js";
import { classCommands } from "./control.js";
import { exportCommands } from "./export.js";
import { graphicsCommands } from "./graphics.js";
import { closeAsking, rvizCommands } from "./rviz-commands.js";
import { copyLink } from "./share.js";
import { timeCommands } from "./timeline-commands.js";

const onDocument = () => mayEdit.value && isFree() && documentId.value !== "";
const ofOwner = () => mayManage.value && isFree() && documentId.value !== "";

/** @returns {Command[]} */
export function menuCommands() {
  return [
    ...documentCommands(),
    ...classCommands(),
    ...exportCommands(),
    ...rvizCommands(),
    ...themeCommands(),
    ...graphicsCommands(),
    ...sceneCommands(),
    ...timeCommands(),
    { id: "ros", icon: "link", enabled: isFree, run: showRos },
    { id: "log_out", icon: "lock", enabled: () => mayManage.value && isFree(), run: askToLogOut },
    ...languageCommands(),
  ];
}

/** @returns {Command[]} */
function documentCommands() {
  return [
    ...openingCommands(),
    { id: "arguments", icon: "arguments", enabled: ofOwner, run: showArguments },
    { id: "copy_link", icon: "link", enabled: onDocument, run: () => void copyLink() },
    {
      id: "show_changes",
      icon: "disk",
      enabled: () => onDocument() && unsaved.value,
      run: () => {
        dialog.value = { kind: "save" };
      },
    },
    { id: "reload", icon: "reload", enabled: onDocument, run: () => void reload() },
    {
      id: "compare",
      icon: "compare",
      enabled: () => onDocument() && canCompare.value,
      run: () => compareWith({ kind: "saved", name: "" }),
    },
    { id: "close_document", icon: "close", enabled: ofOwner, run: closeAsking },
  ];
}

/** @returns {Command[]} */
function openingCommands() {
  const mayOpen = () => mayManage.value && isFree();
  /** @param {import("../model/view.js").OpenTab} tab */
  const show = (tab) => () => {
    dialog.value = { kind: "open", tab };
  };
  return [
    { id: "new_robot", icon: "filePlus", enabled: mayOpen, run: show("new") },
    { id: "new_pasted", icon: "clipboard", enabled: mayOpen, run: show("paste") },
    { id: "open_recent", icon: "history", enabled: mayOpen, run: show("recent") },
    { id: "open_example", icon: "robot", enabled: mayOpen, run: show("examples") },
    { id: "open_ros", icon: "link", enabled: mayOpen, run: show("ros") },
    {
      id: "save_as",
      icon: "disk",
      enabled: ofOwner,
      run: () => {
        dialog.value = { kind: "save_as" };
      },
    },
  ];
}

/** @returns {Command[]} what RViz's Time panel does, for all who look at the document */
function sceneCommands() {
  return [
    {
      id: "pause_scene",
      icon: "pause",
      label: () => t(paused.value ? "command.continue_scene" : "command.pause_scene"),
      enabled: onDocument,
      run: () => void pauseScene(!paused.value),
    },
    { id: "reset_scene", icon: "reset", enabled: onDocument, run: () => void resetScene() },
  ];
}

function showRos() {
  dialog.value = { kind: "ros" };
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

/** Everybody, and whoever asks for it as well. */
function askToLogOut() {
  dialog.value = {
    kind: "confirm",
    title: t("log_out"),
    text: t("log_out.text"),
    action: t("log_out.action"),
    danger: true,
    run: () => void logOut(),
  };
}

async function logOut() {
  const answer = await fetch(address("/api/log-out"), { method: "POST" }).catch(() => null);
  // Its front page turns this browser away, and says how to come back.
  if (answer?.ok) goTo("");
  else notify(t("log_out.failed"), { bad: true });
}
