/**
 * The data lane of the page, in a worker: subscribes topics for the page, reads their messages, and
 * tells it what to show. It loads nothing from `vendor/`: import maps do not count in workers.
 */

/** @import { MessageView } from "../types/wire.d.ts" */
/** @import { PictureAsked, PictureToPage } from "./pictures.js" */
/** @import { Came } from "./frames.js" */
/** @import { SubscriptionView, ToPage, SubscribeCommand } from "./subscriptions.js" */

import { address } from "../lib/address.js";
import { Bulk } from "./bulk.js";
import { readFrame } from "./frames.js";
import { Easel, Pictures } from "./pictures.js";
import { Echo, Trace, Types } from "./subscriptions.js";

/**
 * @typedef {{kind: "echo", command: SubscribeCommand}} StartEcho
 * @typedef {{kind: "trace", command: SubscribeCommand, paths: readonly string[]}} StartTrace
 * @typedef {{kind: "watch", command: SubscribeCommand, canvas: OffscreenCanvas}} StartWatch
 * @typedef {{kind: "of_picture", subscription: number, asked: PictureAsked}} AskOfPicture
 * @typedef {{kind: "unsubscribe", subscription: number}} Leave
 * @typedef {{kind: "learn", typeName: string, messages: readonly MessageView[] | null, reason: string}} Learn
 * @typedef {{kind: "unfold", subscription: number, path: string, count: number}} Unfold
 * @typedef {{kind: "text", subscription: number, path: string, request: number}} AskText
 * @typedef {{kind: "retry"}} Retry
 * @typedef {{kind: "seen", isSeen: boolean}} Seen whether anybody can look at the page
 * @typedef {{kind: "about", document: string}} About the document whose time it is
 * @typedef {StartEcho | StartTrace | StartWatch | AskOfPicture | Leave | Learn | Unfold | AskText | Retry | Seen | About} FromPage
 */

const RETRY_MS = 1500;

