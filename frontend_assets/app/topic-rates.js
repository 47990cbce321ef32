/** How topics come that are seen: asked for every second, so that the studio hears no others. */

/** @import { TopicRate } from "../types/wire.d.ts" */

import { useEffect, useSignal } from "vendor/preact.js";
import { keepAsking } from "../lib/asking.js";
import { send } from "./wire.js";

const LOOK_EVERY_MS = 1000;
/** As many as the studio takes at once. */
const TOPICS_MAX = 200;

/** @param {readonly string[]} topics full names @returns {Promise<readonly TopicRate[]>} */
export async function topicRates(topics) {
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
  const rates = useSignal(/** @type {ReadonlyMap<string, TopicRate>} */ (new Map()));
  const take = (/** @type {readonly TopicRate[]} */ found) => {
    rates.value = new Map(found.map((one) => [one.name, one]));
  };
  useEffect(() => keepAsking(() => topicRates(seen()), take, LOOK_EVERY_MS), []);
  return rates;
}
