/** Who is there in the ROS 2 system, and who speaks with whom: asked for while somebody looks. */

/** @import { GraphAnswer } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "../../model/asking.js";
import { session } from "../../model/connection.js";

const EVERY_MS = 700;

/** @typedef {Pick<GraphAnswer, "version" | "nodes" | "links" | "other_count" | "more">} Graph */

/** @type {Graph} */
const NOBODY = { version: -1, nodes: [], links: [], other_count: 0, more: 0 };

/** @type {Signal<Graph>} */
export const graph = signal(NOBODY);
export const graphRefused = signal("");

/** Keep it true while somebody looks; gives the end of looking. */
export const followGraph = polled(async () => {
  const known = graph.peek().version;
  const told = await askOrKeepWhy({ type: "get_graph", known }, graphRefused);
  if (told?.type === "graph" && told.version !== known) graph.value = told;
}, EVERY_MS);

// A studio that was started anew counts from the beginning.
effect(() => {
  session.value;
  graph.value = NOBODY;
});
