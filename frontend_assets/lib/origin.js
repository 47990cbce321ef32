/** What is told of a part's origin, as lists for the page: its attributes by element, values as read. */

/** @import { Aspect, OriginAttribute } from "../types/wire.d.ts" */

import { parseNumber, shownNumber, toDegrees } from "./numbers.js";

/** @typedef {{element: string, attributes: OriginAttribute[]}} ElementGroup */

/** @param {readonly OriginAttribute[]} attributes @returns {ElementGroup[]} runs of one element */
export function byElement(attributes) {
  /** @type {ElementGroup[]} */
  const groups = [];
  for (const one of attributes) {
    const last = groups.at(-1);
    if (last?.element === one.element) last.attributes.push(one);
    else groups.push({ element: one.element, attributes: [one] });
  }
  return groups;
}

/**
 * @param {string} value one number, or several with blanks between
 * @param {string} unit of the file
 * @param {boolean} degrees angles are shown so
 * @returns {string} shortened to what one can take in, with its unit; other texts as they are
 */
export function valueText(value, unit, degrees) {
  const words = value.trim().split(/\s+/);
  const numbers = words.map(parseNumber);
  if (value.trim() === "" || numbers.some((one) => one === null)) return value;
  const turns = unit === "rad" && degrees;
  const shown = numbers.map((one) => shownNumber(turns ? toDegrees(Number(one)) : Number(one)));
  return `${shown.join("  ")} ${turns ? "°" : unit}`.trim();
}

/** @param {string} text @returns {boolean} something in it was computed or looked up */
export const isComputed = (text) => text.includes("$");

/** By element and attribute: the kind of part that the attribute names. @type {Record<string, string>} */
const REFERENCES = { "parent@link": "link", "child@link": "link", "mimic@joint": "joint" };

/** @param {OriginAttribute} attribute @returns {string | null} key of another part that it names */
export function referredPart({ element, attribute, value }) {
  const kind = REFERENCES[`${element}@${attribute}`];
  return kind ? `${kind}:${value}` : null;
}

/** Aspects in the order in which they are told. */
const ASPECTS = /** @type {const} */ ([
  "size",
  "shape",
  "color",
  "pose",
  "motion",
  "inertia",
  "collision",
  "presence",
  "name",
  "other",
]);

/** @param {Readonly<Record<string, number>>} counts parts by aspect @returns {{aspect: Aspect, count: number}[]} */
export function countedAspects(counts) {
  return ASPECTS.flatMap((aspect) => {
    const count = counts[aspect] ?? 0;
    return count > 0 ? [{ aspect, count }] : [];
  });
}
