/**
 * The control lane: one websocket for commands and events, opened again by itself whenever it is
 * lost. Text frames are JSON; binary ones hold the positions of the joints.
 */

/** @import { Command, Event, Refused } from "../types/wire.d.ts" */

import { batch } from "vendor/preact.js";
import { address } from "../lib/address.js";
import {
  connection,
  documentId,
  hasControl,
  role,
  session,
  turnedAway,
  version,
} from "./connection.js";

/** @typedef {Exclude<Extract<Event, {request: number}>, Refused>} Answer what comes back to one command */
/**
 * A command without what the lane adds to it.
 * @template T
 * @typedef {T extends Command ? Omit<T, "request" | "document"> & {document?: string} : never} Asked
 */

const RETRY_MS = [250, 500, 1000, 2000, 3000];
const ASK_WHY_EVERY = 3;
/** The studio ends a lane on which a longer one comes. */
const COMMAND_LIMIT_BYTES = 1 << 20;
const BYTES_PER_LETTER_MAX = 3;
/** Nothing came for so long that the lane is given up: the socket alone may not notice. */
const GREETING_TIMEOUT_MS = 8000;

/** The studio said no; `kind` is the name of its error. */
export class RefusedError extends Error {
  /** @param {Pick<Refused, "kind" | "reason">} refusal */
  constructor({ kind, reason }) {
    super(reason);
    this.kind = kind;
  }
}

/** The lane was lost before the answer came. */
export class LostError extends Error {}

/** @type {Map<number, {resolve: (answer: Answer) => void, reject: (error: Error) => void}>} */
const waiting = new Map();
/** @type {WebSocket | null} */
let socket = null;
let lastRequest = 0;
let attempts = 0;
/** When the newest message came, as `performance.now()`. */
let heard_ms = 0;
/** @type {() => void} */
let whenOpen = () => {};

/** @type {Map<string, (event: any) => void>} */
const subscribers = new Map();
/** The newest event of each type that nobody subscribed to yet. @type {Map<string, Event>} */
const unclaimed = new Map();
/** @type {(frame: {revision: number, positions: Float64Array}) => void} */
let takeJointFrame = () => {};
/** @type {(view: View) => void} */
let takeView = () => {};

/**
 * Be told of a type of events; the newest that came before is told at once. Each type has one subscriber:
 * the module that keeps what the studio told of it.
 *
 * @template {Event["type"]} T
 * @param {T} type
 * @param {(event: Extract<Event, {type: T}>) => void} take
 */
export function subscribe(type, take) {
  subscribers.set(type, take);
  const missed = unclaimed.get(type);
  unclaimed.delete(type);
  if (missed) receive(missed);
}

/** @param {typeof takeJointFrame} take is given the positions of moving joints */
export function onJointFrame(take) {
  takeJointFrame = take;
}

/** @param {typeof takeView} take is given what the presenter looks at */
export function onView(take) {
  takeView = take;
}

/** @param {Event} event */
function receive(event) {
  const take = subscribers.get(event.type);
  if (take) batch(() => take(event));
  else unclaimed.set(event.type, event);
}

/** @param {() => void} greet called at every new connection, after the studio's hello */
export function connect(greet) {
  whenOpen = greet;
  open();
  addEventListener("online", retryNow);
  addEventListener("visibilitychange", () => {
    if (!document.hidden) retryNow();
  });
}

/**
 * Ask the studio for something.
 *
 * @param {Asked<Command>} command
 * @returns {Promise<Answer>}
 * @throws {RefusedError} when the studio says no
 * @throws {LostError} when it went away meanwhile
 */
export function send(command) {
  if (socket?.readyState !== WebSocket.OPEN) return Promise.reject(new LostError());
  lastRequest += 1;
  const request = lastRequest;
  const text = JSON.stringify({ document: documentId.value, ...command, request });
  if (isTooLong(text)) {
    const reason = `A command of more than ${COMMAND_LIMIT_BYTES} bytes is not read.`;
    return Promise.reject(new RefusedError({ kind: "CommandError", reason }));
  }
  socket.send(text);
  return new Promise((resolve, reject) => waiting.set(request, { resolve, reject }));
}

/** @param {string} text */
const isTooLong = (text) =>
  text.length * BYTES_PER_LETTER_MAX > COMMAND_LIMIT_BYTES &&
  new TextEncoder().encode(text).length > COMMAND_LIMIT_BYTES;

