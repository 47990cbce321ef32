/** A message as rows of a tree: which are open, what each says, and which are numbers to be drawn. */

import { shownNumber } from "./numbers.js";

/** @typedef {{"@list": number, items: any[]}} LongListCut */
/** @typedef {{"@text": number, begin: string}} LongTextCut */

/**
 * @typedef {object} EchoRow
 * @property {string} path as `.pose.position.x`; empty: the message itself
 * @property {string} name
 * @property {number} level from 1
 * @property {string} text its value, or in short what is below it
 * @property {string} whole the same with all digits
 * @property {boolean} expandable
 * @property {boolean} expanded
 * @property {boolean} numeric it can be drawn over time
 * @property {number} shown items of its list that are here; 0: it is none
 * @property {number} more those that are not
 */

/** Lists of so many numbers are said in one row. */
const INLINE_MOST = 6;

/** @param {any} value @returns {value is LongListCut} */
const isCutList = (value) => typeof value === "object" && value !== null && "@list" in value;
/** @param {any} value @returns {value is LongTextCut} */
const isCutText = (value) => typeof value === "object" && value !== null && "@text" in value;

/**
 * @param {any} message as the worker folded it
 * @param {ReadonlySet<string>} toggled paths that are not as they are at first: short things are open, lists are not
 * @returns {EchoRow[]}
 */
export function echoRows(message, toggled) {
  /** @type {EchoRow[]} */
  const rows = [];
  addChildren(rows, message, "", 1, toggled);
  return rows;
}

/** @param {EchoRow[]} rows @param {any} value @param {string} path @param {number} level @param {ReadonlySet<string>} toggled */
function addChildren(rows, value, path, level, toggled) {
  const items = isCutList(value) ? value.items : value;
  const isItems = Array.isArray(items);
  for (const [name, child] of Object.entries(items)) {
    const at = isItems ? `${path}[${name}]` : `${path}.${name}`;
    const row = rowOf(child, at, isItems ? `[${name}]` : name, level, toggled);
    rows.push(row);
    if (row.expanded) addChildren(rows, child, at, level + 1, toggled);
  }
}

/** @param {any} value @param {string} path @param {string} name @param {number} level @param {ReadonlySet<string>} toggled @returns {EchoRow} */
function rowOf(value, path, name, level, toggled) {
  const isList = Array.isArray(value) || isCutList(value);
  const holds = typeof value === "object" && value !== null && !isCutText(value);
  const expandable = holds && countOf(value) > 0;
  const openAtFirst = !isList && !isTime(value);
  return {
    path,
    name,
    level,
    text: echoText(value),
    whole: echoText(value, String),
    expandable,
    expanded: expandable && toggled.has(path) !== openAtFirst,
    numeric: isNumeric(value) || isTime(value),
    shown: isList ? countOf(value) : 0,
    more: isCutList(value) ? value["@list"] - value.items.length : 0,
  };
}

/** @param {any} value @returns {number} */
function countOf(value) {
  if (isCutList(value)) return value.items.length;
  return Array.isArray(value) ? value.length : Object.keys(value).length;
}

/** @param {any} value */
const isNumeric = (value) => ["number", "bigint", "boolean"].includes(typeof value);

/** @param {any} value a time or a span of ROS */
const isTime = (value) =>
  typeof value === "object" && value !== null && "sec" in value && "nanosec" in value;

/** @param {any} value @param {(value: number) => string} [write] @returns {string} in one line */
export function echoText(value, write = numberText) {
  if (typeof value === "number") return write(value);
  if (typeof value === "string") return value;
  if (typeof value !== "object" || value === null) return String(value);
  if (isCutText(value)) return `${value.begin}…`;
  if (isTime(value)) return `${value.sec}.${String(value.nanosec).padStart(9, "0")}`;
  if (isCutList(value)) return listText(value.items, value["@list"], write);
  return Array.isArray(value) ? listText(value, value.length, write) : objectText(value, write);
}

/** @param {number} value @returns {string} whole numbers have all their digits */
const numberText = (value) => (Number.isInteger(value) ? String(value) : shownNumber(value));

/** @param {readonly any[]} items @param {number} count @param {(value: number) => string} write @returns {string} */
function listText(items, count, write) {
  if (count === 0) return "[]";
  const plain = items.slice(0, INLINE_MOST).every((one) => typeof one !== "object");
  if (!plain) return `[${count}]`;
  const shown = items
    .slice(0, INLINE_MOST)
    .map((one) => echoText(one, write))
    .join(", ");
  return count > INLINE_MOST ? `[${count}] ${shown}, …` : `[${shown}]`;
}

/** @param {object} value @param {(value: number) => string} write @returns {string} vectors and poses are said whole */
function objectText(value, write) {
  const parts = Object.entries(value);
  if (parts.length === 0) return "{}";
  if (parts.length > 4 || !parts.every(([, one]) => isNumeric(one))) return "";
  return parts.map(([name, one]) => `${name} ${echoText(one, write)}`).join("  ");
}
