/** Whether something that comes again and again should have come by now. */

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
