/** How all goals of one action stand, also those of others: asked again and again while somebody looks. */

/** @import { GoalStatusView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "../../model/asking.js";

const EVERY_MS = 1000;

/** The newest first. @type {Signal<readonly GoalStatusView[]>} */
export const goalStatuses = signal([]);
const refused = signal("");
let action = "";

const follow = polled(async () => {
  const name = action;
  const told = await askOrKeepWhy({ type: "get_goal_statuses", name }, refused);
  if (told?.type === "goal_statuses" && name === action) goalStatuses.value = told.goals;
}, EVERY_MS);

/** @param {string} name of the action @returns {() => void} the end of looking */
export function followStatuses(name) {
  action = name;
  goalStatuses.value = [];
  return follow();
}
