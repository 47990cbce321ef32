/** Times as people say them. */

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
