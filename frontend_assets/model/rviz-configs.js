/**
 * Config files of the 3D view, as RViz has them: the one that is open, what can be asked of it, and
 * the options that all views of the document have in common.
 */

/** @import { LossView, RvizConfigState, RvizFiles } from "../types/wire.d.ts" */
/** @import { MenuItem } from "../lib/ui.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { saveAsFile } from "../lib/files.js";
import { t } from "../lib/i18n.js";
import { latestSender } from "../lib/latest.js";
import { mayManage } from "./connection.js";
import { ask } from "./requests.js";
import { dialog, notify } from "./view.js";
import { movedByHand, viewport } from "./viewport.js";
import { currentView, useView } from "./views.js";
import { subscribe } from "./wire.js";

/** @type {RvizConfigState} */
const NONE = {
  type: "rviz_config_state",
  name: "",
  path: "",
  changed: false,
  rviz1: false,
  undo: false,
};
/** @type {Signal<RvizConfigState>} */
export const rvizConfig = signal(NONE);
/** Whether saving would change the file. The camera is this page's own, and counts for who may save it. */
export const configChanged = computed(() => {
  const { name, changed } = rvizConfig.value;
  return name !== "" && (changed || (mayManage.value && movedByHand.value));
});
/** With a dot behind it when saving would change it; empty: none is open. */
export const configName = computed(() => {
  const { name } = rvizConfig.value;
  return name && `${name}${configChanged.value ? " •" : ""}`;
});
/** Whether this person has something to save in it. */
export const configUnsaved = computed(() => mayManage.value && configChanged.value);

let isFirst = true;
let isSaving = false;
subscribe("rviz_config_state", (event) => {
  const { name, path } = rvizConfig.peek();
  const isOther = event.name !== name || event.path !== path;
  // One that this page saves elsewhere holds its view, which may have been moved since.
  if (isOther && !isSaving) movedByHand.value = false;
  rvizConfig.value = event;
  // What somebody opens later moves no one else's camera.
  if (isFirst && event.name) void begin();
  isFirst = false;
});

/** The page begins with the view of the file that is open. */
async function begin() {
  const answer = await ask({ type: "get_rviz_view" });
  if (answer?.type !== "rviz_view") return;
  const { view, page } = answer;
  if (page) pagePart.take(page);
  if (!view) return;
  const end = effect(() => {
    if (!viewport.value) return;
    viewport.value.useView(view, false);
    queueMicrotask(() => end());
  });
}

export const RVIZ = ".rviz";
export const STUDIO = ".studio.yaml";
/** Bytes; the studio reads no larger one, and ends the connection of who sends much more. */
const LARGEST = 900_000;

/** @param {string} name of a config @returns {string} without its ending */
export const configStem = (name) => name.replace(/(\.studio)?\.(rviz|yaml)$/, "");

/** @param {string} name @returns {boolean} whether a file of this name is a config */
export const isConfig = (name) => name.endsWith(RVIZ) || name.endsWith(STUDIO);

/** What is done with the page's own part of a file, and what tells it: the frame around the panels knows. */
export const pagePart = {
  /** @type {() => string} */
  told: () => "",
  /** @type {(text: string) => void} */
  take: () => {},
};

const COMMANDS = ["rviz_open", "rviz_save", "rviz_save_as", "rviz_download", "studio_download"];

/** @returns {MenuItem[]} all that can be done with configs, for a menu */
export const configItems = () =>
  [...COMMANDS, ...(rvizConfig.value.undo ? ["rviz_undo"] : [])].map((id) => {
    const command = commandById(id);
    return {
      label: `${t(`command.${id}`)}${id.endsWith("open") || id.endsWith("as") ? "…" : ""}`,
      icon: command?.icon ?? "disk",
      disabled: !command?.enabled?.(),
      run: () => command?.run(),
    };
  });

/** @param {string} path @param {{briefly?: boolean}} [options] `briefly`: a notice says so, and no window stands over what a person does @returns {Promise<boolean>} */
export async function openConfigFile(path, { briefly = false } = {}) {
  return takeOpened(await ask({ type: "open_rviz_file", path }), briefly);
}

/** @param {File} file that this browser has @returns {Promise<boolean>} */
export async function openConfigOf(file) {
  if (file.size > LARGEST) {
    notify(t("rviz.too_large", { name: file.name }), { bad: true });
    return false;
  }
  return takeOpened(
    await ask({ type: "open_rviz_text", name: file.name, text: await file.text() }),
  );
}

