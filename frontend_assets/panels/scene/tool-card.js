/** The card of a tool that publishes, over the 3D view: how it is used, and its numbers by hand. */

/** @import { ToolView } from "../../types/wire.d.ts" */
/** @import { Pointed } from "../../model/tools.js" */

import { html, useSignal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { parseNumber, toDegrees } from "../../lib/numbers.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { robot } from "../../model/document.js";
import { fixedFrame } from "../../model/live-displays.js";
import { millimetres } from "../../model/tf.js";
import { isOneShot, putToolAway, toolInHand, toolValue, useTool } from "../../model/tools.js";
import { degrees } from "../../model/view.js";

export function ToolCard() {
  const tool = toolInHand.value;
  if (!tool?.publishes) return null;
  const isPoint = tool.kind === "PublishPoint";
  return html`<aside class="measure-card tool-card" aria-label=${tool.name}>
    <header><h3><${Icon} name=${tool.icon} size=${15} />${tool.name}</h3>
      <${IconButton} icon="properties" label=${t("panel.tools")} onClick=${() => commandById("panel.tools")?.run()} />
      <${IconButton} icon="close" label=${t("tool.away")} hint=${`${t("tool.away")} (Esc)`} onClick=${putToolAway} /></header>
    <p>${t(isPoint ? "tool.hint.point" : "tool.hint.pose")}</p>
    <p class="tool-target">${targetOf(tool)}</p>
    <${Numbers} key=${tool.id} tool=${tool} axes=${isPoint ? POINT : POSE} />
  </aside>`;
}

/** @param {ToolView} tool where it is sent */
function targetOf(tool) {
  const [topic, name] = ["Topic", "Action"].map((one) => String(toolValue(tool, one) ?? ""));
  return t(targetKey(tool), { topic: topic ?? "", name: name ?? "" });
}

/** @param {ToolView} tool @returns {string} the words for it */
export function targetKey(tool) {
  const sendAs = toolValue(tool, "Send as");
  if (sendAs === "Action") return "tool.to.action";
  return sendAs === "Auto" ? "tool.to.either" : "tool.to.topic";
}

const POSE = /** @type {const} */ (["x", "y", "yaw"]);
const POINT = /** @type {const} */ (["x", "y", "z"]);
/** @typedef {"x" | "y" | "z" | "yaw"} Axis */

/** @param {{tool: ToolView, axes: readonly Axis[]}} props the same without a mouse */
function Numbers({ tool, axes }) {
  const texts = useSignal(/** @type {Partial<Record<Axis, string>>} */ ({}));
  const waits = useSignal(false);
  const numbers = axes.map((axis) => numberOf(axis, texts.value[axis] ?? "0"));
  const isWhole = numbers.every((one) => one !== null);
  const frame = fixedFrame.value || (robot.value?.root ?? "");
  /** @param {Event} event */
  const send = async (event) => {
    event.preventDefault();
    if (!isWhole || waits.value) return;
    const pointed = Object.fromEntries(axes.map((axis, at) => [axis, numbers[at]]));
    waits.value = true;
    const isSent = await useTool(tool, /** @type {Pointed} */ (pointed));
    waits.value = false;
    if (isSent && isOneShot(tool)) putToolAway();
  };
  return html`<form class="tool-numbers" onSubmit=${send}>
    ${axes.map(
      (axis, at) => html`<label><span>${axis}</span>
        <input class="box number" inputmode="decimal" autocomplete="off" value=${texts.value[axis] ?? "0"} aria-invalid=${numbers[at] === null}
          aria-label=${t(`tool.number.${axis}`, { frame })} onInput=${(
            /** @type {any} */ event,
          ) => {
            texts.value = { ...texts.value, [axis]: event.currentTarget.value };
          }} /><span class="unit">${unitOf(axis)}</span></label>`,
    )}
    <button type="submit" class="button small primary" disabled=${!isWhole || waits.value}><${Icon} name="send" size=${13} />${t("tool.send")}</button>
  </form>`;
}

/** @param {Axis} axis */
function unitOf(axis) {
  if (axis === "yaw") return degrees.value ? "°" : "rad";
  return millimetres.value ? "mm" : "m";
}

/** @param {Axis} axis @param {string} text @returns {number | null} m or rad; null: it is no number */
function numberOf(axis, text) {
  const number = parseNumber(text);
  if (number === null || !Number.isFinite(number)) return null;
  if (axis === "yaw") return degrees.value ? number / toDegrees(1) : number;
  return millimetres.value ? number / 1000 : number;
}
