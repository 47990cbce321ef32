/** The order in which people are listed, and how they are found by name. */

/** @import { MemberView } from "../../types/wire.d.ts" */

/**
 * @param {readonly MemberView[]} members
 * @param {string} wanted part of a name; empty: all
 * @returns {MemberView[]} who asks for control first, then raised hands, each the earliest first;
 *   then who is here, and who is not, by name
 */
export function listed(members, wanted) {
  const text = wanted.trim().toLowerCase();
  const found = members.filter(({ name }) => name.toLowerCase().includes(text));
  return found.sort(
    (one, other) =>
      groupOf(one) - groupOf(other) ||
      sinceOf(one) - sinceOf(other) ||
      one.name.localeCompare(other.name, undefined, { numeric: true }),
  );
}

/** @param {MemberView} member @returns {number} */
function groupOf({ here, removed, asks_s: asks, hand_s: hand }) {
  if (removed) return 4;
  if (!here) return 3;
  if (asks != null) return 0;
  return hand != null ? 1 : 2;
}

/** @param {MemberView} member @returns {number} since when they wait, in seconds; 0 for who does not */
function sinceOf(member) {
  if (!member.here) return 0;
  return member.asks_s ?? member.hand_s ?? 0;
}
