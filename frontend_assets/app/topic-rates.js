/** How topics come that are seen: asked for every second, so that the studio hears no others. */

/** @import { TopicRate } from "../types/wire.d.ts" */

import { useTold } from "./looking.js";
import { send } from "./wire.js";

const LOOK_EVERY_MS = 1000;
/** As many as the studio takes at once. */
const TOPICS_MAX = 200;
/** @type {ReadonlyMap<string, TopicRate>} */
const NONE = new Map();

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
  const ask = async () => new Map((await topicRates(seen())).map((one) => [one.name, one]));
  return useTold(NONE, ask, LOOK_EVERY_MS);
}
