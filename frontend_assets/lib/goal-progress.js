/** How far a goal is, as its feedback tells: a share of the whole, or what is left of it. */

const SHARE =
  /(^|_)(progress|percent|percentage|pct|completion|completed|complete|fraction|ratio)(_|$)/i;
const OF_HUNDRED = /(^|_)(percent|percentage|pct)(_|$)/i;
const LEFT = /(^|_)(remaining|left|to_go)(_|$)/i;
const DEPTH_MAX = 3;

/**
 * @param {readonly unknown[]} log feedback as plain values, the oldest first
 * @returns {{name: string, share: number} | null} 0 to 1; null: no field tells it
 */
export function progressOf(log) {
  const newest = leavesOf(log.at(-1), "", 0);
  const told = newest.find(({ name }) => SHARE.test(name));
  if (told) return { name: told.name, share: within(told.value / scaleOf(log, told.name)) };
  const left = newest.find(({ name }) => LEFT.test(name));
  if (!left) return null;
  const most = Math.max(...valuesOf(log, left.name));
  return most > 0 ? { name: left.name, share: within(1 - left.value / most) } : null;
}

/** @param {readonly unknown[]} log @param {string} name 100 where it is told in percent */
function scaleOf(log, name) {
  return OF_HUNDRED.test(name) || valuesOf(log, name).some((value) => value > 1) ? 100 : 1;
}

/** @param {readonly unknown[]} log @param {string} name @returns {number[]} */
function valuesOf(log, name) {
  return log.flatMap((one) =>
    leavesOf(one, "", 0)
      .filter((leaf) => leaf.name === name)
      .map(({ value }) => value),
  );
}

/** @param {unknown} value @param {string} name @param {number} depth @returns {{name: string, value: number}[]} numbers by the names of their fields */
function leavesOf(value, name, depth) {
  if (typeof value === "number") return [{ name, value }];
  if (typeof value !== "object" || value === null || Array.isArray(value) || depth > DEPTH_MAX)
    return [];
  return Object.entries(value).flatMap(([key, inner]) => leavesOf(inner, key, depth + 1));
}

/** @param {number} share */
const within = (share) => Math.min(Math.max(share, 0), 1);
