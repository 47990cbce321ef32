/** What was measured before, as this browser stored it: nothing of it is believed. */

/** @import { Anchor } from "./measuring.js" */
/** @import { Triple } from "./kinematics.js" */

/** So many are read; a person deletes what is not needed any more. */
export const MEASURES_MOST = 100;

/** @param {unknown} stored @returns {readonly (readonly Anchor[])[]} the ends of each; those that are none are left out */
export function readMeasures(stored) {
  if (!Array.isArray(stored)) return [];
  return stored.slice(0, MEASURES_MOST).flatMap((ends) => {
    const read = Array.isArray(ends) ? ends.flatMap((end) => readAnchor(end) ?? []) : [];
    const whole = read.length === ends?.length && (read.length === 2 || read.length === 3);
    return whole ? [read] : [];
  });
}

/** @param {unknown} stored @returns {Anchor | null} */
function readAnchor(stored) {
  const { kind, link, joint, at, normal } =
    /** @type {{kind?: unknown, link?: unknown, joint?: unknown, at?: unknown, normal?: unknown}} */ (
      stored ?? {}
    );
  if (typeof link !== "string") return null;
  if (kind === "frame") return { kind, link };
  if (kind === "axis" && typeof joint === "string") return { kind, link, joint };
  if (kind !== "point" || !isTriple(at)) return null;
  return { kind, link, at, normal: isTriple(normal) ? normal : null };
}

/** @param {unknown} value @returns {value is Triple} */
const isTriple = (value) =>
  Array.isArray(value) && value.length === 3 && value.every((one) => Number.isFinite(one));
