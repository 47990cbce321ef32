/**
 * Numbers of messages over time: the series of this person, kept over reloads; one subscription
 * for each topic; the samples of the last while, and as few of them as a picture can show.
 */

/** @import { SubscriptionView, Points } from "../workers/subscriptions.js" */
/** @import { Listening } from "../panels/listening-menu.js" */

import { signal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { csvCell } from "../lib/csv.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { trace } from "./data-lane.js";
import { notify } from "./view.js";

/** @typedef {{topic: string, path: string}} Series */

export const SERIES_MAX = 16;

/** @param {any} one @returns {boolean} */
export const isSeries = (one) => typeof one?.topic === "string" && typeof one?.path === "string";

/** @type {import("vendor/preact.js").Signal<readonly Series[]>} */
export const series = remembered(
  "plot.series",
  /** @type {readonly Series[]} */ ([]),
  (value) => Array.isArray(value) && value.length <= SERIES_MAX && value.every(isSeries),
);
/** How its topics are listened to. @type {import("vendor/preact.js").Signal<import("../panels/listening-menu.js").Listening>} */
export const plotListening = signal({ reliable: null, latched: null });
/** Seconds that are seen. */
export const span_s = remembered("plot.span", 30);

/** @param {Series} one @returns {string} */
export const keyOf = ({ topic, path }) => topic + path;

/** @param {string} topic @param {string} path of a number in its messages */
export function addSeries(topic, path) {
  const one = { topic, path };
  if (series.value.some((other) => keyOf(other) === keyOf(one))) return;
  if (series.value.length >= SERIES_MAX) {
    notify(t("plot.full", { count: SERIES_MAX }), { bad: true });
    return;
  }
  series.value = [...series.value, one];
}

/** @param {string} topic @param {string} path draw it, and show where */
export function plot(topic, path) {
  addSeries(topic, path);
  commandById("panel.plot")?.run();
}

/** @param {Series} one */
export function removeSeries(one) {
  series.value = series.value.filter((other) => keyOf(other) !== keyOf(one));
}

const FIRST = 1024;
/** Ten minutes at a thousand in a second: 10 MB. */
const MOST = 600_000;
/** Two that are further apart have nothing between them. */
export const GAP_S = 2;

/** What came of one number, the oldest first; in a buffer that grows, and drops the oldest at last. */
export class Samples {
  constructor() {
    this.times = new Float64Array(FIRST);
    this.values = new Float64Array(FIRST);
    this.begin = 0;
    this.end = 0;
    /** So many came, and were numbers. */
    this.count = 0;
    /** So many came that were none. */
    this.others = 0;
  }

  /** @param {Float64Array} times s @param {Float64Array} values NaN is left out */
  add(times, values) {
    for (let n = 0; n < times.length; n += 1) {
      const value = values[n] ?? Number.NaN;
      if (Number.isNaN(value)) {
        this.others += 1;
        continue;
      }
      if (this.end === this.times.length) this.makeRoom();
      this.times[this.end] = times[n] ?? 0;
      this.values[this.end] = value;
      this.end += 1;
      this.count += 1;
    }
  }

  makeRoom() {
    const used = this.end - this.begin;
    if (used >= MOST) this.begin += MOST >> 2;
    if (this.begin > 0) {
      this.times.copyWithin(0, this.begin, this.end);
      this.values.copyWithin(0, this.begin, this.end);
      this.end -= this.begin;
      this.begin = 0;
      return;
    }
    this.times = grown(this.times);
    this.values = grown(this.values);
  }

  /** @param {number} time_s @returns {number} where the first stands that is not older */
  at(time_s) {
    let low = this.begin;
    let high = this.end;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.times[middle] ?? 0) < time_s) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** @param {number} time_s @returns {number | null} the value then; null: there was none within a while */
  valueAt(time_s) {
    const after = this.at(time_s);
    const before = after - 1;
    const apart = (/** @type {number} */ n) =>
      n >= this.begin && n < this.end
        ? Math.abs((this.times[n] ?? 0) - time_s)
        : Number.POSITIVE_INFINITY;
    const nearest = apart(after) < apart(before) ? after : before;
    return apart(nearest) <= GAP_S ? (this.values[nearest] ?? null) : null;
  }

  /** @param {number} most @returns {Float64Array} times of the last that came */
  last(most) {
    return this.times.subarray(Math.max(this.begin, this.end - most), this.end);
  }

  /** @returns {number | null} the newest value */
  newest() {
    return this.end > this.begin ? (this.values[this.end - 1] ?? null) : null;
  }
}

