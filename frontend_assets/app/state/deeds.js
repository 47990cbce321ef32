/** What is done in the ROS 2 system from any page, as the studio told it last. */

/** @import { Calls, CallView, Goals, GoalView, Publications, PublicationView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { withDeeds } from "../../lib/deeds.js";

/** The newest last. @type {Signal<readonly CallView[]>} */
export const calls = signal([]);

/** @type {Signal<readonly GoalView[]>} */
export const goals = signal([]);
/** @type {Signal<readonly PublicationView[]>} */
export const publications = signal([]);
/** Those that go on, so many times a second, until they are stopped. */
export const repeatedPublications = computed(() =>
  publications.value.filter(({ state, rate_hz: rate }) => state === "running" && rate > 0),
);

/** @param {Calls} event */
export function takeCalls(event) {
  calls.value = withDeeds(calls.value, event);
}

/** @param {Goals} event */
export function takeGoals(event) {
  goals.value = withDeeds(goals.value, event);
}

/** @param {Publications} event */
export function takePublications(event) {
  publications.value = withDeeds(publications.value, event);
}
