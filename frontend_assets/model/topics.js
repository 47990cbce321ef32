/**
 * The topics of the ROS 2 system and their rates, asked for again and again while a panel shows
 * them, and as rows of a table.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { TopicEnds, TopicRate, TopicRow } from "../types/wire.d.ts" */

import { effect, signal } from "vendor/preact.js";
import { includesAll, rateWords } from "../lib/live-displays.js";
import { remembered } from "../lib/remembered.js";
import { shortTime } from "../lib/times.js";
import { askedWhenChanged, polled, useTold } from "./asking.js";
import { ros } from "./ros.js";
import { isPast } from "./time.js";
import { send } from "./wire.js";

/** As they were told last; null: not yet. @type {Signal<readonly TopicRow[] | null>} */
export const topics = signal(null);
/** The topic that is looked at. @type {Signal<string | null>} */
export const chosenTopic = signal(null);
/** Names that every node has, and hidden ones, are shown. */
export const showsNoise = remembered("topics.noise", false);

/** How a topic is listened to; null: as fits its publishers. @type {Signal<import("../panels/listening-menu.js").Listening>} */
export const listening = signal({ reliable: null, latched: null });

const look = askedWhenChanged(async () => {
  topics.value = (await topicTable()) ?? topics.value;
}, "graph");

/** Keep the list up to date. @returns {() => void} the end of it */
export function followTopics() {
  const forget = effect(() => {
    if (ros.value.state === "off" && !isPast.value) topics.value = null;
  });
  const stop = look();
  return () => {
    stop();
    forget();
  };
}

async function topicTable() {
  try {
    const answer = await send({ type: "list_topics" });
    return answer.type === "topic_table" ? answer.topics : null;
  } catch {
    return null; // asked again with the next change: what is in the way says itself elsewhere
  }
}

/** @param {string} topic @returns {Promise<TopicEnds | null>} null: the studio does not answer */
export async function topicEnds(topic) {
  try {
    const answer = await send({ type: "get_topic_ends", topic });
    return answer.type === "topic_ends" ? answer : null;
  } catch {
    return null;
  }
}

const RATES_EVERY_MS = 1000;
/** As many as the studio takes at once. */
const TOPICS_MAX = 200;
/** @type {ReadonlyMap<string, TopicRate>} */
const NONE = new Map();

/** @param {readonly string[]} topics full names @returns {Promise<readonly TopicRate[]>} */
async function topicRates(topics) {
  if (topics.length === 0) return [];
  try {
    const answer = await send({
      type: "get_topic_rates",
      topics: topics.slice(0, TOPICS_MAX),
    });
    return answer.type === "topic_rates" ? answer.rates : [];
  } catch {
    return []; // asked again and again: what is in the way says itself elsewhere
  }
}

/**
 * @param {() => readonly string[]} seen names of the topics that are on the screen
 * @returns {import("vendor/preact.js").Signal<ReadonlyMap<string, TopicRate>>} by name, of those that were seen last
 */
export function useTopicRates(seen) {
  const ask = async () => new Map((await topicRates(seen())).map((one) => [one.name, one]));
  // Polled: a rate and an age are other ones with the time, also when nothing comes.
  return useTold(NONE, ask, (look) => polled(look, RATES_EVERY_MS));
}

const UNITS = /** @type {const} */ (["B/s", "kB/s", "MB/s", "GB/s"]);

/** @param {number} bytes_per_s @returns {string} of three digits at most, of thousands; empty: nothing comes */
export function bandWords(bytes_per_s) {
  if (bytes_per_s <= 0) return "";
  const step = Math.min(
    Math.max(Math.floor(Math.log10(bytes_per_s) / 3 + 1e-9), 0),
    UNITS.length - 1,
  );
  const value = bytes_per_s / 1000 ** step;
  return `${step > 0 && value < 10 ? value.toFixed(1) : Math.round(value)} ${UNITS[step]}`;
}

/** @param {TopicRate | undefined} rate @returns {string} as "30 Hz · 2.8 MB/s"; empty: too few came to tell */
export const flowWords = (rate) =>
  rate ? [rateWords(rate.rate_hz), bandWords(rate.bytes_per_s)].filter(Boolean).join(" · ") : "";

/** @param {TopicRate | undefined} rate @returns {string} since the last message; empty: none came */
export const ageWords = (rate) =>
  rate?.age_s === undefined || rate.age_s === null ? "" : shortTime(rate.age_s);

/** @typedef {"name" | "type" | "rate" | "band"} TopicOrder */

const NOISE = new Set(["/rosout", "/parameter_events"]);

/** @param {string} name @returns {boolean} every node has it, or its name says that it is hidden */
export const isNoise = (name) => NOISE.has(name) || /\/_/.test(name);

/** @param {readonly string[]} types @returns {string} as short as it tells them apart */
export const shortTypes = (types) => types.map((one) => one.replace("/msg/", "/")).join(", ");

/**
 * @param {readonly TopicRow[]} topics
 * @param {{words: string, noise: boolean, order: TopicOrder, rates: ReadonlyMap<string, TopicRate>}} wished
 * @returns {TopicRow[]}
 */
export function shownTopics(topics, { words, noise, order, rates }) {
  const found = topics.filter(
    ({ name, types }) =>
      (noise || !isNoise(name)) && includesAll([name, ...types].join(" "), words),
  );
  return found.sort((a, b) => compared(a, b, order, rates) || a.name.localeCompare(b.name));
}

/** @param {TopicRow} a @param {TopicRow} b @param {TopicOrder} order @param {ReadonlyMap<string, TopicRate>} rates @returns {number} */
function compared(a, b, order, rates) {
  if (order === "type") return (a.types[0] ?? "").localeCompare(b.types[0] ?? "");
  if (order === "name") return 0;
  const value = (/** @type {TopicRow} */ { name }) => {
    const rate = rates.get(name);
    return (order === "rate" ? rate?.rate_hz : rate?.bytes_per_s) ?? 0;
  };
  return value(b) - value(a);
}
