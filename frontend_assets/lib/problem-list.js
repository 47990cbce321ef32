/** The list of problems as it is read: filtered, by file, worst first; and as text to paste elsewhere. */

/** @import { Problem } from "../types/wire.d.ts" */

/** @typedef {Problem["severity"]} Severity */
/** @typedef {{file: string, problems: readonly Problem[]}} FileProblems `file` empty: of the robot as a whole */

/** @type {readonly Severity[]} */
export const SEVERITIES = ["error", "warning", "info"];

/** @param {readonly Problem[]} problems @returns {Record<Severity, number>} */
export function counts(problems) {
  const found = { error: 0, warning: 0, info: 0 };
  for (const { severity } of problems) found[severity] += 1;
  return found;
}

/**
 * @param {readonly Problem[]} problems
 * @param {string} words each of which must occur somewhere in a problem
 * @param {ReadonlySet<Severity>} hidden
 */
export function filtered(problems, words, hidden) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return problems.filter((one) => {
    if (hidden.has(one.severity)) return false;
    const text = `${one.sentence} ${one.code} ${one.place?.file ?? ""}:${one.place?.line ?? ""}`;
    return wanted.every((word) => text.toLowerCase().includes(word));
  });
}

/** @param {readonly Problem[]} problems @returns {FileProblems[]} the file with the worst first; in one by weight, then line */
export function byFile(problems) {
  /** @type {Map<string, Problem[]>} */
  const files = new Map();
  for (const one of [...problems].sort(byWeight)) {
    const file = one.place?.file ?? "";
    const those = files.get(file);
    if (those) those.push(one);
    else files.set(file, [one]);
  }
  return [...files].map(([file, those]) => ({ file, problems: those }));
}

/** @param {Problem} a @param {Problem} b */
function byWeight(a, b) {
  const weight = SEVERITIES.indexOf(a.severity) - SEVERITIES.indexOf(b.severity);
  if (weight !== 0) return weight;
  const line = (a.place?.line ?? 0) - (b.place?.line ?? 0);
  return line || (a.place?.column ?? 0) - (b.place?.column ?? 0);
}

/** @param {readonly Problem[]} problems @returns {number} how many hinder and have an edit that mends them */
export function mendable(problems) {
  return problems.filter(({ severity, fix }) => severity !== "info" && fix?.action === "edit")
    .length;
}

/** @param {readonly FileProblems[]} files @param {(severity: Severity) => string} word @returns {string} a line for each, `file:line:column: error: sentence` */
export function asText(files, word) {
  return files
    .flatMap(({ problems }) => problems)
    .map(({ severity, sentence, place, code }) => {
      const where = place ? [place.file, place.line, place.column].filter(Boolean).join(":") : "";
      return `${where ? `${where}: ` : ""}${word(severity)}: ${sentence} [${code}]\n`;
    })
    .join("");
}

/** @param {readonly Problem[]} those @returns {{key: string, problem: Problem}[]} two that say the same are told apart by their order */
export function keyed(those) {
  /** @type {Map<string, number>} */
  const seen = new Map();
  return those.map((problem) => {
    const own = keyOf(problem);
    const number = (seen.get(own) ?? 0) + 1;
    seen.set(own, number);
    return { key: `${own}#${number}`, problem };
  });
}

/** @param {Problem} problem @returns {string} the same for the same problem, also when others come and go */
export function keyOf({ code, sentence, place }) {
  return `${code} ${place?.file ?? ""}:${place?.line ?? ""}:${place?.column ?? ""} ${sentence}`;
}
