/** Where a live display, or a group of them, comes to stand when its row is dropped on another. */

/** @import { DisplayView } from "../types/wire.d.ts" */

import { inGroups } from "./live-displays.js";

/** @typedef {"before" | "after" | "into"} Where */
/** @typedef {{display: string, before: string, group?: string}} Move as the studio is asked for it; `before`: empty at the end */
/** @typedef {{where: Where, moves: Move[]}} Drop */

/** The upper part of a group's row; the rest of it is the way in. */
const ABOVE_GROUP = 0.3;

/**
 * @param {readonly DisplayView[]} displays in their order
 * @param {string} dragged id of a row: `display:…` or `group:…`
 * @param {string} target id of the row it is held over; rows below a display count as it
 * @param {number} share of the target's height, from its top
 * @returns {Drop | null} null: it cannot be dropped there
 */
export function dropOn(displays, dragged, target, share) {
  const moved = displays.filter((one) => isOf(dragged, one));
  const others = displays.filter((one) => !moved.includes(one));
  const place = dragged.startsWith("group:")
    ? besideEntry(others, target, share)
    : anywhere(others, target, share);
  if (!place || moved.length === 0) return null;
  const { where, ...there } = place;
  return { where, moves: moved.map(({ id }) => ({ display: id, ...there })) };
}

/** @param {string} row @param {DisplayView} display */
const isOf = (row, { id, group }) => row === `display:${id}` || row === `group:${group}`;

/** @typedef {{where: Where, before: string, group?: string}} Place */

/** @param {readonly DisplayView[]} others @param {string} target @param {number} share @returns {Place | null} of a display: into and out of groups */
function anywhere(others, target, share) {
  const members = groupOf(others, target);
  if (members.length > 0) return onGroup(others, members, share);
  const over = displayOf(others, target);
  if (!over) return null;
  const { id, group } = over;
  if (isAbove(target, share)) return { where: "before", before: id, group };
  return {
    where: "after",
    before: group === "" ? nextEntry(others, over) : next(others, over),
    group,
  };
}

/** @param {readonly DisplayView[]} others @param {readonly DisplayView[]} members @param {number} share @returns {Place} */
function onGroup(others, members, share) {
  const [first, last] = [members[0], members.at(-1)];
  if (share < ABOVE_GROUP) return { where: "before", before: first?.id ?? "", group: "" };
  return { where: "into", before: next(others, last), group: first?.group ?? "" };
}

/** @param {readonly DisplayView[]} others @param {string} target @param {number} share @returns {Place | null} of a group as a whole: it goes into none */
function besideEntry(others, target, share) {
  const first = groupOf(others, target)[0];
  if (first) return { where: "before", before: first.id };
  const over = displayOf(others, target);
  if (over?.group !== "") return null;
  return isAbove(target, share)
    ? { where: "before", before: over.id }
    : { where: "after", before: nextEntry(others, over) };
}

/** @param {string} target @param {number} share rows below a display are never above it */
const isAbove = (target, share) => target.startsWith("display:") && share < 0.5;

/** @param {readonly DisplayView[]} displays @param {string} row @returns {DisplayView[]} */
const groupOf = (displays, row) =>
  displays.filter(({ group }) => group !== "" && row === `group:${group}`);

/** @param {readonly DisplayView[]} displays @param {string} row of a display, or of what stands below it */
function displayOf(displays, row) {
  const id = /^(?:display|remark|setting):([^:]+)/.exec(row)?.[1];
  return displays.find((one) => one.id === id);
}

/** @param {readonly DisplayView[]} displays @param {DisplayView | undefined} one @returns {string} */
const next = (displays, one) => (one && displays[displays.indexOf(one) + 1]?.id) ?? "";

/** @param {readonly DisplayView[]} displays @param {DisplayView} one in no group @returns {string} what is listed below it */
function nextEntry(displays, one) {
  const entries = inGroups(displays).map((entry) =>
    "display" in entry ? entry.display : entry.members[0],
  );
  return entries[entries.indexOf(one) + 1]?.id ?? "";
}