/** @type {Map<number, Echo | Trace | Pictures>} by subscription */
const subscriptions = new Map();
/** @type {Map<number, number[]>} subscriptions by channel */
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
  lost: subscribeAgain,
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
  if (socket || subscriptions.size === 0) return;
  const place = new URL(address("/data"), self.location.href);
  place.protocol = place.protocol.replace("http", "ws");
  const opened = new WebSocket(place);
  socket = opened;
  opened.binaryType = "arraybuffer";
  opened.onopen = () => {
    slow = { data: 0, bulk: 0 };
    for (const one of subscriptions.values()) subscribe(one);
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

/** @param {SubscriptionView | {type: "not_subscribed", subscription: number, reason: string} | {type: "bulk_key", key: string}} answer */
function takeWords(answer) {
  if (answer.type === "bulk_key") bulk.open(answer.key);
  else takeState(answer);
}

/** @param {SubscriptionView | {type: "not_subscribed", subscription: number, reason: string}} answer */
function takeState(answer) {
  const one = subscriptions.get(answer.subscription);
  if (!one) return;
  const view = answer.type === "subscription" ? answer : refused(answer);
  if (answer.type === "subscription") {
    const others = channels.get(answer.channel) ?? [];
    if (!others.includes(answer.subscription))
      channels.set(answer.channel, [...others, answer.subscription]);
    one.typeName = answer.type_name;
    one.show();
  }
  post({ kind: "state", subscription: answer.subscription, view });
}

/** @param {{subscription: number, reason: string}} answer @returns {SubscriptionView} */
const refused = ({ subscription, reason }) => ({
  type: "subscription",
  subscription,
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
  const [subscription, ...others] = channels.get(channel) ?? [];
  return others.length === 0 && subscriptions.get(subscription ?? 0) instanceof Pictures;
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
  for (const subscription of channels.get(channel) ?? []) {
    const one = subscriptions.get(subscription);
    const taken = one?.command.mode === "every" ? came : inOrder;
    if (taken.length > 0) one?.take(taken);
  }
}

/** What is only looked at is not subscribed while nobody can. @param {Echo | Trace | Pictures} one */
function subscribe({ command }) {
  if (isSeen || command.mode === "every") say({ type: "subscribe", ...command });
}

/** @param {Seen} answer */
function see(answer) {
  if (isSeen === answer.isSeen) return;
  isSeen = answer.isSeen;
  for (const one of subscriptions.values()) {
    if (one.command.mode === "every") continue;
    if (isSeen) subscribe(one);
    else unsubscribe(one.command.subscription);
  }
}

/** @param {About} asked of another document all comes anew */
function beAbout({ document }) {
  for (const one of subscriptions.values()) {
    if (one.command.document === document) continue;
    unsubscribe(one.command.subscription);
    one.command = { ...one.command, document };
    subscribe(one);
  }
}

/** @param {number} subscription */
function unsubscribe(subscription) {
  for (const [channel, all] of channels) {
    const others = all.filter((one) => one !== subscription);
    if (others.length > 0) channels.set(channel, others);
    else {
      channels.delete(channel);
      bulk.leave(channel);
    }
  }
  say({ type: "unsubscribe", subscription });
}

/** @param {readonly number[]} lost channels: what they told once and for all may have been on its way */
function subscribeAgain(lost) {
  for (const subscription of new Set(lost.flatMap((channel) => channels.get(channel) ?? []))) {
    const one = subscriptions.get(subscription);
    if (one?.command.mode === "newest") subscribe(one);
  }
}

/** @param {StartEcho | StartTrace | StartWatch} asked */
function start(asked) {
  const { command } = asked;
  const before = subscriptions.get(command.subscription);
  if (before instanceof Trace && asked.kind === "trace") {
    before.choose(asked.paths);
    return;
  }
  const one = subscriptionFor(asked);
  subscriptions.set(command.subscription, one);
  types.doubt();
  if (socket) subscribe(one);
  else open();
}

/** When the screen is ready for another picture. @param {() => void} paint */
const nextFrame = (paint) => requestAnimationFrame(paint);

/** @param {StartEcho | StartTrace | StartWatch} asked */
function subscriptionFor(asked) {
  if (asked.kind === "echo") return new Echo(asked.command, types, post);
  if (asked.kind === "watch")
    return new Pictures(asked.command, types, post, new Easel(asked.canvas), nextFrame);
  return new Trace(asked.command, types, post, asked.paths);
}

/** @param {number} subscription */
function leave(subscription) {
  const left = subscriptions.get(subscription);
  if (left instanceof Pictures) left.leave();
  subscriptions.delete(subscription);
  unsubscribe(subscription);
  if (subscriptions.size > 0) return;
  // Nobody looks: the lane costs nothing then.
  const closing = socket;
  socket = null;
  forgetChannels();
  closing?.close();
}

/** @param {Learn} answer */
function learn({ typeName, messages, reason }) {
  types.learn(typeName, messages, reason);
  for (const one of subscriptions.values()) if (one.typeName === typeName) one.show();
}

/** @param {FromPage} asked */
function carryOut(asked) {
  if (asked.kind === "echo" || asked.kind === "trace" || asked.kind === "watch") start(asked);
  else if (asked.kind === "unsubscribe") leave(asked.subscription);
  else if (asked.kind === "learn") learn(asked);
  else if (asked.kind === "retry") open();
  else if (asked.kind === "seen") see(asked);
  else if (asked.kind === "about") beAbout(asked);
  else if (asked.kind === "of_picture") carryOutPicture(asked);
  else carryOutEcho(asked);
}

/** @param {AskOfPicture} answer */
function carryOutPicture({ subscription, asked }) {
  const one = subscriptions.get(subscription);
  if (one instanceof Pictures) one.carryOut(asked);
}

/** @param {Unfold | AskText} asked */
function carryOutEcho(asked) {
  const one = subscriptions.get(asked.subscription);
  const look = one instanceof Echo ? one : null;
  if (asked.kind === "unfold") look?.unfold(asked.path, asked.count);
  else post({ kind: "text", request: asked.request, text: look?.text(asked.path) ?? "" });
}

self.onmessage = ({ data }) => carryOut(data);
