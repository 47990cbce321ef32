/** What a demo printed, as far as this page was told. */

/** @import { DemoOutput } from "../types/wire.d.ts" */

/** As many lines as the studio keeps. */
const LINES_MAX = 200;

/** @typedef {Pick<DemoOutput, "run" | "lines" | "last">} Output */
/** @type {Output} */
export const NOTHING_PRINTED = { run: 0, lines: [], last: 0 };

/** @param {Output} known @param {Output} told since then; of another run it takes the place of all @returns {Output} */
export function withPrinted(known, told) {
  if (told.run !== known.run) return told;
  if (told.lines.length === 0) return known;
  return { ...told, lines: [...known.lines, ...told.lines].slice(-LINES_MAX) };
}
