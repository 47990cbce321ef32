/** A ruler of time: how a time goes on, what of it is seen, its steps and its words. Seconds count from the start. */

import { clamp } from "./numbers.js";

/** @typedef {{from_s: number, to_s: number}} Range */

/**
 * @typedef {object} Running what goes on by itself, as it was told last
 * @property {"live" | "past" | "bag"} mode
 * @property {number} begin_s
 * @property {number} end_s
 * @property {number} now_s
 * @property {boolean} playing
 * @property {number} rate
 * @property {readonly [number, number] | readonly number[] | null} loop
 */

/**
 * @param {Running} told
 * @param {number} since_s how long ago it was told
 * @returns {{now_s: number, end_s: number}} as it is by now
 */
export function countedOn(told, since_s) {
  const end_s = told.mode === "bag" ? told.end_s : told.end_s + since_s;
  if (told.mode === "live") return { now_s: end_s, end_s };
  if (!told.playing) return { now_s: told.now_s, end_s };
  const now_s = told.now_s + since_s * told.rate;
  return { now_s: looped(now_s, told, end_s), end_s };
}

/** @param {number} now_s @param {Running} told @param {number} end_s @returns {number} at most the end, and within what is looped */
function looped(now_s, { loop, now_s: before_s }, end_s) {
  const [begin, end] = loop ?? [];
  // Whoever plays from behind the part goes on to the end.
  if (begin === undefined || end === undefined || end <= begin || before_s > end)
    return Math.min(now_s, end_s);
  return now_s < end ? now_s : begin + ((now_s - begin) % (end - begin));
}

/** What a wheel reaches at most: some hundred messages of a fast topic lie side by side. */
const SEEN_LEAST_S = 0.01;

/** @param {Range} whole @returns {Range} as wide that something can be seen in it */
const wideEnough = ({ from_s, to_s }) =>
  to_s - from_s >= SEEN_LEAST_S ? { from_s, to_s } : { from_s, to_s: from_s + SEEN_LEAST_S };

/** @param {Range} range @param {Range} whole @returns {Range} as wide as it was, within the whole */
function within(range, whole) {
  const { from_s, to_s } = wideEnough(whole);
  const width_s = Math.min(range.to_s - range.from_s, to_s - from_s);
  const begin_s = clamp(range.from_s, from_s, to_s - width_s);
  return { from_s: begin_s, to_s: begin_s + width_s };
}

/** @param {Range} range @param {number} factor above 1: less is seen @param {number} at_s stays where it is @param {Range} whole @returns {Range} */
export function zoomedTime(range, factor, at_s, whole) {
  const width_s = Math.max((range.to_s - range.from_s) / factor, SEEN_LEAST_S);
  const share = (at_s - range.from_s) / (range.to_s - range.from_s || 1);
  const from_s = at_s - share * width_s;
  return within({ from_s, to_s: from_s + width_s }, whole);
}

/** @param {Range} range @param {number} by_s @param {Range} whole @returns {Range} */
export const pannedTime = ({ from_s, to_s }, by_s, whole) =>
  within({ from_s: from_s + by_s, to_s: to_s + by_s }, whole);

/** @param {Range | null} range null: the whole @param {Range} whole @returns {Range} what is seen */
export const seenTime = (range, whole) => (range ? within(range, whole) : wideEnough(whole));

/** @param {Range} range @param {number} now_s @param {Range} whole @returns {Range} turned over like a page when the time has left it */
export function followedTime(range, now_s, whole) {
  if (now_s >= range.from_s && now_s <= range.to_s) return range;
  return within({ from_s: now_s, to_s: now_s + range.to_s - range.from_s }, whole);
}

/** @param {number} at_s @param {Range} range @param {number} width_px @returns {number} px from the left */
export const placeOf = (at_s, { from_s, to_s }, width_px) =>
  ((at_s - from_s) / (to_s - from_s)) * width_px;

/** @param {number} x_px @param {Range} range @param {number} width_px @returns {number} */
export const timeAt = (x_px, { from_s, to_s }, width_px) =>
  from_s + (x_px / Math.max(width_px, 1)) * (to_s - from_s);

const STEPS_S = [
  0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900,
  1800, 3600, 7200, 14_400, 21_600, 43_200, 86_400,
];
const STEP_LEAST_PX = 74;

