/**
 * The data lane of the page, in a worker: hears what the page wishes, reads it, and tells the page
 * what it shows. It loads nothing from `vendor/`: import maps do not count in workers.
 */

/** @import { MessageView } from "../types/wire.d.ts" */
/** @import { PictureAsked, PictureToPage } from "./pictures.js" */
/** @import { Came } from "./frames.js" */
/** @import { Heard, ToPage, Wish } from "./subscriptions.js" */

import { Bulk } from "./bulk.js";
import { readFrame } from "./frames.js";
import { Easel, Pictures } from "./pictures.js";
import { Look, Trace, Types } from "./subscriptions.js";

/**
 * @typedef {{kind: "look", wish: Wish}} StartLook
 * @typedef {{kind: "trace", wish: Wish, paths: readonly string[]}} StartTrace
 * @typedef {{kind: "watch", wish: Wish, canvas: OffscreenCanvas}} StartWatch
 * @typedef {{kind: "of_picture", wish: number, asked: PictureAsked}} AskOfPicture
 * @typedef {{kind: "leave", wish: number}} Leave
 * @typedef {{kind: "learn", typeName: string, messages: readonly MessageView[] | null, reason: string}} Learn
 * @typedef {{kind: "unfold", wish: number, path: string, count: number}} Unfold
 * @typedef {{kind: "text", wish: number, path: string, request: number}} AskText
 * @typedef {{kind: "retry"}} Retry
 * @typedef {{kind: "seen", isSeen: boolean}} Seen whether anybody can look at the page
 * @typedef {StartLook | StartTrace | StartWatch | AskOfPicture | Leave | Learn | Unfold | AskText | Retry | Seen} FromPage
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
let isSeen = true;
const types = new Types(post);
/** For how many messages this page was too slow, on either lane. */
let slow = { data: 0, bulk: 0 };
const bulk = new Bulk({
  askKey: () => say({ type: "ask_bulk" }),
  take: takeBulk,
  lost: hearAnew,
  locks: self.navigator.locks,
  fetch: (address, options) => self.fetch(address, options),
  now_ms: () => performance.now(),
});

/** @param {ToPage | PictureToPage} message */
function post(message) {
  /** @type {any} */ (self).postMessage(message, movedWith(message));
}

/** @param {ToPage | PictureToPage} message @returns {Transferable[]} what the page gets and the worker gives away */
function movedWith(message) {
  if (message.kind !== "points") return [];
  return [message.times.buffer, ...message.values.map(({ buffer }) => buffer)];
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
    slow = { data: 0, bulk: 0 };
    for (const one of wishes.values()) hear(one);
    post({ kind: "lane", open: true, dropped: 0 });
  };
  opened.onmessage = ({ data }) => take(data);
  opened.onclose = () => lose(opened);
}

/** @param {WebSocket} closed */
function lose(closed) {
  if (socket !== closed) return;
  socket = null;
  forgetChannels();
  post({ kind: "lane", open: false, dropped: 0 });
  retry = setTimeout(open, RETRY_MS);
}

function forgetChannels() {
  channels.clear();
  bulk.forget();
}

/** @param {string | ArrayBuffer} data */
function take(data) {
  if (typeof data === "string") takeWords(JSON.parse(data));
  else takeData(data);
}

/** @param {Heard | {type: "not_heard", wish: number, reason: string} | {type: "bulk_key", key: string}} told */
function takeWords(told) {
  if (told.type === "bulk_key") bulk.open(told.key);
  else takeState(told);
}

