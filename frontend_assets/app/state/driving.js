/** How a robot is driven by hand from this page: where to, how fast at most, and what is held now. */

/** @import { Deflection, Limits } from "../../lib/driving.js" */
/** @import { TopicRow } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { drivable } from "../../lib/driving.js";
import { remembered } from "../../lib/remembered.js";
import { polled } from "./polling.js";
import { askOrKeepWhy } from "./refusals.js";

const EVERY_MS = 2000;
const ANYWAY = { name: "/cmd_vel", stamped: false };

/** @type {Signal<readonly TopicRow[]>} */
const topics = signal([]);
export const drivingRefused = signal("");
/** What a person wrote for the topic; null: the first that fits. @type {Signal<{name: string, stamped: boolean} | null>} */
export const chosenDrive = signal(null);
export const driveTopics = computed(() => drivable(topics.value));
/** Where speeds go. */
export const driveTarget = computed(() => chosenDrive.value ?? driveTopics.value[0] ?? ANYWAY);

/** @type {Signal<Limits & {rate: number}>} */
export const driveLimits = remembered(
  "teleop",
  { linear: 0.5, angular: 1, sideways: false, rate: 20 },
  isLimits,
);
/** What each hand holds, by where it does. @type {Signal<ReadonlyMap<string, Deflection>>} */
export const held = signal(new Map());

/** @param {unknown} stored @returns {boolean} */
function isLimits(stored) {
  if (typeof stored !== "object" || stored === null) return false;
  const { linear, angular, sideways, rate } = /** @type {Record<string, unknown>} */ (stored);
  return (
    [linear, angular, rate].every((one) => typeof one === "number" && one > 0 && one <= 100) &&
    typeof sideways === "boolean"
  );
}

async function askTopics() {
  const told = await askOrKeepWhy({ type: "list_topics" }, signal(""));
  if (told?.type === "topic_table") topics.value = told.topics;
}
/** Know the topics that take speeds while somebody looks; gives the end of looking. */
export const followDrivable = polled(askTopics, EVERY_MS);
