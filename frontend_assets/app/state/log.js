/** The log of ROS 2 as it came to this page: asked for while somebody looks, else never. */

/** @import { LogLine } from "../../types/wire.d.ts" */
/** @import { Filter } from "../../lib/log-lines.js" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal, untracked } from "vendor/preact.js";
import { loggerOf, nodeOf, withNews } from "../../lib/log-lines.js";
import { session } from "./connection.js";
import { polled } from "./polling.js";
import { askOrKeepWhy } from "./refusals.js";

const EVERY_MS = 300;

/** @type {Signal<readonly LogLine[]>} */
export const logLines = signal([]);
/** How many were gone before this page could see them. */
export const missed = signal(0);
export const logRefused = signal("");
/** What of the log is shown. @type {Signal<Filter>} */
export const logFilter = signal({ level: "info", node: "", words: "" });
/** Number of the last line that came; 0: none did. */
let last = 0;

/** Have new lines come while somebody looks; gives the end of looking. */
export const followLog = polled(askLog, EVERY_MS);

/** @returns {Promise<boolean>} there is more at once */
async function askLog() {
  const told = await askOrKeepWhy({ type: "get_log", after: last }, logRefused);
  if (told?.type !== "log" || told.lines.length === 0) return false;
  if (last > 0 && told.first > last + 1) missed.value += told.first - last - 1;
  last = told.lines.at(-1)?.number ?? last;
  logLines.value = withNews(logLines.value, told.lines);
  return last < told.last;
}

/** @param {string} node by its path: show what it says, and nothing else */
export function filterLogTo(node) {
  logFilter.value = { level: "info", node: nodeOf(loggerOf(node)), words: "" };
}

/** Show none of those that came so far, on this page. */
export function clearLog() {
  logLines.value = [];
  missed.value = 0;
}

// A studio that was started anew counts from one.
effect(() => {
  session.value;
  last = 0;
  untracked(clearLog);
});