/** @param {Range} range @param {number} width_px @returns {{step_s: number, times: number[]}} where a ruler has its words */
export function rulerSteps(range, width_px) {
  const width_s = range.to_s - range.from_s;
  const least_s = (width_s * STEP_LEAST_PX) / Math.max(width_px, 1);
  const day = STEPS_S.at(-1) ?? 1;
  const step_s = STEPS_S.find((one) => one >= least_s) ?? Math.ceil(least_s / day) * day;
  const first = Math.ceil(range.from_s / step_s - 1e-9);
  const last = Math.floor(range.to_s / step_s + 1e-9);
  return {
    step_s,
    times: Array.from({ length: Math.max(last - first + 1, 0) }, (_, n) => (first + n) * step_s),
  };
}

/** @param {number} step_s @returns {number} places behind the point that tell two steps apart */
export const placesOf = (step_s) => clamp(Math.ceil(-Math.log10(step_s) - 1e-9), 0, 3);

/** @param {number} seconds @param {number} [places] behind the point @returns {string} as 0:07.5, 3:20, 1:02:03 */
export function sinceStart(seconds, places = 0) {
  const scale = 10 ** places;
  const units = Math.round(Math.abs(seconds) * scale);
  const whole = Math.floor(units / scale);
  const two = (/** @type {number} */ number) => String(number).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  const start = hours > 0 ? `${hours}:${two(minutes)}` : String(minutes);
  const part = places > 0 ? `.${String(units % scale).padStart(places, "0")}` : "";
  return `${seconds < 0 && units > 0 ? "-" : ""}${start}:${two(whole % 60)}${part}`;
}

/** A part without messages is a gap from here. */
const GAP_PX = 6;

/** @param {readonly number[]} counts of equal parts @param {number} part_px width of one @returns {[number, number][]} the parts of each gap between messages, the second one is behind it */
export function gapsIn(counts, part_px) {
  const least = Math.max(Math.ceil(GAP_PX / Math.max(part_px, 1e-9)), 1);
  /** @type {[number, number][]} */
  const gaps = [];
  let last = -1;
  counts.forEach((count, n) => {
    if (count === 0) return;
    if (last >= 0 && n - last - 1 >= least) gaps.push([last + 1, n]);
    last = n;
  });
  return gaps;
}

/**
 * @template {{at_s: number}} T
 * @param {readonly T[]} all @param {number} at_s @param {number} reach_s
 * @returns {T | null} the nearest within reach
 */
export function nearestTo(all, at_s, reach_s) {
  /** @type {T | null} */
  let found = null;
  let reach = reach_s;
  for (const one of all) {
    const apart = Math.abs(one.at_s - at_s);
    if (apart > reach) continue;
    reach = apart;
    found = one;
  }
  return found;
}

export const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const STEP_S = 1;

/**
 * @param {{key: string, shiftKey: boolean, altKey: boolean, ctrlKey: boolean, metaKey: boolean}} stroke
 * @param {number} now_s @param {Range} whole
 * @returns {number | null} where a key leads; null: it is none of a ruler's
 */
export function timeAfterKey({ key, shiftKey, altKey, ctrlKey, metaKey }, now_s, whole) {
  if (ctrlKey || metaKey) return null;
  const by = STEP_S * (shiftKey ? 10 : 1) * (altKey ? 0.1 : 1);
  const page = (whole.to_s - whole.from_s) / 10;
  /** @type {Record<string, number>} */
  const targets = {
    ArrowRight: now_s + by,
    ArrowUp: now_s + by,
    ArrowLeft: now_s - by,
    ArrowDown: now_s - by,
    PageUp: now_s + page,
    PageDown: now_s - page,
    Home: whole.from_s,
    End: whole.to_s,
  };
  const target = targets[key];
  return target === undefined ? null : clamp(target, whole.from_s, whole.to_s);
}

/** @param {number} bytes @returns {string} of thousands, as disks count */
export function sizeWords(bytes) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  const step = clamp(Math.floor(Math.log10(Math.max(bytes, 1)) / 3 + 1e-9), 0, units.length - 1);
  const value = bytes / 1000 ** step;
  return `${step > 0 && value < 9.95 ? value.toFixed(1) : Math.round(value)} ${units[step]}`;
}
