/**
 * Calls, goals and publications: which services and actions there are, what was begun from any
 * page, its state, and how it is begun and ended.
 */

/** @import { CallView, Command, FollowOperations, GoalView, OfferView, PublicationView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Asked } from "./wire.js" */
/** @import { MessageForm } from "./message-forms.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { askedWhenChanged, askOrKeepWhy, sharedFollowing } from "./asking.js";
import { connection } from "./connection.js";
import { callTimeout, goalForm, publishForm, publishing, serviceForm } from "./message-forms.js";
import { ask } from "./requests.js";
import { send, subscribe } from "./wire.js";

/** @typedef {{operation: number, feedback?: readonly {number: number}[]}} Operation */

const KEPT = 80;
const FEEDBACK_KEPT = 50;
/** Services that every node has, and the parts of actions. */
const NOISE =
  /\/_|\/(get_parameters|get_parameter_types|set_parameters|set_parameters_atomically|describe_parameters|list_parameters|get_type_description|get_logger_levels|set_logger_levels)$/;

/**
 * @template {Operation} T
 * @param {readonly T[]} known
 * @param {{whole: boolean, operations: readonly T[]}} news
 * @returns {readonly T[]} by their numbers, the newest last
 */
export function withOperations(known, { whole, operations }) {
  if (whole) return operations;
  const byNumber = new Map(known.map((one) => [one.operation, one]));
  for (const one of operations)
    byNumber.set(one.operation, merged(byNumber.get(one.operation), one));
  return [...byNumber.values()].sort((a, b) => a.operation - b.operation).slice(-KEPT);
}

/**
 * @template {Operation} T
 * @param {T | undefined} before @param {T} now whose feedback is only what is new
 * @returns {T}
 */
function merged(before, now) {
  if (!now.feedback) return now;
  const first = now.feedback[0]?.number ?? Number.POSITIVE_INFINITY;
  const kept = (before?.feedback ?? []).filter(({ number }) => number < first);
  return { ...now, feedback: [...kept, ...now.feedback].slice(-FEEDBACK_KEPT) };
}

/**
 * @param {readonly OfferView[]} offers
 * @param {string} filter words that are part of a name, a type or a node
 * @param {boolean} all also what every node serves
 */
export function matchingOffers(offers, filter, all) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  return offers.filter(({ name, types, nodes }) => {
    if (!all && NOISE.test(name)) return false;
    const text = [name, ...types, ...nodes].join(" ").toLowerCase();
    return words.every((word) => text.includes(word));
  });
}

/** @param {number} seconds @returns {string} how long something took */
export function tookText(seconds) {
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  return seconds < 100 ? `${seconds.toFixed(1)} s` : `${Math.round(seconds)} s`;
}

/** @param {string} json @returns {unknown} undefined: there is none */
export const plainOf = (json) => (json ? JSON.parse(json) : undefined);

const GOAL_OVER = new Set(["succeeded", "canceled", "aborted", "rejected", "failed"]);

/** @param {{state: string}} goal */
export const isGoalOver = ({ state }) => GOAL_OVER.has(state);

/**
 * @param {string} actionType @param {unknown} result
 * @returns {number | null} rad that turtlesim's turtle turned, to the left: its server tells them from the end back to the start
 */
export function turnedRad(actionType, result) {
  if (actionType !== "turtlesim/action/RotateAbsolute") return null;
  const delta = /** @type {{delta?: unknown} | undefined} */ (result)?.delta;
  return typeof delta === "number" ? -delta : null;
}

/** @param {unknown} value @returns {string} plain values on one line */
export function shortOf(value) {
  if (typeof value !== "object" || value === null) return String(value);
  if (Array.isArray(value)) return `[${value.map(shortOf).join(", ")}]`;
  const inner = Object.entries(value).map(([key, one]) => {
    const text = shortOf(one);
    return typeof one === "object" && one !== null && !Array.isArray(one)
      ? `${key}: {${text}}`
      : `${key}: ${text}`;
  });
  return inner.join(", ");
}

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

subscribe("calls", (event) => {
  calls.value = withOperations(calls.value, event);
});

subscribe("goals", (event) => {
  goals.value = withOperations(goals.value, event);
});

subscribe("publications", (event) => {
  publications.value = withOperations(publications.value, event);
});

/** @type {Record<FollowOperations["operations"], () => () => void>} */
const FOLLOW = {
  calls: follower("calls"),
  goals: follower("goals"),
  publications: follower("publications"),
};

/** Be told of a kind of operations; gives the end of it. @param {FollowOperations["operations"]} operations */
export const followOperations = (operations) => FOLLOW[operations]();

/** @param {FollowOperations["operations"]} operations */
function follower(operations) {
  return sharedFollowing(() => {
    const tell = (/** @type {boolean} */ following) =>
      // What is in the way is seen by the page itself: a new lane begins anew.
      void send({ type: "follow_operations", operations, following }).catch(() => {});
    const end = effect(() => {
      if (connection.value === "connected") tell(true);
    });
    return () => {
      end();
      tell(false);
    };
  });
}

/** @param {MessageForm} form @param {Asked<Command>} command @returns {Promise<number>} the operation's number; 0: it was refused */
async function begin(form, command) {
  const answer = await askOrKeepWhy(command, form.trouble);
  return answer?.type === "begun" ? answer.operation : 0;
}

/** Call the service that is chosen, with what its form says. */
export function callService() {
  const { name = "", type = "" } = serviceForm.chosen.value ?? {};
  return begin(serviceForm, {
    type: "call_service",
    name,
    service_type: type,
    text: serviceForm.yaml(),
    timeout_s: callTimeout.value,
  });
}

/** @param {number} operation */
export const cancelCall = (operation) => ask({ type: "cancel_call", operation });

/** Send a goal to the action that is chosen. */
export function sendGoal() {
  const { name = "", type = "" } = goalForm.chosen.value ?? {};
  return begin(goalForm, { type: "send_goal", name, action_type: type, text: goalForm.yaml() });
}

/** @param {number} operation */
export const cancelGoal = (operation) => ask({ type: "cancel_goal", operation });

/** @param {{once: boolean}} how publish on the topic that is chosen */
export function publish({ once }) {
  const { name = "", type = "" } = publishForm.chosen.value ?? {};
  const { rate_hz: rate, ...quality } = publishing.value;
  return begin(publishForm, {
    ...{ type: "publish", name, message_type: type, text: publishForm.yaml() },
    ...{ ...quality, rate_hz: once ? 0 : rate },
  });
}

/** @param {number} [operation] without one: all */
export const stopPublishing = (operation = 0) => ask({ type: "stop_publishing", operation });

/** Null: not known yet. @type {Signal<readonly OfferView[] | null>} */
export const services = signal(null);
/** @type {Signal<readonly OfferView[] | null>} */
export const actions = signal(null);
export const offersRefused = signal("");

/** Ask now. */
export async function askServices() {
  const answer = await askOrKeepWhy({ type: "get_services" }, offersRefused);
  if (answer?.type === "services") services.value = answer.services;
}
export const followServices = askedWhenChanged(askServices, "graph");

/** Ask now. */
export async function askActions() {
  const answer = await askOrKeepWhy({ type: "get_actions" }, offersRefused);
  if (answer?.type === "actions") actions.value = answer.actions;
}
export const followActions = askedWhenChanged(askActions, "graph");
