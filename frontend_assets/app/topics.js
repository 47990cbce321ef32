/** Which topics there are, asked for again and again while somebody looks. */

/** @import { TopicEnds } from "../types/wire.d.ts" */

import { effect } from "vendor/preact.js";
import { polled } from "./state/polling.js";
import { ros } from "./state/ros.js";
import { topics } from "./state/topics.js";
import { send } from "./wire.js";

const LOOK_EVERY_MS = 1000;

const look = polled(async () => {
  topics.value = (await topicTable()) ?? topics.value;
}, LOOK_EVERY_MS);

/** Keep the list up to date. @returns {() => void} the end of it */
export function followTopics() {
  const forget = effect(() => {
    if (ros.value.state === "off") topics.value = null;
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
    return null; // asked again and again: what is in the way says itself elsewhere
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
