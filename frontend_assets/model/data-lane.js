/**
 * The data lane as panels use it: topics are subscribed as messages, numbers or pictures, in a
 * worker.
 */

/** @import { FromPage } from "../workers/data.js" */
/** @import { PictureAsked, Pictured, PictureToPage, SavedPicture } from "../workers/pictures.js" */
/** @import { Heard, Looked, Points, ToPage } from "../workers/subscriptions.js" */

import { effect, signal } from "vendor/preact.js";
import { connection } from "./connection.js";
import { typeOf, whenTypesChange } from "./interfaces.js";

/** @typedef {{reliable?: boolean | null, latched?: boolean | null, depth?: number | null, typeName?: string, mostHz?: number, pace?: "tick" | "at_once"}} Ways null: as fits its publishers; at once: between two ticks, for what somebody waits for */
/** @typedef {{onState: (heard: Heard) => void, onMessage: (message: Looked) => void}} Onlooker */
/** @typedef {{onState: (heard: Heard) => void, onPoints: (points: Points) => void}} Tracer */
/** @typedef {{onState: (heard: Heard) => void, onPicture: (pictured: Pictured) => void, onSaved: (file: Blob) => void}} Watcher */

/** What is looked at is read by people. */
const LOOK_HZ = 10;
/** As often as most screens show another picture. */
const WATCH_HZ = 60;

/** Messages that this page was too slow for, since the lane was opened. */
export const dropped = signal(0);
/** Whether what is heard comes. */
export const laneOpen = signal(true);

/** @type {Worker | null} */
let worker = null;
let lastNumber = 0;
/** @type {Map<number, Onlooker | Tracer | Watcher>} */
const listeners = new Map();
/** @type {Map<number, (text: string) => void>} */
const texts = new Map();

/** @param {FromPage} message @param {Transferable[]} moved what the worker gets and the page gives away */
function post(message, moved = []) {
  worker ??= begun();
  worker.postMessage(message, moved);
}

/** @returns {Worker} */
function begun() {
  const made = new Worker(new URL("../workers/data.js", import.meta.url), { type: "module" });
  made.onmessage = ({ data }) => take(data);
  effect(() => {
    if (connection.value === "connected") made.postMessage({ kind: "retry" });
  });
  whenTypesChange(tell);
  const see = () => made.postMessage({ kind: "seen", isSeen: !document.hidden });
  document.addEventListener("visibilitychange", see);
  see();
  return made;
}

/** @param {ToPage | PictureToPage} message */
function take(message) {
  if (message.kind === "need") tell(message.typeName);
  else if (message.kind === "lane") takeLane(message);
  else if (message.kind === "text") texts.get(message.request)?.(message.text);
  else takeHeard(message);
}

/** @param {import("../workers/subscriptions.js").LaneState} message */
function takeLane(message) {
  laneOpen.value = message.open;
  dropped.value = message.dropped;
}

/** @param {import("../workers/subscriptions.js").State | Looked | Points | Pictured | SavedPicture} message */
function takeHeard(message) {
  const listener = listeners.get(message.wish);
  if (!listener) return;
  if (message.kind === "state") listener.onState(message.heard);
  else if (message.kind === "message" && "onMessage" in listener) listener.onMessage(message);
  else if (message.kind === "points" && "onPoints" in listener) listener.onPoints(message);
  else if (message.kind === "picture" && "onPicture" in listener) listener.onPicture(message);
  else if (message.kind === "saved" && "onSaved" in listener) listener.onSaved(message.file);
}

/** @param {string} typeName tell the worker */
async function tell(typeName) {
  post({ kind: "learn", typeName, ...(await typeOf(typeName)) });
}

/** @param {string} topic @param {"every" | "newest"} mode @param {Ways} ways */
function wishFor(
  topic,
  mode,
  { reliable = null, latched = null, depth = null, typeName = "", mostHz = LOOK_HZ, pace = "tick" },
) {
  lastNumber += 1;
  return {
    wish: lastNumber,
    topic,
    type_name: typeName,
    mode,
    most_hz: mostHz,
    pace,
    reliable,
    latched,
    depth,
  };
}

/** @param {number} wish */
function leave(wish) {
  listeners.delete(wish);
  post({ kind: "leave", wish });
}

/**
 * Look at the newest message of a topic, some times in a second.
 *
 * @param {string} topic
 * @param {Ways} ways
 * @param {Onlooker} onlooker
 */
export function lookAt(topic, ways, onlooker) {
  const wish = wishFor(topic, "newest", ways);
  const number = wish.wish;
  listeners.set(number, onlooker);
  post({ kind: "look", wish });
  return {
    /** @param {string} path @param {number} count show so many items of a list */
    unfold: (path, count) => post({ kind: "unfold", wish: number, path, count }),
    /** @param {string} path @returns {Promise<string>} the value there, all of it */
    text: (path) => textOf(number, path),
    leave: () => leave(number),
  };
}

/** @param {number} wish @param {string} path @returns {Promise<string>} */
function textOf(wish, path) {
  lastNumber += 1;
  const request = lastNumber;
  return new Promise((resolve) => {
    texts.set(request, (text) => {
      texts.delete(request);
      resolve(text);
    });
    post({ kind: "text", wish, path, request });
  });
}

/**
 * Have numbers of every message of a topic.
 *
 * @param {string} topic
 * @param {readonly string[]} paths
 * @param {Ways} ways
 * @param {Tracer} tracer
 */
export function trace(topic, paths, ways, tracer) {
  const wish = wishFor(topic, "every", { mostHz: 60, ...ways });
  listeners.set(wish.wish, tracer);
  post({ kind: "trace", wish, paths });
  return {
    /** @param {readonly string[]} chosen */
    choose: (chosen) => post({ kind: "trace", wish, paths: chosen }),
    leave: () => leave(wish.wish),
  };
}

/**
 * Look at the newest image of a topic, which the worker paints on a canvas.
 *
 * @param {string} topic
 * @param {Ways} ways
 * @param {OffscreenCanvas} canvas given away
 * @param {Watcher} watcher
 */
export function watch(topic, ways, canvas, watcher) {
  const wish = wishFor(topic, "newest", { mostHz: WATCH_HZ, ...ways });
  listeners.set(wish.wish, watcher);
  post({ kind: "watch", wish, canvas }, [canvas]);
  return {
    /** @param {PictureAsked} asked */
    ask: (asked) => post({ kind: "of_picture", wish: wish.wish, asked }),
    leave: () => leave(wish.wish),
  };
}
