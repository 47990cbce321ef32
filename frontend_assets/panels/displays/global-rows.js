/** What concerns all displays, on top as in RViz: global options, global status, and Reset. */

/** @import { Row } from "./tree.js" */

import { html } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { inFrameOrder } from "../../lib/frame-tree.js";
import { t } from "../../lib/i18n.js";
import { parseNumber } from "../../lib/numbers.js";
import { PickBox } from "../../lib/pick-box.js";
import { TextBox } from "../../lib/slider.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { robot } from "../../model/document.js";
import {
  background,
  fixedFrame,
  fixedFrameState,
  frameRate,
  framesNow,
  frameTrouble,
  setFixedFrame,
} from "../../model/live-displays.js";
import {
  configItems,
  configName,
  rvizConfig,
  setBackground,
  setFrameRate,
} from "../../model/rviz-configs.js";
import { levelIcon, levelWords } from "./live-rows.js";

/** @param {string} filter @param {ReadonlySet<string>} closed rows that are folded @returns {Row[]} */
export function globalRows(filter, closed) {
  if (!robot.value) return [];
  const words = filter.trim().toLowerCase();
  const options = optionRows().filter(({ label }) => label.toLowerCase().includes(words));
  const isMeant = options.length > 0 || t("display.global").toLowerCase().includes(words);
  const open = words !== "" || !closed.has("global");
  /** @type {Row} */
  const head = {
    id: "global",
    level: 1,
    label: t("display.global"),
    icon: "settings",
    expandable: true,
    expanded: open,
    meta: open ? "" : fixedFrame.value || (robot.value?.root ?? ""),
  };
  return isMeant ? [head, ...(open ? options : []), ...statusRows(closed)] : [];
}

/** @returns {Row[]} one for each option */
function optionRows() {
  const choices = async () => [
    { label: t("live.fixed_frame.robot"), value: "" },
    ...inFrameOrder((await framesNow()).map(({ name }) => name)),
  ];
  return [
    {
      id: "global:fixed_frame",
      level: 2,
      label: t("live.fixed_frame.label"),
      icon: "",
      kind: "setting",
      help: { title: t("live.fixed_frame.label"), text: t("display.global.fixed_frame.help") },
      controls:
        () => html`<${PickBox} label=${t("display.global.fixed_frame")} text=${fixedFrame.value}
        placeholder=${t("live.fixed_frame.placeholder")} disabled=${!mayEdit.value} choices=${choices}
        onWrite=${(/** @type {string} */ frame) => void setFixedFrame(frame)} />`,
    },
    optionRow(
      "background",
      () => html`<${Background} />`,
      [t("display.global.of_theme"), background.value].filter(Boolean).join(", "),
    ),
    optionRow(
      "frame_rate",
      () => html`<${TextBox} class="number narrow" label=${t("display.global.frame_rate")}
        text=${String(frameRate.value)} number=${frameRate.value} step=${1}
        disabled=${!mayEdit.value} onWrite=${(/** @type {string} */ typed) => {
          const hz = Math.round(parseNumber(typed) ?? 0);
          setFrameRate(Math.min(Math.max(hz, 0), FRAME_RATE_MOST));
        }} />`,
    ),
    optionRow("config", () => html`<${ConfigControls} />`, configText()),
  ];
}

/** @param {"background" | "frame_rate" | "config"} name @param {() => import("vendor/preact.js").ComponentChildren} controls @param {string} [value] that they show @returns {Row} */
const optionRow = (name, controls, value = "") => ({
  id: `global:${name}`,
  level: 2,
  label: t(`display.global.${name}`),
  icon: "",
  kind: "setting",
  help: { title: t(`display.global.${name}`), text: t(`display.global.${name}.help`) },
  controls,
  value,
});

/** RViz's first background, which the choice of another begins with. */
const RVIZ_BACKGROUND = "#303030";
const FRAME_RATE_MOST = 240;

/** The colour behind the 3D view, or that of the theme. */
function Background() {
  const colour = background.value;
  const label = t("display.global.background");
  return html`<input type="color" class="colour" aria-label=${label} title=${colour || t("display.global.of_theme")} value=${colour || RVIZ_BACKGROUND}
      disabled=${!mayEdit.value} onInput=${(/** @type {any} */ event) => setBackground(event.currentTarget.value)} />
    <button type="button" class="button small" aria-pressed=${colour === ""} disabled=${!mayEdit.value}
      onClick=${() => setBackground("")}>${t("display.global.of_theme")}</button>`;
}

/** The name of the config file that is open. */
const configText = () => configName.value || t("display.global.config.none");

/** The config file that is open, with a dot when it is not saved, and what can be done with it. */
function ConfigControls() {
  const name = configText();
  return html`<${MenuButton} class="config-name" label=${t("display.global.config.menu")} value=${name} hint=${rvizConfig.value.path || name} items=${configItems}>
    <span class="config-text">${name}</span><${Icon} name="chevronDown" size=${12} /><//>`;
}

/** @param {ReadonlySet<string>} closed @returns {Row[]} whether there is a fixed frame, as RViz's global status has it */
function statusRows(closed) {
  const { level, frame, sentence } = fixedFrameState.value;
  const open = level !== "ok" && !closed.has("global_status");
  /** @type {Row} */
  const head = {
    id: "global_status",
    level: 1,
    label: t("display.global_status", { level: levelWords(level) }),
    icon: levelIcon(level),
    kind: `status level-${level}`,
    expandable: level !== "ok",
    expanded: open,
    meta: open ? "" : level === "ok" ? "" : frame,
  };
  if (!open) return [head];
  return [head, noteRow("global_status:fixed_frame", level, t("live.fixed_frame.label"), sentence)];
}

/** @param {string} id @param {"ok" | "warn" | "error"} level @param {string} title @param {string} sentence @returns {Row} */
function noteRow(id, level, title, sentence) {
  const name = () => html`<span class="live-remark">
    <span><strong>${title}:</strong> ${sentence}</span>
    ${
      mayEdit.value &&
      fixedFrame.value !== "" &&
      html`<button type="button" class="button small" onClick=${() => void setFixedFrame("")}>${t("display.global.mend")}</button>`
    }</span>`;
  return {
    id,
    level: 2,
    label: `${title}: ${sentence}`,
    icon: levelIcon(level),
    kind: `tree-note ${level}`,
    name,
  };
}

/** @returns {Row[]} why the robot has no place in the fixed frame; none: it has one */
export function robotTrouble() {
  const trouble = frameTrouble.value;
  return trouble ? [noteRow("robot:transform", "error", t("live.status.transform"), trouble)] : [];
}

/** Has everything that was received be forgotten. */
export function ResetButton() {
  const label = t("command.reset_scene");
  return html`<${IconButton} icon="reset" label=${label} hint=${mayEdit.value ? t("live.reset.hint") : t("display.shared")}
    disabled=${!mayEdit.value} onClick=${() => commandById("reset_scene")?.run()} />`;
}
