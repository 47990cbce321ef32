/** The goal that a robot drives to now, over the 3D view: how far it is, and the way to cancel it. */

/** @import { GoalView } from "../../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { lengthText } from "../../model/measuring.js";
import {
  cancelGoal,
  followOperations,
  goals,
  isGoalOver,
  plainOf,
} from "../../model/operations.js";
import { millimetres } from "../../model/tf.js";

const NAVIGATE = "nav2_msgs/action/NavigateToPose";

export function NavigationGoal() {
  const dismissed = useSignal(0);
  useEffect(() => followOperations("goals"), []);
  const goal = goals.value.filter((one) => one.action_type === NAVIGATE).at(-1);
  if (!goal || goal.operation === dismissed.value) return null;
  const isOver = isGoalOver(goal);
  const isBad = ["aborted", "rejected", "failed"].includes(goal.state);
  return html`<div class=${`scene-hint navigation-goal ${isBad ? "bad" : ""}`} role="status"><${Icon} name=${isBad ? "error" : "goal"} size=${15} />
    <span>${t(`navigation.${goal.state}`, { name: goal.name })}${goal.trouble ? ` ${goal.trouble}` : ""}</span>
    ${!isOver && html`<span class="numbers">${progressOf(goal)}</span>`}
    ${
      isOver
        ? html`<${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${() => {
            dismissed.value = goal.operation;
          }} />`
        : html`<button type="button" class="text-button" disabled=${!mayAct.value || goal.state === "canceling"}
            onClick=${() => void cancelGoal(goal.operation)}>${t("navigation.cancel")}</button>`
    }</div>`;
}

/** @param {GoalView} goal @returns {string} what its newest feedback says */
export function progressOf({ feedback }) {
  const newest = feedback.at(-1);
  const values = /** @type {any} */ (newest ? plainOf(newest.values) : {});
  const { distance_remaining: distance, number_of_recoveries: recoveries } = values ?? {};
  const parts = [];
  if (typeof distance === "number")
    parts.push(
      t("navigation.distance", {
        distance: lengthText(distance, { millimetres: millimetres.value, degrees: false }),
      }),
    );
  const seconds = secondsOf(values?.navigation_time);
  if (seconds !== null) parts.push(t("navigation.time", { seconds: Math.round(seconds) }));
  if (recoveries > 0) parts.push(t("navigation.recoveries", { count: recoveries }));
  return parts.join(" · ");
}

/** @param {unknown} duration a builtin_interfaces/Duration @returns {number | null} */
function secondsOf(duration) {
  const { sec, nanosec } = /** @type {{sec?: unknown, nanosec?: unknown}} */ (duration ?? {});
  return typeof sec === "number" && typeof nanosec === "number" ? sec + nanosec / 1e9 : null;
}
