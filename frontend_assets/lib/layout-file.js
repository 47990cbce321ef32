/** Layouts as a file: what is written into it, and what is believed of one that comes back. */

/** @import { Arrangement } from "./arrangement.js" */

import { readArrangement } from "./arrangement.js";

/** @typedef {{name: string, arrangement: Arrangement}} OwnLayout */

const VERSION = 1;
const NAME_LONGEST = 60;
export const LAYOUTS_MOST = 50;
/** Bytes; fifty layouts of thirty panels take a tenth of it. */
export const FILE_LARGEST = 1_000_000;

/** The file is none; `reason` is the key of the words for it. */
export class LayoutFileError extends Error {
  /** @param {"layouts.import.no_json" | "layouts.import.no_layouts" | "layouts.import.newer" | "layouts.import.too_large"} reason */
  constructor(reason) {
    super(reason);
    this.reason = reason;
  }
}

/** @param {readonly OwnLayout[]} layouts @returns {string} */
export function layoutFile(layouts) {
  return `${JSON.stringify({ studio_layouts: VERSION, layouts }, null, 2)}\n`;
}

/**
 * @param {string} text
 * @param {(id: string) => boolean} isKnown whether there is such a panel
 * @returns {{layouts: OwnLayout[], dropped: string[]}} `dropped`: panels that this studio does not have
 * @throws {LayoutFileError}
 */
export function readLayoutFile(text, isKnown) {
  if (text.length > FILE_LARGEST) throw new LayoutFileError("layouts.import.too_large");
  const { studio_layouts: version, layouts } =
    /** @type {{studio_layouts?: unknown, layouts?: unknown}} */ (parsed(text) ?? {});
  if (typeof version !== "number" || !Array.isArray(layouts))
    throw new LayoutFileError("layouts.import.no_layouts");
  if (version > VERSION) throw new LayoutFileError("layouts.import.newer");
  const read = readLayouts(layouts, isKnown);
  if (read.layouts.length === 0) throw new LayoutFileError("layouts.import.no_layouts");
  return read;
}

/** @param {string} text @returns {unknown} */
function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new LayoutFileError("layouts.import.no_json");
  }
}

/**
 * @param {readonly unknown[]} stored
 * @param {(id: string) => boolean} isKnown
 * @returns {{layouts: OwnLayout[], dropped: string[]}} those that can be read, each name once
 */
export function readLayouts(stored, isKnown) {
  /** @type {OwnLayout[]} */
  const layouts = [];
  const dropped = new Set();
  for (const one of stored.slice(0, LAYOUTS_MOST)) {
    const { name, arrangement } = /** @type {{name?: unknown, arrangement?: unknown}} */ (
      one ?? {}
    );
    const read = readArrangement(arrangement, isKnown);
    const called = typeof name === "string" ? tidyName(name) : "";
    if (!read || called === "") continue;
    layouts.push({ name: freeName(called, layouts), arrangement: read.arrangement });
    for (const id of read.dropped) dropped.add(id);
  }
  return { layouts, dropped: [...dropped] };
}

/** @param {string} name @returns {string} on one line and not too long */
export function tidyName(name) {
  return name.replace(/\s+/g, " ").trim().slice(0, NAME_LONGEST);
}

/** @param {string} name @param {readonly OwnLayout[]} taken @returns {string} it, or with a number behind it */
export function freeName(name, taken) {
  const isTaken = (/** @type {string} */ wanted) => taken.some((one) => one.name === wanted);
  if (!isTaken(name)) return name;
  let count = 2;
  while (isTaken(`${name} ${count}`)) count += 1;
  return `${name} ${count}`;
}
