/** Rows of a comparison as they are read: in words, filtered, sorted, with the unit of the person. */

/** @import { DifferenceView } from "../types/wire.d.ts" */

import { allDigits, shownNumber } from "./numbers.js";

/** @typedef {"part" | "share" | "size"} Order by part, by per cent, or by the bare difference */

const DEGREES = 180 / Math.PI;

/** @param {string} part `link:name`, `joint:name` or `robot` @returns {{kind: string, name: string}} */
export function partOf(part) {
  const at = part.indexOf(":");
  return at < 0 ? { kind: part, name: "" } : { kind: part.slice(0, at), name: part.slice(at + 1) };
}

/**
 * @param {DifferenceView} row
 * @param {(key: string) => string} word the words of one step of `what`
 * @returns {string} e.g. `Visual 2 radius`
 */
export function rowLabel({ what, number }, word) {
  const [first = "", ...rest] = what.split(".");
  const count = number > 0 ? [String(number)] : [];
  const text = [word(first), ...count, ...rest.map(word)].join(" ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** @param {string} unit @param {boolean} degrees @returns {{unit: string, factor: number}} */
export function shownUnit(unit, degrees) {
  if (!degrees || !/^rad\b/.test(unit)) return { unit: unit.replace("^2", "²"), factor: 1 };
  return { unit: unit.replace("rad", "°"), factor: DEGREES };
}

/** @param {number | string | null} value @param {number} factor @returns {string} empty: it has none */
export function valueText(value, factor) {
  if (value === null) return "";
  return typeof value === "number" ? shownNumber(value * factor) : value;
}

/**
 * @param {string} path of a file
 * @param {number | string | null} beside the path that it is compared with
 * @returns {string} from the first folder on that differs
 */
export function endOf(path, beside) {
  const parts = path.split("/");
  const others = typeof beside === "string" ? beside.split("/") : [];
  const at = parts.findIndex((part, n) => part !== others[n]);
  return parts.slice(at < 0 ? -1 : at).join("/");
}

/** @param {number} value @param {(value: number) => string} write @returns {string} with its sign */
function signed(value, write = shownNumber) {
  const text = write(value);
  return value > 0 ? `+${text}` : text.replace("-", "−");
}

/** @param {DifferenceView} row @param {number} factor @returns {{delta: string, percent: string, whole: string}} empty where there is none; `whole`: both with all digits */
export function changeText({ delta, percent }, factor) {
  return {
    delta: delta === null ? "" : signed(delta * factor),
    percent: percent === null ? "" : `${signed(Number(percent.toPrecision(3)))}\u00a0%`,
    whole: [
      delta === null ? "" : signed(delta * factor, allDigits),
      percent === null ? "" : `${signed(percent, allDigits)}\u00a0%`,
    ]
      .filter(Boolean)
      .join(" "),
  };
}

/**
 * @param {readonly DifferenceView[]} rows
 * @param {string} words all of them must occur in the part or the label
 * @param {(row: DifferenceView) => string} label
 * @returns {DifferenceView[]}
 */
export function matching(rows, words, label) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return rows.filter((row) => {
    const text = `${row.part} ${label(row)}`.toLowerCase();
    return wanted.every((word) => text.includes(word));
  });
}

/**
 * @param {readonly DifferenceView[]} rows as the studio lists them: part by part
 * @param {Order} order largest first; what came or went is before all changes
 * @returns {DifferenceView[]}
 */
export function sorted(rows, order) {
  if (order === "part") return [...rows];
  return [...rows].sort((a, b) => weight(b, order) - weight(a, order));
}

/** @param {DifferenceView} row @param {Order} order @returns {number} */
function weight({ one, other, delta, percent }, order) {
  if (one === null || other === null) return Number.MAX_VALUE;
  if (delta === null) return Number.MAX_VALUE / 2;
  if (order === "size") return Math.abs(delta);
  return percent === null ? Number.MAX_VALUE / 4 : Math.abs(percent);
}

/**
 * @param {readonly DifferenceView[]} rows sorted by part
 * @returns {{part: string, rows: DifferenceView[]}[]} neighbours of one part together
 */
export function grouped(rows) {
  /** @type {{part: string, rows: DifferenceView[]}[]} */
  const groups = [];
  for (const row of rows) {
    const last = groups.at(-1);
    if (last?.part === row.part) last.rows.push(row);
    else groups.push({ part: row.part, rows: [row] });
  }
  return groups;
}
