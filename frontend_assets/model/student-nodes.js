/** Students' own ROS nodes: whether they may join, one's own access, and what is in one's own domain. */

/** @import { MyGraph, NodeAccess, StudentNodesState } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "./asking.js";
import { takesPart } from "./class.js";
import { ask } from "./requests.js";
import { subscribe } from "./wire.js";

const EVERY_MS = 1000;

/** Null: not told yet. @type {Signal<StudentNodesState | null>} */
export const studentNodes = signal(null);
/** Null: not asked for, or not given. @type {Signal<NodeAccess | null>} */
export const nodeAccess = signal(null);
/** @type {Signal<MyGraph | null>} */
export const myGraph = signal(null);
/** Why the studio gives no access. */
export const accessRefused = signal("");
/** Why the graph is not known. */
export const graphRefused = signal("");

export const mayJoin = computed(() => studentNodes.value?.state === "on" && takesPart.value);

subscribe("student_nodes", (event) => {
  studentNodes.value = event;
});

export const startNodes = () => ask({ type: "start_nodes" });
export const stopNodes = () => ask({ type: "stop_nodes" });

/** Ask for one's own domain: the first one to ask is given one. */
export async function askForAccess() {
  const answer = await askOrKeepWhy({ type: "get_node_access" }, accessRefused);
  nodeAccess.value = answer?.type === "node_access" ? answer : null;
}

/** What is in one's own domain, once a second while somebody looks. */
export const followMyGraph = polled(
  async () => {
    const answer = await askOrKeepWhy({ type: "get_my_graph" }, graphRefused);
    if (answer?.type === "my_graph") myGraph.value = answer;
  },
  EVERY_MS,
  () => mayJoin.value,
);
