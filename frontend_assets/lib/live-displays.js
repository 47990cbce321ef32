/**
 * Live displays as rows of a tree: their groups, their order, where a dragged row comes to stand,
 * and which of their properties mean something.
 */

/** @import { DisplayState, DisplayView, PropertyView, TopicView } from "../types/wire.d.ts" */

/** @typedef {boolean | number | string} Value */
/** @typedef {{display: DisplayView} | {group: string, members: DisplayView[]}} Entry one at the top of the list */

/**
 * @param {ReadonlySet<string> | null} before ids; null: nothing was told yet
 * @param {readonly DisplayView[]} now
 * @returns {DisplayView | undefined} the one that a person added; several at once came with their robot
 */
export function addedDisplay(before, now) {
  const added = before === null ? [] : now.filter(({ id }) => !before.has(id));
  return added.length === 1 ? added[0] : undefined;
}

/** @param {readonly DisplayView[]} displays @returns {Entry[]} a group stands where its first member stands */
export function inGroups(displays) {
  /** @type {Map<string, DisplayView[]>} */
  const groups = new Map();
  /** @type {Entry[]} */
  const entries = [];
  for (const display of displays) {
    const members = groups.get(display.group);
    if (display.group === "") entries.push({ display });
    else if (members) members.push(display);
    else {
      const first = [display];
      groups.set(display.group, first);
      entries.push({ group: display.group, members: first });
    }
  }
  return entries;
}

/** @param {Entry} entry @returns {readonly DisplayView[]} */
const membersOf = (entry) => ("display" in entry ? [entry.display] : entry.members);

/**
 * Where what stands at a place of a list comes to stand when it goes one place up or down.
 *
 * @param {readonly DisplayView[]} all in their order
 * @param {readonly (readonly DisplayView[])[]} list of what moves as one
 * @param {number} at
 * @param {1 | -1} step
 * @returns {{display: string, before: string}[] | null} what is to be moved, one after the other; null: it is at the end
 */
function stepped(all, list, at, step) {
  const over = list[at + step];
  const moved = list[at];
  if (!over || !moved) return null;
  const last = over.at(-1);
  // At the end of a group it stays before what follows the group.
  const behind = list[at + 2]?.[0] ?? all[last ? all.indexOf(last) + 1 : all.length];
  const before = step < 0 ? over[0] : behind;
  return moved.map(({ id }) => ({ display: id, before: before?.id ?? "" }));
}

/**
 * @param {readonly DisplayView[]} displays
 * @param {string} id
 * @param {1 | -1} step up is -1
 * @returns {{display: string, before: string}[] | null} null: it stands at the end of its group or list
 */
export function moveOfDisplay(displays, id, step) {
  const group = displays.find((one) => one.id === id)?.group ?? "";
  const entries = inGroups(displays).map(membersOf);
  const list =
    group === "" ? entries : displays.filter((one) => one.group === group).map((one) => [one]);
  const at = list.findIndex((members) => members[0]?.id === id);
  return at < 0 ? null : stepped(displays, list, at, step);
}

/** @param {readonly DisplayView[]} displays @param {string} group @param {1 | -1} step */
export function moveOfGroup(displays, group, step) {
  const list = inGroups(displays).map(membersOf);
  const at = list.findIndex((members) => members[0]?.group === group);
  return at < 0 ? null : stepped(displays, list, at, step);
}

/** @param {readonly DisplayView[]} displays @returns {string[]} names of groups, each once */
export const groupNames = (displays) => [
  ...new Set(displays.map(({ group }) => group).filter((group) => group !== "")),
];

/** @param {readonly string[]} taken @param {string} stem @returns {string} a name that is not taken */
export function freeName(taken, stem) {
  let number = 1;
  while (taken.includes(`${stem} ${number}`)) number += 1;
  return `${stem} ${number}`;
}

/**
 * @param {PropertyView} property
 * @param {ReadonlyMap<string, PropertyView>} properties of its display, by name
 * @param {(name: string) => Value | undefined} value
 * @returns {boolean} with the others as they are it changes what is seen
 */
export function counts(property, properties, value) {
  const seen = new Set();
  let one = /** @type {PropertyView | undefined} */ (property);
  while (one?.when && !seen.has(one.name)) {
    seen.add(one.name);
    const now = value(one.when);
    if (now !== undefined && !one.when_values.includes(now)) return false;
    one = properties.get(one.when);
  }
  return true;
}

/**
 * @typedef {object} SettingRow
 * @property {string} path its full name; of a group without a value of its own that of the group
 * @property {string} label the last part
 * @property {number} depth from 0
 * @property {boolean} folds others stand below it
 * @property {PropertyView | null} property null: a group and no more
 */

/**
 * Properties with slashes in their names as a tree, in their order.
 *
 * @param {readonly PropertyView[]} properties those that count
 * @param {(path: string) => boolean} isOpen
 * @returns {SettingRow[]}
 */
export function settingRows(properties, isOpen) {
  const own = new Map(properties.map((one) => [one.name, one]));
  const paths = [...new Set(properties.flatMap(({ name }) => pathsTo(name)))];
  const folding = new Set(paths.map(above));
  return ordered(paths)
    .filter((path) => pathsTo(above(path)).every((outer) => outer === "" || isOpen(outer)))
    .map((path) => ({
      path,
      label: path.slice(above(path).length).replace(/^\//, ""),
      depth: pathsTo(path).length - 1,
      folds: folding.has(path),
      property: own.get(path) ?? null,
    }));
}

/** @param {string} path @returns {string} */
const above = (path) => path.slice(0, Math.max(0, path.lastIndexOf("/")));

/** @param {string} name @returns {string[]} "a/b/c": "a", "a/b", "a/b/c" */
function pathsTo(name) {
  const parts = name.split("/");
  return parts.map((_, n) => parts.slice(0, n + 1).join("/"));
}

/** @param {readonly string[]} paths @returns {string[]} each with all below it, else in the order given */
function ordered(paths) {
  /** @type {Map<string, string[]>} */
  const below = new Map();
  for (const path of paths) below.set(above(path), [...(below.get(above(path)) ?? []), path]);
  /** @type {(path: string) => string[]} */
  const walk = (path) => [path, ...(below.get(path) ?? []).flatMap(walk)];
  return (below.get("") ?? []).flatMap(walk);
}

/** @param {number} rate_hz @returns {string} as short as it says enough; empty: nothing comes */
export function rateWords(rate_hz) {
  if (rate_hz <= 0) return "";
  return `${rate_hz < 10 ? rate_hz.toFixed(1) : Math.round(rate_hz)} Hz`;
}

/** @param {DisplayState | undefined} state @returns {DisplayState["remarks"][number] | null} what is in the way first */
export const firstTrouble = (state) => state?.remarks.find(({ level }) => level !== "ok") ?? null;

/** @param {readonly TopicView[]} topics @param {string} words @returns {TopicView[]} those that can be shown first */
export function foundTopics(topics, words) {
  const found = topics.filter(({ name, types, kind }) =>
    includesAll([name, ...types, kind].join(" "), words),
  );
  return [...found.filter(({ kind }) => kind !== ""), ...found.filter(({ kind }) => kind === "")];
}

/** @param {string} text @param {string} words @returns {boolean} */
export function includesAll(text, words) {
  const all = text.toLowerCase();
  return words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => all.includes(word));
}

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
