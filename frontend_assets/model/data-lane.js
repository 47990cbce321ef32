/**
 * The data lane as panels use it: topics are subscribed as messages, numbers or pictures, in a
 * worker.
 */

/** @import { FromPage } from "../workers/data.js" */
/** @import { PictureAsked, Pictured, PictureToPage, SavedPicture } from "../workers/pictures.js" */
/** @import { SubscriptionView, Echoed, Points, ToPage } from "../workers/subscriptions.js" */

import { effect, signal } from "vendor/preact.js";
import { connection, documentId } from "./connection.js";
import { typeOf, whenTypesChange } from "./interfaces.js";

/** @typedef {{reliable?: boolean | null, latched?: boolean | null, depth?: number | null, typeName?: string, mostHz?: number, pace?: "tick" | "at_once"}} Ways null: as fits its publishers; at once: between two ticks, for what somebody waits for */
/** @typedef {ReturnType<typeof echo>} Echo */
/** @typedef {{onState: (subscription: SubscriptionView) => void, onMessage: (message: Echoed) => void}} EchoListener */
/** @typedef {{onState: (subscription: SubscriptionView) => void, onPoints: (points: Points) => void}} TraceListener */
/** @typedef {{onState: (subscription: SubscriptionView) => void, onPicture: (pictured: Pictured) => void, onSaved: (file: Blob) => void}} PictureListener */

/** What is looked at is read by people. */
const LOOK_HZ = 10;
/** As often as most screens show another picture. */
const WATCH_HZ = 60;

/** Messages that this page was too slow for, since the lane was opened. */
export const dropped = signal(0);
/** Whether the lane is open. */
export const laneOpen = signal(true);

/** @type {Worker | null} */
let worker = null;
let lastNumber = 0;
/** @type {Map<number, EchoListener | TraceListener | PictureListener>} */
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
  effect(() => made.postMessage({ kind: "about", document: documentId.value }));
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
  else takeNews(message);
}

/** @param {import("../workers/subscriptions.js").LaneState} message */
function takeLane(message) {
  laneOpen.value = message.open;
  dropped.value = message.dropped;
}

/** @param {import("../workers/subscriptions.js").State | Echoed | Points | Pictured | SavedPicture} message */
function takeNews(message) {
  const listener = listeners.get(message.subscription);
  if (!listener) return;
  if (message.kind === "state") listener.onState(message.view);
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
function commandFor(
  topic,
  mode,
  { reliable = null, latched = null, depth = null, typeName = "", mostHz = LOOK_HZ, pace = "tick" },
) {
  lastNumber += 1;
  return {
    subscription: lastNumber,
    document: documentId.peek(),
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

/** @param {number} subscription */
function leave(subscription) {
  listeners.delete(subscription);
  post({ kind: "unsubscribe", subscription });
}

/**
 * Echo at the newest message of a topic, some times in a second.
 *
 * @param {string} topic
 * @param {Ways} ways
 * @param {EchoListener} listener
 */
export function echo(topic, ways, listener) {
  const command = commandFor(topic, "newest", ways);
  const number = command.subscription;
  listeners.set(number, listener);
  post({ kind: "echo", command });
  return {
    /** @param {string} path @param {number} count show so many items of a list */
    unfold: (path, count) => post({ kind: "unfold", subscription: number, path, count }),
    /** @param {string} path @returns {Promise<string>} the value there, all of it */
    text: (path) => textOf(number, path),
    leave: () => leave(number),
  };
}

/** @param {number} subscription @param {string} path @returns {Promise<string>} */
function textOf(subscription, path) {
  lastNumber += 1;
  const request = lastNumber;
  return new Promise((resolve) => {
    texts.set(request, (text) => {
      texts.delete(request);
      resolve(text);
    });
    post({ kind: "text", subscription, path, request });
  });
}

/**
 * Have numbers of every message of a topic.
 *
 * @param {string} topic
 * @param {readonly string[]} paths
 * @param {Ways} ways
 * @param {TraceListener} listener
 */
export function trace(topic, paths, ways, listener) {
  const command = commandFor(topic, "every", { mostHz: 60, ...ways });
  listeners.set(command.subscription, listener);
  post({ kind: "trace", command, paths });
  return {
    /** @param {readonly string[]} chosen */
    choose: (chosen) => post({ kind: "trace", command, paths: chosen }),
    leave: () => leave(command.subscription),
  };
}

/**
 * Echo at the newest image of a topic, which the worker paints on a canvas.
 *
 * @param {string} topic
 * @param {Ways} ways
 * @param {OffscreenCanvas} canvas given away
 * @param {PictureListener} listener
 */
export function watch(topic, ways, canvas, listener) {
  const command = commandFor(topic, "newest", { mostHz: WATCH_HZ, ...ways });
  listeners.set(command.subscription, listener);
  post({ kind: "watch", command, canvas }, [canvas]);
  return {
    /** @param {PictureAsked} asked */
    ask: (asked) => post({ kind: "of_picture", subscription: command.subscription, asked }),
    leave: () => leave(command.subscription),
  };
}
