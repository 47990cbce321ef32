/**
 * The nodes that have parameters, and the parameters of one of them: followed while a panel shows
 * them.
 */

/** @import { ParameterView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { askedWhenChanged, askOrKeepWhy, sharedFollowing } from "./asking.js";
import { connection } from "./connection.js";
import { ros } from "./ros.js";
import { send, subscribe } from "./wire.js";

/** Full name; empty: none is looked at. */
export const chosenNode = signal("");
/** Of that node; null: not known yet. @type {Signal<readonly ParameterView[] | null>} */
export const parameters = signal(null);
/** Why a node did not set a parameter at last, by name. @type {Signal<ReadonlyMap<string, string>>} */
export const setRefused = signal(new Map());

subscribe("parameters_changed", ({ node, parameters: changed, gone }) => {
  const known = parameters.value;
  if (node !== chosenNode.value || !known) return;
  const byName = new Map(known.map((one) => [one.name, one]));
  for (const { name, value, value_type } of changed) {
    const before = byName.get(name);
    byName.set(
      name,
      before ? { ...before, value, value_type } : { ...bare(name), value, value_type },
    );
  }
  for (const name of gone) byName.delete(name);
  parameters.value = [...byName.values()].sort((a, b) => (a.name < b.name ? -1 : 1));
});

/** @param {string} name @returns {ParameterView} of which nothing is known */
const bare = (name) => ({
  ...{ name, value_type: "", value: "null", description: "", read_only: false },
  ...{ constraints: "", low: null, high: null, step: 0 },
});

/** Null: not known yet. @type {Signal<readonly string[] | null>} */
export const parameterNodes = signal(null);
export const nodesRefused = signal("");
/** Why the parameters of the node were not told at last. */
export const parametersRefused = signal("");

/** Ask now. */
export async function askNodes() {
  const answer = await askOrKeepWhy({ type: "get_parameter_nodes" }, nodesRefused);
  if (answer?.type === "parameter_nodes") parameterNodes.value = answer.nodes;
}
export const followNodes = askedWhenChanged(askNodes, "graph");

/** Ask now for all of the node. */
export async function askParameters() {
  const node = chosenNode.peek();
  if (node === "") return;
  const answer = await askOrKeepWhy({ type: "get_parameters", node }, parametersRefused);
  if (answer?.type === "parameters" && node === chosenNode.peek())
    parameters.value = answer.parameters;
}

const isJoined = computed(() => ros.value.state === "connected");

/** Be told of the node that is chosen, and of what changes in it; gives the end of it. */
export const followParameters = sharedFollowing(() => {
  const tell = (/** @type {string} */ node) =>
    // What is in the way is seen by the page itself: a new lane begins anew.
    void send({ type: "follow_parameters", node }).catch(() => {});
  const end = effect(() => {
    // Whoever is connected anew hears nothing of what was asked for before.
    if (connection.value !== "connected" || !isJoined.value) return;
    tell(chosenNode.value);
    untracked(askParameters);
  });
  return () => {
    end();
    tell("");
  };
});

/** @param {string} node full name; empty: none */
export function chooseNode(node) {
  parameters.value = null;
  [setRefused.value, parametersRefused.value] = [new Map(), ""];
  chosenNode.value = node;
}

/**
 * @param {string} name
 * @param {string} text of the value
 * @param {string} valueType as it is now
 */
export async function setParameter(name, text, valueType) {
  const node = chosenNode.peek();
  const refused = signal("");
  await askOrKeepWhy({ type: "set_parameter", node, name, text, value_type: valueType }, refused);
  if (node !== chosenNode.peek()) return;
  const left = new Map(setRefused.value);
  if (refused.value) left.set(name, refused.value);
  else left.delete(name);
  setRefused.value = left;
  await askParameters();
}
