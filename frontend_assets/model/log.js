/**
 * The log of ROS 2 as it came to this page: asked for while a panel shows it; its levels, its
 * filter, and how it is copied.
 */

/** @import { LogLine } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal, untracked } from "vendor/preact.js";
import { askedWhenChanged, askOrKeepWhy } from "./asking.js";
import { session } from "./connection.js";
import { recordingKey } from "./time.js";

/** From the least to the gravest, with the number from which a line counts as such. */
export const LEVELS = /** @type {const} */ ({
  debug: 10,
  info: 20,
  warn: 30,
  error: 40,
  fatal: 50,
});

/** @typedef {keyof typeof LEVELS} Level */
/** @typedef {{level: Level, node: string, words: string}} Filter `node` empty: of all */

const DESCENDING = /** @type {[Level, number][]} */ (Object.entries(LEVELS)).reverse();
/** As many as the studio keeps; in pieces, so that not every line moves the others. */
const KEPT = 10_000;
const SPARE = 1_000;

/** @param {number} number of the wire @returns {Level} */
export const levelOf = (number) => DESCENDING.find(([, from]) => number >= from)?.[0] ?? "debug";

/** @param {string} logger @returns {string} its node: what stands before the first dot */
const nodeOf = (logger) => logger.split(".", 1)[0] ?? logger;

/** @param {string} path of a node @returns {string} its logger */
const loggerOf = (path) => path.replace(/^\//, "").replaceAll("/", ".");

/** @param {readonly LogLine[]} lines @param {Filter} filter @returns {readonly LogLine[]} */
export function matchingLines(lines, { level, node, words }) {
  const least = LEVELS[level];
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  // Severities below debug are shown with it.
  return lines.filter(
    (line) =>
      (line.level >= least || level === "debug") &&
      (node === "" || nodeOf(line.node) === node) &&
      wanted.every((word) => `${line.node} ${line.text}`.toLowerCase().includes(word)),
  );
}

/** @param {readonly LogLine[]} lines @param {readonly LogLine[]} news @returns {readonly LogLine[]} the newest of them */
export function withNews(lines, news) {
  const all = [...lines, ...news];
  return all.length > KEPT + SPARE ? all.slice(-KEPT) : all;
}

/** @param {readonly LogLine[]} before @param {readonly LogLine[]} now @returns {number} lines that stood above the first one and are gone */
export function goneBefore(before, now) {
  const first = now[0]?.number;
  const at = first === undefined ? -1 : before.findIndex(({ number }) => number >= first);
  return Math.max(0, at);
}

/** @param {readonly LogLine[]} lines @returns {string[]} the nodes that said something, in order */
export const nodesOf = (lines) => [...new Set(lines.map(({ node }) => nodeOf(node)))].sort();

/** @param {number} seconds since 1970 @returns {string} the time of day here, to the millisecond */
export function clockTime(seconds) {
  const date = new Date(seconds * 1000);
  const two = (/** @type {number} */ number) => String(number).padStart(2, "0");
  const clock = [date.getHours(), date.getMinutes(), date.getSeconds()].map(two).join(":");
  return `${clock}.${String(date.getMilliseconds()).padStart(3, "0")}`;
}

/** @param {readonly LogLine[]} lines @returns {string} as ROS writes them into a terminal */
export const logText = (lines) =>
  lines
    .map(
      ({ level, stamp_s, node, text }) =>
        `[${levelOf(level).toUpperCase()}] [${stamp_s.toFixed(9)}] [${node}]: ${text}`,
    )
    .join("\n");

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
export const followLog = askedWhenChanged(askLog, "log");

/** @returns {Promise<boolean>} there is more at once */
async function askLog() {
  const answer = await askOrKeepWhy({ type: "get_log", after: last }, logRefused);
  if (answer?.type !== "log") return false;
  // In the past a document has said less: what came after it is not shown.
  if (answer.last < last) return beginAnew();
  if (answer.lines.length === 0) return false;
  if (last > 0 && answer.first > last + 1) missed.value += answer.first - last - 1;
  last = answer.lines.at(-1)?.number ?? last;
  logLines.value = withNews(logLines.value, answer.lines);
  return last < answer.last;
}

/** @returns {boolean} there is more at once */
function beginAnew() {
  last = 0;
  clearLog();
  return true;
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

// A studio that was started anew counts from one, and so does another recording.
let recordingBefore = "";
effect(() => {
  session.value;
  untracked(beginAnew);
});
effect(() => {
  const { value } = recordingKey;
  if (recordingBefore !== "" && value !== recordingBefore) untracked(beginAnew);
  recordingBefore = value;
});