/** @param {import("./wire.js").Answer | null} answer @param {boolean} [briefly] @returns {boolean} */
function takeOpened(answer, briefly = false) {
  if (answer?.type !== "rviz_config_opened") return false;
  const { view, page } = answer;
  movedByHand.value = false;
  if (view) useView(view);
  if (page) pagePart.take(page);
  const show = () => {
    dialog.value = { kind: "rviz_opened", opened: answer };
  };
  if (briefly)
    notify(t("rviz.opened.title", { name: answer.name }), {
      action: { label: t("rviz.opened.more"), run: show },
    });
  else show();
  return true;
}

/** @param {string} name @returns {string} the part of the page, for files that hold it */
const partFor = (name) => (name.endsWith(STUDIO) ? pagePart.told() : "");

/**
 * @param {string} path empty: the file that is open
 * @param {{replace?: boolean, rviz2?: boolean}} [options] `rviz2`: one of RViz 1 becomes one that RViz 2 opens
 * @returns {Promise<{path: string, isThere: boolean, changed: boolean} | null>} `isThere`: it was not written, and is
 * another file, or was `changed` on disk; null: it was refused, which is said
 */
export async function saveConfig(path, { replace = false, rviz2 = false } = {}) {
  const page = partFor(path || rvizConfig.value.name);
  const view = currentView();
  // What is moved while it is written is not in it.
  const moved = movedByHand.peek();
  movedByHand.value = false;
  isSaving = true;
  const answer = await ask({
    type: "save_rviz_file",
    path,
    replace,
    page,
    rviz2,
    ...(view && { view }),
  });
  isSaving = false;
  const saved = answer?.type === "rviz_file_saved" ? answer : null;
  if (moved && (!saved || saved.is_there)) movedByHand.value = true;
  return saved && { path: saved.path, isThere: saved.is_there, changed: saved.changed };
}

/** @param {".rviz" | ".studio.yaml"} ending have the browser save it @param {{rviz2?: boolean}} [options] */
export async function downloadConfig(ending, { rviz2 = false } = {}) {
  const view = currentView();
  const page = ending === STUDIO ? pagePart.told() : "";
  const answer = await ask({ type: "get_rviz_text", page, rviz2, ...(view && { view }) });
  if (answer?.type !== "rviz_text") return;
  saveAsFile(`${configStem(answer.name)}${ending}`, answer.text, "application/yaml");
}

export const undoConfig = () => ask({ type: "undo_rviz_config" });

/** @param {string} [forget] path that is taken out of those opened lately @returns {Promise<RvizFiles | null>} */
export async function configFiles(forget) {
  const answer = await ask(
    forget ? { type: "forget_rviz_file", path: forget } : { type: "list_rviz_files" },
  );
  return answer?.type === "rviz_files" ? answer : null;
}

const backgrounds = latestSender((/** @type {string} */ background) =>
  ask({ type: "set_view_options", background }),
);

/** Of the many that a picker of colours tells the newest counts. @param {string} background as `#rrggbb`; empty: that of the theme */
export const setBackground = backgrounds.push;
/** @param {number} frame_rate pictures per second at most; 0: as many as there can be */
export const setFrameRate = (frame_rate) => ask({ type: "set_view_options", frame_rate });

/**
 * What of a file is only kept, by reason, so that each is one sentence.
 *
 * @param {readonly LossView[]} losses
 * @returns {{reason: LossView["reason"], classes: string[]}[]} classes, with their properties where these are meant
 */
export function lossGroups(losses) {
  /** @type {Map<LossView["reason"], string[]>} */
  const groups = new Map();
  for (const { reason, what, names } of losses) {
    const short = what.replace(/^(rviz_default_plugins|rviz_common|rviz)\//, "");
    const said = names.length > 0 ? `${short}: ${names.join(", ")}` : short;
    groups.set(reason, [...(groups.get(reason) ?? []), said]);
  }
  return REASONS.flatMap((reason) => {
    const classes = groups.get(reason);
    return classes ? [{ reason, classes }] : [];
  });
}

/** The most telling first. @type {LossView["reason"][]} */
const REASONS = [
  "no_display",
  "no_value",
  "no_tool",
  "no_view",
  "no_panel",
  "no_property",
  "no_option",
  "empty_group",
  "window",
];
