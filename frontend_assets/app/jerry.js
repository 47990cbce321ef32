/** What this page knows of Jerry: robots like him on the wire, their walks, and how far things were. */

/** @import { Jerry, Place } from "../lib/jerry.js" */

import { signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { distanceOf, isSame, jerriesOf } from "../lib/jerry.js";
import { Walk } from "../lib/jerry-walk.js";
import { called } from "./calling.js";
import { lookAt, trace } from "./data.js";
import { inNamespaces, keptFor } from "./namespaces.js";
import { askOrKeepWhy } from "./state/refusals.js";

const WALKS_MAX = 8;
const RUNS_MAX = 20;
const EXPIRE_MS = 500;

export const jerries = inNamespaces(jerriesOf);
/** Why what was asked for last was not done; empty: it was. */
export const jerryTrouble = signal("");

/**
 * @typedef {{number: number, place: Place, from: Place, answer: number, right: number, isExact: boolean}} Run
 *   how far a place is: from where he stood, what he answered, and what is right
 * @typedef {{walk: Walk, runs: readonly Run[], newest_s: number, turn: import("vendor/preact.js").Signal<number>}} Seen
 *   `newest_s`: when the last command came, by the studio's clock; `turn` changes whenever something does
 */

/** @returns {Seen} */
const nothing = () => ({ walk: new Walk(), runs: [], newest_s: 0, turn: signal(0) });

/** What was seen of a Jerry so far, by his namespace. */
export const seenOf = keptFor(nothing, WALKS_MAX);

const now_s = () => performance.now() / 1000;

/** @param {Jerry["pose"]} pose @param {Seen} known @returns {() => void} the end of hearing where he is */
export function hearPlaces(pose, { walk, turn }) {
  if (!pose) return () => {};
  /** @param {{values: Float64Array[]}} points */
  const onPoints = ({ values: [x, y] }) => {
    x?.forEach((value, n) => {
      walk.stand({ x: value, y: y?.[n] ?? Number.NaN }, now_s());
    });
    turn.value += 1;
  };
  const tracer = { onState: () => {}, onPoints };
  return trace(pose.name, [".x", ".y"], { typeName: pose.type }, tracer).leave;
}

/** @param {Jerry["command"]} command @param {Seen} known @returns {() => void} the end of hearing what he is told */
export function hearCommands(command, known) {
  if (!command) return () => {};
  const { walk, turn } = known;
  /** @param {{value: any, received_s: number}} message */
  const onMessage = ({ value, received_s }) => {
    // Who looks anew is shown the last one again.
    if (received_s <= known.newest_s) return;
    if (typeof value?.direction !== "string" || typeof value.steps !== "number") return;
    known.newest_s = received_s;
    walk.hear(value, now_s());
    turn.value += 1;
  };
  const ways = { typeName: command.type, mostHz: 60 };
  const look = lookAt(command.name, ways, { onState: () => {}, onMessage });
  const timer = setInterval(() => {
    if (walk.expire(now_s())) turn.value += 1;
  }, EXPIRE_MS);
  return () => {
    clearInterval(timer);
    look.leave();
  };
}

/** @param {Seen} known */
export function clearWalk(known) {
  known.walk.clear();
  known.runs = [];
  known.turn.value += 1;
}

/** @param {Jerry} jerry @param {string} direction @param {number} steps */
export async function command({ command }, direction, steps) {
  if (!command) return;
  await askOrKeepWhy(
    {
      ...{ type: "publish", name: command.name, message_type: command.type },
      ...{ text: JSON.stringify({ direction, steps }), rate_hz: 0 },
      ...{ reliable: true, latched: false, depth: 10 },
    },
    jerryTrouble,
  );
}

/** @param {Jerry} jerry @param {Seen} known @param {Place} place ask how far it is */
export async function measure({ distance }, known, place) {
  if (!distance) return;
  const begin = Math.max(0, known.walk.way.length - 1);
  const { reply, trouble } = await called(distance, { x: place.x, y: place.y });
  jerryTrouble.value = trouble;
  // He may have gone on while he was asked: each place of that time is right.
  const stood = known.walk.way.slice(begin);
  if (typeof reply?.distance !== "number" || stood.length === 0) {
    jerryTrouble.value ||= t("jerry.no_place");
    return;
  }
  const { distance: answer } = reply;
  const from = stood.find((one) => isSame(distanceOf(one, place), answer)) ?? stood.at(-1);
  if (from) keepRun(known, { place, from, answer });
}

/** @param {Seen} known @param {{place: Place, from: Place, answer: number}} run */
function keepRun(known, { place, from, answer }) {
  const right = distanceOf(from, place);
  const number = (known.runs[0]?.number ?? 0) + 1;
  const run = { number, place, from, answer, right, isExact: isSame(right, answer) };
  known.runs = [run, ...known.runs.slice(0, RUNS_MAX - 1)];
  known.turn.value += 1;
}
