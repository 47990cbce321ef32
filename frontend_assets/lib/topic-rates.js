/** How a topic comes, in few letters. */

/** @import { TopicRate } from "../types/wire.d.ts" */

import { rateWords } from "./live-displays.js";
import { shortTime } from "./short-time.js";

const UNITS = /** @type {const} */ (["B/s", "kB/s", "MB/s", "GB/s"]);

/** @param {number} bytes_per_s @returns {string} of three digits at most, of thousands; empty: nothing comes */
export function bandWords(bytes_per_s) {
  if (bytes_per_s <= 0) return "";
  const step = Math.min(
    Math.max(Math.floor(Math.log10(bytes_per_s) / 3 + 1e-9), 0),
    UNITS.length - 1,
  );
  const value = bytes_per_s / 1000 ** step;
  return `${step > 0 && value < 10 ? value.toFixed(1) : Math.round(value)} ${UNITS[step]}`;
}

/** @param {TopicRate | undefined} rate @returns {string} as "30 Hz · 2.8 MB/s"; empty: too few came to tell */
export const flowWords = (rate) =>
  rate ? [rateWords(rate.rate_hz), bandWords(rate.bytes_per_s)].filter(Boolean).join(" · ") : "";

/** @param {TopicRate | undefined} rate @returns {string} since the last message; empty: none came */
export const ageWords = (rate) =>
  rate?.age_s === undefined || rate.age_s === null ? "" : shortTime(rate.age_s);
