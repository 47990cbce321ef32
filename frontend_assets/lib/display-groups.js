/**
 * Live displays as a tree: groups that may stand in groups, the order of both, and where what is
 * moved by a key or dragged comes to stand. A group is named by its path, as `Navigation/Local`.
 */

/** @import { ArrangeDisplay, ArrangeGroup, DisplayView } from "../types/wire.d.ts" */

/** @typedef {{display: DisplayView} | {group: string, entries: Entry[]}} Entry one of a list */
/** @typedef {Pick<ArrangeDisplay, "type" | "display" | "group" | "before"> | Pick<ArrangeGroup, "type" | "group" | "to" | "before">} Move as the studio is asked for it; `before`: empty at the end */
/** @typedef {"before" | "after" | "into"} Where */
/** @typedef {{where: Where, move: Move}} Drop */
/** @typedef {{group: string, before: string}} Place in which group, and before which display */

const DISPLAY = "display:";
const GROUP = "group:";

/** @param {string} group @returns {string} the one that it stands in; empty: none */
export const outerGroup = (group) => group.slice(0, Math.max(0, group.lastIndexOf("/")));

/** @param {string} group @returns {string} without those that it stands in */
export const groupName = (group) => group.slice(group.lastIndexOf("/") + 1);

/** @param {string} group @returns {string[]} it and those that it stands in, the outermost first */
export function groupsTo(group) {
  if (group === "") return [];
  const names = group.split("/");
  return names.map((_, n) => names.slice(0, n + 1).join("/"));
}

/** @param {string} group @param {string} outer @returns {boolean} it is the other, or stands in it */
export const isWithin = (group, outer) => group === outer || group.startsWith(`${outer}/`);

/** @param {readonly DisplayView[]} displays @returns {Entry[]} a group stands where its first member stands */
export function inGroups(displays) {
  /** @type {Map<string, Entry[]>} */
  const lists = new Map([["", []]]);
  /** @type {(group: string) => Entry[]} */
  const listOf = (group) => {
    const known = lists.get(group);
    if (known) return known;
    /** @type {Entry[]} */
    const entries = [];
    lists.set(group, entries);
    listOf(outerGroup(group)).push({ group, entries });
    return entries;
  };
  for (const display of displays) listOf(display.group).push({ display });
  return listOf("");
}

/** @param {Entry} entry @returns {DisplayView[]} all that are in it */
export const displaysIn = (entry) =>
  "display" in entry ? [entry.display] : entry.entries.flatMap(displaysIn);

/** @param {readonly DisplayView[]} displays @param {string} group @returns {Entry[]} what stands in it */
function listOf(displays, group) {
  /** @type {readonly Entry[]} */
  let entries = inGroups(displays);
  for (const path of groupsTo(group)) {
    const found = entries.find((one) => "group" in one && one.group === path);
    entries = found && "group" in found ? found.entries : [];
  }
  return [...entries];
}

/** @param {readonly DisplayView[]} displays @returns {string[]} paths of all groups, as they are listed */
export function groupPaths(displays) {
  /** @type {(entry: Entry) => string[]} */
  const paths = (entry) => ("group" in entry ? [entry.group, ...entry.entries.flatMap(paths)] : []);
  return inGroups(displays).flatMap(paths);
}

/** @param {readonly string[]} taken @param {string} stem @returns {string} a name that is not taken */
export function freeName(taken, stem) {
  let number = 1;
  while (taken.includes(`${stem} ${number}`)) number += 1;
  return `${stem} ${number}`;
}

/** @param {string} row @param {Entry} entry */
const isRowOf = (row, entry) =>
  row === ("display" in entry ? DISPLAY + entry.display.id : GROUP + entry.group);

/** @param {readonly DisplayView[]} displays @param {string} row @returns {string | null} the group that a row stands in; null: there is no such row */
function groupAround(displays, row) {
  if (row.startsWith(GROUP)) {
    const group = row.slice(GROUP.length);
    return groupPaths(displays).includes(group) ? outerGroup(group) : null;
  }
  return displays.find(({ id }) => row === DISPLAY + id)?.group ?? null;
}

/** @param {Entry | undefined} entry @returns {string} id of the first display in it */
const firstOf = (entry) => (entry && displaysIn(entry)[0]?.id) ?? "";

/**
 * @param {readonly DisplayView[]} displays without what is moved
 * @param {string} group
 * @param {Entry | undefined} entry of its list
 * @returns {string} the display before which stands what comes behind the entry
 */
function behind(displays, group, entry) {
  const list = listOf(displays, group);
  const at = list.findIndex((one) => entry && firstOf(one) === firstOf(entry));
  const next = list[at + 1];
  if (next || group === "") return firstOf(next);
  // At the end of a group it stays before what follows the group.
  const last = entry && displaysIn(entry).at(-1);
  return (last && displays[displays.indexOf(last) + 1]?.id) ?? "";
}

