/** Times as people write them, and whether something that comes again and again is overdue. */

import { useEffect, useRef, useSignal } from "vendor/preact.js";

/** @type {readonly [Intl.RelativeTimeFormatUnit, number][]} each with its length in seconds */
const UNITS = [
  ["year", 31_557_600],
  ["month", 2_629_800],
  ["week", 604_800],
  ["day", 86_400],
  ["hour", 3600],
  ["minute", 60],
];

/** @param {number} then ms @param {number} now ms @param {string} language @returns {string} "2 hours ago" */
export function timeAgo(then, now, language) {
  const format = new Intl.RelativeTimeFormat(language, { numeric: "auto" });
  const ago = Math.max(0, (now - then) / 1000);
  for (const [unit, length] of UNITS) {
    if (ago >= length) return format.format(-Math.floor(ago / length), unit);
  }
  return format.format(0, "second");
}

/** @param {number} seconds @returns {string} a tenth of a second below ten of them, then whole ones, minutes, hours */
export function shortTime(seconds) {
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  if (seconds < 59.5) return `${Math.round(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.round(seconds / 3600)} h`;
}

const NOW_EVERY_MS = 1000;

/** @returns {number} the time in ms, as `performance.now` has it, told anew each second while the component stands */
export function useNow() {
  const now_ms = useSignal(performance.now());
  useEffect(() => {
    const timer = setInterval(() => {
      if (!document.hidden) now_ms.value = performance.now();
    }, NOW_EVERY_MS);
    return () => clearInterval(timer);
  }, []);
  return now_ms.value;
}

/** @param {number} then_ms @param {number} now_ms may be a little older @returns {number} seconds between the two */
export const secondsSince = (then_ms, now_ms) => Math.max(0, now_ms - then_ms) / 1000;

const SILENT_S = 3;
/** So many of its periods without a message make it silent. */
const PERIODS = 3;

/**
 * @param {ArrayLike<number>} times_s of the last that came, the oldest first
 * @param {number} now_s by the same clock
 * @returns {number} since the last one; 0: none is due yet, or none came at all
 */
export function overdue_s(times_s, now_s) {
  const last_s = times_s[times_s.length - 1];
  if (last_s === undefined) return 0;
  const period_s = (last_s - (times_s[0] ?? last_s)) / Math.max(times_s.length - 1, 1);
  const age_s = now_s - last_s;
  return age_s > Math.max(SILENT_S, PERIODS * period_s) ? age_s : 0;
}

const KEPT = 10;
const LOOK_MS = 500;

/** @returns {{came: () => void, silent_s: number}} `came` is to be called for each message; whole seconds */
export function useSilence() {
  const times_s = useRef(/** @type {number[]} */ ([]));
  const silent_s = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => {
      silent_s.value = Math.floor(overdue_s(times_s.current, performance.now() / 1000));
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, []);
  const came = () => {
    times_s.current = [...times_s.current.slice(1 - KEPT), performance.now() / 1000];
    silent_s.value = 0;
  };
  return { came, silent_s: silent_s.value };
}
