/** RViz's Time panel: ROS time and that of the machine, how long both have run, pause and reset. */

/** @import { SceneTime } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, html, signal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { language, t } from "../../lib/i18n.js";
import { EmptyState, Icon, ProgressBar } from "../../lib/ui.js";
import { polled, useLooking } from "../../model/asking.js";
import { documentId, mayEdit } from "../../model/connection.js";
import { paused } from "../../model/live-displays.js";
import { send } from "../../model/wire.js";
import { onResetKey } from "../parts.js";

/** Beginning with this time it counts from 1970, and not from the start of a simulation. */
const EPOCH_FROM_S = 1e9;

/** As fast as hundredths can be read at all. */
const EVERY_MS = 100;

/** As the studio told it last; null: not yet. @type {Signal<SceneTime | null>} */
const sceneTime = signal(null);

effect(() => {
  documentId.value;
  sceneTime.value = null;
});

async function askForTime() {
  try {
    const answer = await send({ type: "get_scene_time" });
    if (answer.type === "scene_time") sceneTime.value = answer;
  } catch {
    // The next question comes in a moment; that the studio is away says itself.
  }
}

/** Begin to look at it; gives the end of looking. */
const followTime = polled(askForTime, EVERY_MS, () => documentId.value !== "");

export function TimePanel() {
  const { panel } = useLooking(followTime);
  return html`<section ref=${panel} class="panel-body time-panel" aria-label=${t("panel.time")} onKeyDown=${onResetKey}>
    ${documentId.value === "" ? html`<${EmptyState} icon="time" title=${t("urdf.none")} />` : html`<${Clocks} />`}
  </section>`;
}

function Clocks() {
  const now = sceneTime.value;
  if (!now) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const source = now.from_clock ? t("time.from_clock") : t("time.from_machine");
  return html`<div class="time-buttons">
      <${PauseButton} />
      <button type="button" class="button" disabled=${!mayEdit.value} title=${hintOf("time.reset.hint")}
        onClick=${() => commandById("reset_scene")?.run()}><${Icon} name="reset" />${t("time.reset")}</button>
    </div>
    <dl class="time-rows">
      <${Clock} name="ros" value=${now.ros_s} hint=${dateWords(now.ros_s)} />
      <${Clock} name="ros_elapsed" value=${now.ros_elapsed_s} />
      <${Clock} name="wall" value=${now.wall_s} hint=${dateWords(now.wall_s)} />
      <${Clock} name="wall_elapsed" value=${now.wall_elapsed_s} />
    </dl>
    <p class="note time-source">${paused.value ? t("time.stands") : source}</p>`;
}

/** @param {{name: string, value: number, hint?: string}} props seconds, with as many places as RViz shows */
function Clock({ name, value, hint = "" }) {
  return html`<div class="time-row"><dt>${t(`time.${name}`)}</dt>
    <dd class="numbers" title=${hint}><span data-clock=${name}>${timeText(value)}</span> <span class="unit">s</span></dd></div>`;
}

/** @param {number} seconds @returns {string} as RViz writes it */
export const timeText = (seconds) => seconds.toFixed(2);

/** @param {number} seconds @returns {string} the day and the hour; empty for the time of a simulation that begins at 0 */
export function dateWords(seconds) {
  if (seconds < EPOCH_FROM_S) return "";
  return new Date(seconds * 1000).toLocaleString(language.value);
}

function PauseButton() {
  const on = paused.value;
  return html`<button type="button" class="button" aria-pressed=${on} disabled=${!mayEdit.value} title=${hintOf("time.pause.hint")}
    onClick=${() => commandById("pause_scene")?.run()}><${Icon} name=${on ? "animate" : "pause"} />${t(on ? "time.continue" : "time.pause")}</button>`;
}

/** @param {string} words @returns {string} or that it is for somebody else to do */
const hintOf = (words) => t(mayEdit.value ? words : "display.shared");