/** @param {string} row @param {readonly DisplayView[]} displays @returns {(one: DisplayView) => boolean} which displays go with it */
function goesWith(row, displays) {
  if (row.startsWith(GROUP)) return ({ group }) => isWithin(group, row.slice(GROUP.length));
  const display = displays.find(({ id }) => row === DISPLAY + id);
  return (one) => one === display;
}

/** @param {string} row @param {Place} place @param {readonly DisplayView[]} others @returns {Move} */
function moveTo(row, { group, before }, others) {
  if (row.startsWith(DISPLAY))
    return { type: "arrange_display", display: row.slice(DISPLAY.length), group, before };
  const own = row.slice(GROUP.length);
  return { type: "arrange_group", group: own, to: freePath(own, group, others), before };
}

/** @param {string} own path @param {string} group that it goes into @param {readonly DisplayView[]} others @returns {string} its path there; one that is taken is another group's */
function freePath(own, group, others) {
  const wanted = group === "" ? groupName(own) : `${group}/${groupName(own)}`;
  const taken = groupPaths(others);
  return taken.includes(wanted) ? freeName(taken, wanted) : wanted;
}

/**
 * @param {readonly DisplayView[]} displays
 * @param {string} row `display:…` or `group:…`
 * @param {1 | -1} step up is -1
 * @returns {Move | null} one place up or down among those it stands with; null: it is at the end
 */
export function stepMove(displays, row, step) {
  const group = groupAround(displays, row);
  if (group === null) return null;
  const list = listOf(displays, group);
  const at = list.findIndex((entry) => isRowOf(row, entry));
  const over = list[at + step];
  if (at < 0 || !over) return null;
  const others = displays.filter((one) => !goesWith(row, displays)(one));
  const before = step < 0 ? firstOf(over) : behind(others, group, over);
  return moveTo(row, { group, before }, others);
}

/** @param {readonly DisplayView[]} displays @param {string} row @returns {Move | null} into the group that stands above it; null: none does */
export function inwardMove(displays, row) {
  const group = groupAround(displays, row);
  if (group === null) return null;
  const list = listOf(displays, group);
  const above = list[list.findIndex((entry) => isRowOf(row, entry)) - 1];
  if (!above || "display" in above) return null;
  return intoMove(displays, row, above.group);
}

/** @param {readonly DisplayView[]} displays @param {string} row @returns {Move | null} behind the group that it stands in; null: it stands in none */
export function outwardMove(displays, row) {
  const group = groupAround(displays, row);
  if (!group) return null;
  const others = displays.filter((one) => !goesWith(row, displays)(one));
  const outer = outerGroup(group);
  const left = listOf(others, outer).find((entry) => isRowOf(GROUP + group, entry));
  const next = displays.filter((one) => isWithin(one.group, group)).at(-1);
  // The last one of a group takes its place.
  const before = left ? behind(others, outer, left) : nextOf(displays, next);
  return moveTo(row, { group: outer, before }, others);
}

/** @param {readonly DisplayView[]} displays @param {DisplayView | undefined} one @returns {string} */
const nextOf = (displays, one) => (one && displays[displays.indexOf(one) + 1]?.id) ?? "";

/** @param {readonly DisplayView[]} displays @param {string} row @param {string} group @returns {Move} to the end of a group; one that is new, or none, is where it stands */
export function intoMove(displays, row, group) {
  const moves = goesWith(row, displays);
  const others = displays.filter((one) => !moves(one));
  const last = others.filter((one) => group !== "" && isWithin(one.group, group)).at(-1);
  const before = last ? nextOf(others, last) : nextOf(displays, displays.filter(moves).at(-1));
  return moveTo(row, { group, before }, others);
}

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
  const moves = goesWith(dragged, displays);
  const others = displays.filter((one) => !moves(one));
  if (others.length === displays.length) return null;
  const place = onGroup(others, target, share) ?? onDisplay(others, target, share);
  if (!place) return null;
  return { where: place.where, move: moveTo(dragged, place, others) };
}

/** @param {readonly DisplayView[]} others @param {string} target @param {number} share @returns {Place & {where: Where} | null} */
function onGroup(others, target, share) {
  const group = target.startsWith(GROUP) ? target.slice(GROUP.length) : "";
  const members = others.filter((one) => group !== "" && isWithin(one.group, group));
  if (members.length === 0) return null;
  if (share < ABOVE_GROUP)
    return { where: "before", before: members[0]?.id ?? "", group: outerGroup(group) };
  return { where: "into", before: nextOf(others, members.at(-1)), group };
}

/** @param {readonly DisplayView[]} others @param {string} target @param {number} share @returns {Place & {where: Where} | null} */
function onDisplay(others, target, share) {
  const id = /^(?:display|remark|setting|status):([^:]+)/.exec(target)?.[1];
  const over = others.find((one) => one.id === id);
  if (!over) return null;
  const { group } = over;
  // Rows below a display are never above it.
  if (target.startsWith(DISPLAY) && share < 0.5) return { where: "before", before: over.id, group };
  return { where: "after", before: behind(others, group, { display: over }), group };
}
