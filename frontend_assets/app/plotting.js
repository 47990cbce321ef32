/** What is drawn over time as it comes: one trace for each topic, samples for each number of it. */

/** @import { Heard, Points } from "../workers/subscriptions.js" */
/** @import { Listening } from "./listening-menu.js" */
/** @import { Series } from "./state/plot.js" */

import { signal } from "vendor/preact.js";
import { Samples } from "../lib/samples.js";
import { trace } from "./data.js";
import { keyOf } from "./state/plot.js";

/** By key. @type {Map<string, Samples>} */
const stores = new Map();
/** How each topic is heard. @type {import("vendor/preact.js").Signal<ReadonlyMap<string, Heard>>} */
export const heardTopics = signal(new Map());
/** What cannot be read of a topic, in a sentence. @type {import("vendor/preact.js").Signal<ReadonlyMap<string, string>>} */
export const unreadTopics = signal(new Map());

/** @type {Map<string, {paths: string, way: Listening, handle: ReturnType<typeof trace>}>} by topic */
const traces = new Map();
/** How far the studio's clock is ahead of this page's. */
let ahead_s = Number.NaN;
const JUMP_S = 2;

/** @param {Series} one @returns {Samples} */
export function samplesOf(one) {
  const key = keyOf(one);
  const found = stores.get(key) ?? new Samples();
  stores.set(key, found);
  return found;
}

/** @returns {number} the time now, by the clock of the samples; NaN: none came yet */
export const nowOfSamples = () => performance.now() / 1000 + ahead_s;

/** @param {readonly Series[]} wished hear these, and no others @param {Listening} way */
export function followSeries(wished, way) {
  /** @type {Map<string, string[]>} */
  const byTopic = new Map();
  for (const { topic, path } of wished) byTopic.set(topic, [...(byTopic.get(topic) ?? []), path]);
  for (const [topic, { handle, way: before }] of traces)
    if (!byTopic.has(topic) || before !== way) {
      handle.leave();
      traces.delete(topic);
    }
  for (const [topic, paths] of byTopic) follow(topic, paths, way);
}

/** @param {readonly Series[]} kept what is drawn: of the rest nothing is kept */
export function forgetOthers(kept) {
  const keys = new Set(kept.map(keyOf));
  for (const key of stores.keys()) if (!keys.has(key)) stores.delete(key);
}

/** @param {string} topic @param {readonly string[]} paths @param {Listening} way */
function follow(topic, paths, way) {
  const before = traces.get(topic);
  const names = paths.join("\n");
  if (before?.paths === names) return;
  before?.handle.choose(paths);
  const handle = before?.handle ?? begin(topic, paths, way);
  traces.set(topic, { paths: names, way, handle });
}

/** @param {string} topic @param {readonly string[]} paths @param {Listening} way */
const begin = (topic, paths, way) =>
  trace(topic, paths, way, {
    onState: (heard) => {
      heardTopics.value = new Map(heardTopics.value).set(topic, heard);
    },
    onPoints: (points) => take(topic, points),
  });

/** @param {string} topic @param {Points} points */
function take(topic, { times, values, paths, trouble }) {
  const newest_s = times.at(-1);
  if (newest_s !== undefined) keepTime(newest_s - performance.now() / 1000);
  paths.forEach((path, n) => {
    const column = values[n];
    if (column) stores.get(keyOf({ topic, path }))?.add(times, column);
  });
  if ((unreadTopics.value.get(topic) ?? "") !== trouble)
    unreadTopics.value = new Map(unreadTopics.value).set(topic, trouble);
}

/** What came without delay tells how the clocks stand. @param {number} difference_s */
function keepTime(difference_s) {
  const jumped = !(Math.abs(difference_s - ahead_s) < JUMP_S);
  ahead_s = jumped ? difference_s : Math.max(ahead_s - 1e-4, difference_s);
}