/** @returns {number} ms since anything came on the lane */
export const silentFor = () => performance.now() - heard_ms;

/** Who is gone without a word closes no socket: take the lane for lost. */
export function giveUp() {
  const given = socket;
  if (!given || connection.value !== "connected") return;
  given.onmessage = null;
  lose();
  given.close();
}

/** @type {ReturnType<typeof setTimeout> | undefined} */
let retryTimer;

function retryNow() {
  if (connection.value !== "lost" || socket) return;
  clearTimeout(retryTimer);
  open();
}

function open() {
  const socketAddress = new URL(address("/control"), location.href);
  socketAddress.protocol = socketAddress.protocol.replace("http", "ws");
  const opened = new WebSocket(socketAddress);
  socket = opened;
  opened.binaryType = "arraybuffer";
  const impatient = setTimeout(() => opened.close(), GREETING_TIMEOUT_MS);
  opened.onmessage = ({ data }) => {
    clearTimeout(impatient);
    take(data);
  };
  opened.onclose = () => {
    clearTimeout(impatient);
    if (socket === opened) lose();
  };
}

/** A socket does not say why it was refused; a plain request does. */
async function askWhy() {
  const answer = await fetch(address("/api/documents"), { cache: "no-store" }).catch(() => null);
  turnedAway.value = answer?.status === 401 || answer?.status === 403;
}

function lose() {
  socket = null;
  connection.value = "lost";
  for (const { reject } of waiting.values()) reject(new LostError());
  waiting.clear();
  const delay = RETRY_MS[Math.min(attempts, RETRY_MS.length - 1)];
  attempts += 1;
  if (attempts % ASK_WHY_EVERY === 0) askWhy();
  retryTimer = setTimeout(open, delay);
}

/** @param {string | ArrayBuffer} data */
function take(data) {
  heard_ms = performance.now();
  if (typeof data !== "string") {
    const frame = readJointFrame(data);
    if (frame) takeJointFrame(frame);
    const view = frame ? null : readView(data);
    if (view) takeView(view);
    return;
  }
  const event = /** @type {Event} */ (JSON.parse(data));
  if (event.type === "hello") greetedBy(event);
  receive(event);
  if ("request" in event) answer(event);
  if (event.type !== "hello") return;
  attempts = 0;
  turnedAway.value = false;
  connection.value = "connected";
  whenOpen();
}

/** @param {Extract<Event, {type: "hello"}>} event */
function greetedBy(event) {
  batch(() => {
    role.value = event.role;
    hasControl.value = event.role === "presenter"; // until it is said who has it
    version.value = event.version;
    session.value = event.session;
  });
}

/** @param {Answer | Refused} event */
function answer(event) {
  const asker = waiting.get(event.request);
  waiting.delete(event.request);
  if (event.type === "refused") asker?.reject(new RefusedError(event));
  else asker?.resolve(event);
}

/** @typedef {readonly [number, number, number]} Point m, in the root frame */
/** @typedef {{eye: Point, target: Point, up: Point, flat: boolean, field: number, pointer: Point | null}} View camera and pointer of the presenter */

const VIEW = 2;
const VIEW_BYTES = 60;

/**
 * @param {ArrayBuffer} data as `show_view` says
 * @returns {View | null} null for a frame of another kind
 */
export function readView(data) {
  if (data.byteLength !== VIEW_BYTES) return null;
  const view = new DataView(data);
  if (view.getUint8(0) !== VIEW) return null;
  const number = (/** @type {number} */ at) => view.getFloat32(HEADER_BYTES + 4 * at, true);
  /** @param {number} at @returns {Point} */
  const point = (at) => [number(at), number(at + 1), number(at + 2)];
  const pointer = point(6);
  return {
    ...{ eye: point(0), target: point(3), up: point(9), field: number(12) },
    flat: view.getUint8(1) === 1,
    pointer: Number.isNaN(pointer[0]) ? null : pointer,
  };
}

const JOINTS = 1;
const HEADER_BYTES = 8;

/**
 * @param {ArrayBuffer} data
 * @returns {{revision: number, positions: Float64Array} | null} null for a frame of another kind
 */
export function readJointFrame(data) {
  if (data.byteLength < HEADER_BYTES) return null;
  const view = new DataView(data);
  if (view.getUint8(0) !== JOINTS || (data.byteLength - HEADER_BYTES) % 8) return null;
  return { revision: view.getUint32(4, true), positions: new Float64Array(data, HEADER_BYTES) };
}
