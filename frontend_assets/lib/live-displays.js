/** Live displays as rows of a tree: their statuses, and which of their properties mean something. */

/** @import { DisplayState, DisplayView, PropertyView, TopicView } from "../types/wire.d.ts" */

/** @typedef {boolean | number | string} Value */

/**
 * @param {ReadonlySet<string> | null} before ids; null: nothing was told yet
 * @param {readonly DisplayView[]} now
 * @returns {DisplayView | undefined} the one that a person added; several at once came with their robot
 */
export function addedDisplay(before, now) {
  const added = before === null ? [] : now.filter(({ id }) => !before.has(id));
  return added.length === 1 ? added[0] : undefined;
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

/** @typedef {DisplayState["remarks"][number]["level"]} Level */
/** @typedef {{name: "topic" | "transform" | "message" | "group", level: Level, remark: DisplayState["remarks"][number] | null}} Status one line below a display, as RViz has it; `remark`: null where all is well */

const LEVELS = /** @type {const} */ (["ok", "warn", "error"]);

/** @param {readonly Level[]} levels @returns {Level} */
export const worstOf = (levels) =>
  LEVELS[Math.max(0, ...levels.map((level) => LEVELS.indexOf(level)))] ?? "ok";

/** Which of RViz's statuses a reason belongs to; all others are about the message. @type {Record<string, Status["name"]>} */
const STATUS_OF = {
  ...Object.fromEntries(
    [
      "no_topic",
      "no_publisher",
      "other_type",
      "other_hash",
      "not_connected",
      "connection_lost",
      "not_heard",
      "no_message",
      "silent",
    ].map((reason) => [reason, "topic"]),
  ),
  ...Object.fromEntries(
    ["no_frame", "no_frame_id", "not_connected_frame", "stamp_out_of_buffer", "stamp_zero"].map(
      (reason) => [reason, "transform"],
    ),
  ),
  group_off: "group",
};

/**
 * @param {DisplayState | undefined} state
 * @param {boolean} listens it has a topic
 * @returns {Status[]} what is in the way, then what is well
 */
export function statusesOf(state, listens) {
  if (!state || state.remarks.length === 0) return [];
  const troubles = state.remarks
    .filter(({ level }) => level !== "ok")
    .map((remark) => ({
      name: STATUS_OF[remark.reason] ?? /** @type {const} */ ("message"),
      level: remark.level,
      remark,
    }));
  const told = new Set(troubles.map(({ name }) => name));
  if (told.has("group")) return troubles;
  const isDrawn = !told.has("topic") || state.received > 0;
  /** @type {Status[]} */
  const well = [
    ...(listens && !told.has("topic") ? [wellOf("topic")] : []),
    ...(isDrawn && !told.has("transform") ? [wellOf("transform")] : []),
  ];
  return [...troubles, ...well];
}

/** @param {Status["name"]} name @returns {Status} */
const wellOf = (name) => ({ name, level: "ok", remark: null });

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