/** @param {Float64Array<ArrayBuffer>} array */
function grown(array) {
  const larger = new Float64Array(array.length * 2);
  larger.set(array);
  return larger;
}

/**
 * The least and the largest value of every column of pixels, in the order in which they came.
 *
 * @param {Samples} samples
 * @param {number} from_s @param {number} to_s what is seen
 * @param {number} columns
 * @returns {(number | null | undefined)[]} two for each column; undefined: none came, null: a gap is before it
 */
export function columnsOf(samples, from_s, to_s, columns) {
  /** @type {(number | null | undefined)[]} */
  const drawn = new Array(columns * 2).fill(undefined);
  const { times, values } = samples;
  const width_s = (to_s - from_s) / columns;
  const first = Math.max(samples.begin, samples.at(from_s) - 1);
  let last_s = times[first] ?? 0;
  for (let n = first; n < samples.end; n += 1) {
    const time_s = times[n] ?? 0;
    if (time_s > to_s) break;
    const column = Math.min(columns - 1, Math.max(0, Math.floor((time_s - from_s) / width_s)));
    if (time_s - last_s > GAP_S && column > 0) drawn[column * 2 - 1] ??= null;
    last_s = time_s;
    put(drawn, column * 2, values[n] ?? 0);
  }
  return drawn;
}

/** @param {(number | null | undefined)[]} drawn @param {number} at of the column @param {number} value */
function put(drawn, at, value) {
  const first = drawn[at];
  const other = drawn[at + 1];
  if (first === undefined || first === null) drawn[at] = value;
  else if (other === undefined || other === null) drawn[at + 1] = value;
  else widen(drawn, at, first, other, value);
}

/** @param {(number | null | undefined)[]} drawn @param {number} at @param {number} first @param {number} other @param {number} value */
function widen(drawn, at, first, other, value) {
  const least = Math.min(first, other);
  const largest = Math.max(first, other);
  if (value >= least && value <= largest) return;
  // What came last stands behind: the line goes on from there.
  drawn[at] = value > largest ? least : largest;
  drawn[at + 1] = value;
}

/** @param {number} columns @param {number} from_s @param {number} to_s @returns {number[]} the times of `columnsOf` */
export function columnTimes(columns, from_s, to_s) {
  const width_s = (to_s - from_s) / columns;
  return Array.from(
    { length: columns * 2 },
    (_, n) => from_s + ((n >> 1) + (n % 2 ? 0.75 : 0.25)) * width_s,
  );
}

/**
 * @param {readonly {topic: string, path: string, samples: Samples}[]} all
 * @param {number} from_s @param {number} to_s
 * @returns {string} a table of what is seen, one line for each number
 */
export function csvOf(all, from_s, to_s) {
  const lines = ["topic,path,time_s,value"];
  for (const { topic, path, samples } of all)
    for (let n = samples.at(from_s); n < samples.end && (samples.times[n] ?? 0) <= to_s; n += 1)
      lines.push(
        `${csvCell(topic)},${csvCell(path)},${samples.times[n]?.toFixed(6)},${samples.values[n]}`,
      );
  return `${lines.join("\n")}\n`;
}

/** By key. @type {Map<string, Samples>} */
const stores = new Map();
/** The subscription of each topic. @type {import("vendor/preact.js").Signal<ReadonlyMap<string, SubscriptionView>>} */
export const topicSubscriptions = signal(new Map());
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
    onState: (subscription) => {
      topicSubscriptions.value = new Map(topicSubscriptions.value).set(topic, subscription);
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
