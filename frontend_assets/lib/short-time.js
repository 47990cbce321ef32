/** A span of time in few letters. */

/** @param {number} seconds @returns {string} a tenth of a second below ten of them, then whole ones, minutes, hours */
export function shortTime(seconds) {
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  if (seconds < 59.5) return `${Math.round(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.round(seconds / 3600)} h`;
}
