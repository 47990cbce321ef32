/**
 * The data lane of the page, in a worker: hears what the page wishes, reads it, and tells the page
 * what it shows. It loads nothing from `vendor/`: import maps do not count in workers.
 */

/** @import { MessageView } from "../types/wire.d.ts" */
/** @import { Range } from "../lib/image-pixels.js" */
/** @import { Heard, ToPage, Wish } from "./wishes.js" */

import { readFrame } from "./frames.js";
import { Pictures } from "./pictures.js";
import { Look, Trace, Types } from "./wishes.js";

/**
 * @typedef {{kind: "look", wish: Wish}} StartLook
 * @typedef {{kind: "trace", wish: Wish, paths: readonly string[]}} StartTrace
 * @typedef {{kind: "watch", wish: Wish, range: Range | null}} StartWatch
 * @typedef {{kind: "shade", wish: number, range: Range | null}} Shade
 * @typedef {{kind: "leave", wish: number}} Leave
 * @typedef {{kind: "learn", typeName: string, messages: readonly MessageView[] | null, reason: string}} Learn
 * @typedef {{kind: "unfold", wish: number, path: string, count: number}} Unfold
 * @typedef {{kind: "text", wish: number, path: string, request: number}} AskText
 * @typedef {{kind: "retry"}} Retry
 * @typedef {StartLook | StartTrace | StartWatch | Shade | Leave | Learn | Unfold | AskText | Retry} FromPage
 */

const RETRY_MS = 1500;

/** @type {Map<number, Look | Trace | Pictures>} by wish */
const wishes = new Map();
/** @type {Map<number, number[]>} wishes by channel */
const channels = new Map();
/** @type {WebSocket | null} */
let socket = null;
/** @type {ReturnType<typeof setTimeout> | undefined} */
let retry;
const types = new Types(post);

/** @param {ToPage} message */
function post(message) {
  /** @type {any} */ (self).postMessage(message, movedWith(message));
}

/** @param {ToPage} message @returns {Transferable[]} what the page gets and the worker gives away */
function movedWith(message) {
  if (message.kind === "points")
    return [message.times.buffer, ...message.values.map(({ buffer }) => buffer)];
  if (message.kind !== "picture" || !message.picture) return [];
  const { rgba, values } = message.picture;
  return values ? [rgba.buffer, values.buffer] : [rgba.buffer];
}

/** @param {object} message */
function say(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

function open() {
  clearTimeout(retry);
  if (socket || wishes.size === 0) return;
  const address = new URL("/data", self.location.href);
  address.protocol = address.protocol.replace("http", "ws");
  const opened = new WebSocket(address);
  socket = opened;
  opened.binaryType = "arraybuffer";
  opened.onopen = () => {
    for (const { wish } of wishes.values()) say({ type: "hear", ...wish });
    post({ kind: "lane", open: true, dropped: 0 });
  };
  opened.onmessage = ({ data }) => take(data);
  opened.onclose = () => lose(opened);
}

/** @param {WebSocket} closed */
function lose(closed) {
  if (socket !== closed) return;
  socket = null;
  channels.clear();
  post({ kind: "lane", open: false, dropped: 0 });
  retry = setTimeout(open, RETRY_MS);
}

/** @param {string | ArrayBuffer} data */
function take(data) {
  if (typeof data === "string") takeWords(JSON.parse(data));
  else takeFrame(data);
}

/** @param {Heard | {type: "not_heard", wish: number, reason: string}} told */
function takeWords(told) {
  const one = wishes.get(told.wish);
  if (!one) return;
  const heard = told.type === "heard" ? told : refused(told);
  if (told.type === "heard") {
    const others = channels.get(told.channel) ?? [];
    if (!others.includes(told.wish)) channels.set(told.channel, [...others, told.wish]);
    one.typeName = told.type_name;
    one.show();
  }
  post({ kind: "state", wish: told.wish, heard });
}

/** @param {{wish: number, reason: string}} told @returns {Heard} */
const refused = ({ wish, reason }) => ({
  type: "heard",
  wish,
  channel: 0,
  state: "refused",
  type_name: "",
  types: [],
  publishers: 0,
  reliable: false,
  latched: false,
  depth: 0,
  reason,
});

/** @param {ArrayBuffer} data */
function takeFrame(data) {
  const { dropped, messages } = readFrame(data);
  /** @type {Map<number, import("./frames.js").Came[]>} */
  const byChannel = new Map();
  for (const came of messages) {
    const others = byChannel.get(came.channel);
    if (others) others.push(came);
    else byChannel.set(came.channel, [came]);
  }
  for (const [channel, came] of byChannel)
    for (const wish of channels.get(channel) ?? []) wishes.get(wish)?.take(came);
  if (dropped > 0) post({ kind: "lane", open: true, dropped });
}

/** @param {StartLook | StartTrace | StartWatch} asked */
function start(asked) {
  const { wish } = asked;
  const before = wishes.get(wish.wish);
  if (before instanceof Trace && asked.kind === "trace") {
    before.choose(asked.paths);
    return;
  }
  wishes.set(wish.wish, wished(asked));
  types.doubt();
  if (socket) say({ type: "hear", ...wish });
  else open();
}

/** @param {StartLook | StartTrace | StartWatch} asked */
function wished(asked) {
  if (asked.kind === "look") return new Look(asked.wish, types, post);
  if (asked.kind === "watch") return new Pictures(asked.wish, types, post, asked.range);
  return new Trace(asked.wish, types, post, asked.paths);
}

/** @param {number} wish */
function leave(wish) {
  wishes.delete(wish);
  for (const [channel, all] of channels) {
    const left = all.filter((one) => one !== wish);
    if (left.length > 0) channels.set(channel, left);
    else channels.delete(channel);
  }
  say({ type: "leave", wish });
  if (wishes.size > 0) return;
  // Nobody looks: the lane costs nothing then.
  const closing = socket;
  socket = null;
  closing?.close();
}

/** @param {Learn} told */
function learn({ typeName, messages, reason }) {
  types.learn(typeName, messages, reason);
  for (const one of wishes.values()) if (one.typeName === typeName) one.show();
}

/** @param {FromPage} asked */
function carryOut(asked) {
  if (asked.kind === "look" || asked.kind === "trace" || asked.kind === "watch") start(asked);
  else if (asked.kind === "leave") leave(asked.wish);
  else if (asked.kind === "learn") learn(asked);
  else if (asked.kind === "retry") open();
  else if (asked.kind === "shade") shade(asked);
  else carryOutLook(asked);
}

/** @param {Shade} asked */
function shade({ wish, range }) {
  const one = wishes.get(wish);
  if (one instanceof Pictures) one.shade(range);
}

/** @param {Unfold | AskText} asked */
function carryOutLook(asked) {
  const one = wishes.get(asked.wish);
  const look = one instanceof Look ? one : null;
  if (asked.kind === "unfold") look?.unfold(asked.path, asked.count);
  else post({ kind: "text", request: asked.request, text: look?.text(asked.path) ?? "" });
}

self.onmessage = ({ data }) => carryOut(data);