/** @param {Heard | {type: "not_heard", wish: number, reason: string}} told */
function takeState(told) {
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

/** @param {ArrayBuffer} frame */
function takeData(frame) {
  const { dropped, messages } = readFrame(frame);
  for (const came of messages) bulk.notice(came);
  tellSlow("data", dropped);
  takeMessages(messages);
}

/** @param {ArrayBuffer} frame */
function takeBulk(frame) {
  const { dropped, messages } = readFrame(frame);
  tellSlow("bulk", dropped);
  const [only] = messages;
  if (only && messages.length === 1 && isForOnePicture(only))
    only.done = () => bulk.spares.give(frame);
  takeMessages(messages);
}

/** Whether nobody else reads it: pictures tell when they are done. @param {Came} came */
function isForOnePicture({ channel }) {
  const [wish, ...others] = channels.get(channel) ?? [];
  return others.length === 0 && wishes.get(wish ?? 0) instanceof Pictures;
}

/** @param {"data" | "bulk"} lane @param {number} dropped */
function tellSlow(lane, dropped) {
  if (dropped === slow[lane]) return;
  slow[lane] = dropped;
  post({ kind: "lane", open: true, dropped: slow.data + slow.bulk });
}

/** @param {readonly Came[]} messages */
function takeMessages(messages) {
  /** @type {Map<number, Came[]>} */
  const byChannel = new Map();
  for (const came of messages) {
    const others = byChannel.get(came.channel);
    if (others) others.push(came);
    else byChannel.set(came.channel, [came]);
  }
  for (const [channel, came] of byChannel) takeChannel(channel, came);
}

/** @param {number} channel @param {readonly Came[]} came */
function takeChannel(channel, came) {
  const inOrder = came.filter((one) => !bulk.isOvertaken(one));
  for (const wish of channels.get(channel) ?? []) {
    const one = wishes.get(wish);
    const taken = one?.wish.mode === "every" ? came : inOrder;
    if (taken.length > 0) one?.take(taken);
  }
}

/** What is only looked at is not heard while nobody can. @param {Look | Trace | Pictures} one */
function hear({ wish }) {
  if (isSeen || wish.mode === "every") say({ type: "hear", ...wish });
}

/** @param {Seen} told */
function see(told) {
  if (isSeen === told.isSeen) return;
  isSeen = told.isSeen;
  for (const one of wishes.values()) {
    if (one.wish.mode === "every") continue;
    if (isSeen) hear(one);
    else unheard(one.wish.wish);
  }
}

/** @param {number} wish */
function unheard(wish) {
  for (const [channel, all] of channels) {
    const others = all.filter((one) => one !== wish);
    if (others.length > 0) channels.set(channel, others);
    else {
      channels.delete(channel);
      bulk.leave(channel);
    }
  }
  say({ type: "leave", wish });
}

/** @param {readonly number[]} lost channels: what they told once and for all may have been on its way */
function hearAnew(lost) {
  for (const wish of new Set(lost.flatMap((channel) => channels.get(channel) ?? []))) {
    const one = wishes.get(wish);
    if (one?.wish.mode === "newest") hear(one);
  }
}

/** @param {StartLook | StartTrace | StartWatch} asked */
function start(asked) {
  const { wish } = asked;
  const before = wishes.get(wish.wish);
  if (before instanceof Trace && asked.kind === "trace") {
    before.choose(asked.paths);
    return;
  }
  const one = wished(asked);
  wishes.set(wish.wish, one);
  types.doubt();
  if (socket) hear(one);
  else open();
}

/** When the screen is ready for another picture. @param {() => void} paint */
const nextFrame = (paint) => requestAnimationFrame(paint);

/** @param {StartLook | StartTrace | StartWatch} asked */
function wished(asked) {
  if (asked.kind === "look") return new Look(asked.wish, types, post);
  if (asked.kind === "watch")
    return new Pictures(asked.wish, types, post, new Easel(asked.canvas), nextFrame);
  return new Trace(asked.wish, types, post, asked.paths);
}

/** @param {number} wish */
function leave(wish) {
  const left = wishes.get(wish);
  if (left instanceof Pictures) left.leave();
  wishes.delete(wish);
  unheard(wish);
  if (wishes.size > 0) return;
  // Nobody looks: the lane costs nothing then.
  const closing = socket;
  socket = null;
  forgetChannels();
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
  else if (asked.kind === "seen") see(asked);
  else if (asked.kind === "of_picture") carryOutPicture(asked);
  else carryOutLook(asked);
}

/** @param {AskOfPicture} told */
function carryOutPicture({ wish, asked }) {
  const one = wishes.get(wish);
  if (one instanceof Pictures) one.carryOut(asked);
}

/** @param {Unfold | AskText} asked */
function carryOutLook(asked) {
  const one = wishes.get(asked.wish);
  const look = one instanceof Look ? one : null;
  if (asked.kind === "unfold") look?.unfold(asked.path, asked.count);
  else post({ kind: "text", request: asked.request, text: look?.text(asked.path) ?? "" });
}

self.onmessage = ({ data }) => carryOut(data);
