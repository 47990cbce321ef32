/** How the parts of a robot are: levels, what is shown of them, and in which groups. */

/** @import { DiagnosticView } from "../types/wire.d.ts" */

/** By their numbers. */
export const LEVELS = /** @type {const} */ (["ok", "warn", "error", "stale"]);
/** @typedef {typeof LEVELS[number]} Level */
/** @typedef {{least: Level, words: string}} Filter `stale` is graver than an error: nothing is known */

/** Who speaks of itself does so every second or so. */
const SILENT_S = 10;

/** @param {Pick<DiagnosticView, "level" | "age_s">} part @returns {Level} a part that fell silent is stale, whatever it said */
export const levelOf = ({ level, age_s: age }) =>
  age > SILENT_S ? "stale" : (LEVELS[level] ?? "error");

/** @param {readonly DiagnosticView[]} parts @param {Filter} filter @returns {DiagnosticView[]} the gravest first */
export function shownParts(parts, { least, words }) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const rank = (/** @type {DiagnosticView} */ part) => LEVELS.indexOf(levelOf(part));
  return parts
    .filter((part) => rank(part) >= LEVELS.indexOf(least))
    .filter(({ name, hardware, message }) =>
      wanted.every((one) => `${name} ${hardware} ${message}`.toLowerCase().includes(one)),
    )
    .sort((a, b) => rank(b) - rank(a));
}

/** @param {readonly DiagnosticView[]} parts @returns {Map<string, DiagnosticView[]>} by hardware, that of the gravest first */
export function byHardware(parts) {
  /** @type {Map<string, DiagnosticView[]>} */
  const groups = new Map();
  for (const part of parts) {
    const group = groups.get(part.hardware);
    if (group) group.push(part);
    else groups.set(part.hardware, [part]);
  }
  return groups;
}

/** @param {readonly DiagnosticView[]} parts @returns {Record<Level, number>} */
export function levelCounts(parts) {
  const counts = { ok: 0, warn: 0, error: 0, stale: 0 };
  for (const part of parts) counts[levelOf(part)] += 1;
  return counts;
}
