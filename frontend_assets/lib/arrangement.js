/** Where panels stand, in words of our own: a tree of rows and columns that a file may hold, too. */

/** @import { SerializedDockview } from "vendor/dockview.js" */

/**
 * A leaf holds tabs, one of which is shown; in a split the parts stand across their parent.
 * @typedef {{tabs: string[], size: number, shown?: string} | {split: Split[], size: number}} Split
 */

/**
 * Sizes count only in relation to those beside them.
 * @typedef {{upright?: boolean, parts: Split[]}} Arrangement `upright`: the parts stand above one another
 */

/** No window holds more than this; a file from elsewhere may claim anything. */
const DEPTH_MOST = 8;
const LEAST_SIZE = 1;

/** @param {Split} part @returns {string[]} the panels of it, in order */
export function tabsOf(part) {
  return "split" in part ? part.split.flatMap(tabsOf) : part.tabs;
}

/**
 * Read what was stored or came from a file; nothing of it is believed.
 *
 * @param {unknown} stored
 * @param {(id: string) => boolean} isKnown
 * @returns {{arrangement: Arrangement, dropped: string[]} | null} without the panels that are not
 *   known or stand there twice; null: it is no arrangement or nothing is left of it
 */
export function readArrangement(stored, isKnown) {
  const { parts, upright } = /** @type {{parts?: unknown, upright?: unknown}} */ (stored ?? {});
  if (!Array.isArray(parts)) return null;
  const seen = new Set();
  /** @type {string[]} */
  const dropped = [];
  /** @param {string} id @returns {boolean} it has its place here */
  const admit = (id) => {
    if (seen.has(id)) return false;
    seen.add(id);
    if (!isKnown(id)) dropped.push(id);
    return isKnown(id);
  };
  const read = parts.flatMap((part) => readPart(part, admit, 1));
  if (read.length === 0) return null;
  return { arrangement: { upright: upright === true, parts: read }, dropped };
}

/** @param {unknown} part @param {(id: string) => boolean} admit @param {number} depth @returns {Split[]} one or none */
function readPart(part, admit, depth) {
  if (typeof part !== "object" || part === null || depth > DEPTH_MOST) return [];
  const { size, tabs, split, shown } =
    /** @type {{size?: unknown, tabs?: unknown, split?: unknown, shown?: unknown}} */ (part);
  const across = Number.isFinite(size) ? Math.max(Number(size), LEAST_SIZE) : LEAST_SIZE;
  if (Array.isArray(split)) {
    const inner = split.flatMap((one) => readPart(one, admit, depth + 1));
    return inner.length > 0 ? [{ split: inner, size: across }] : [];
  }
  const ids = Array.isArray(tabs)
    ? tabs.filter((id) => typeof id === "string").filter((id) => admit(id))
    : [];
  if (ids.length === 0) return [];
  const front = typeof shown === "string" && ids.includes(shown) ? { shown } : {};
  return [{ tabs: ids, size: across, ...front }];
}

/**
 * @param {Arrangement} arrangement
 * @param {{width: number, height: number}} room px
 * @param {(id: string) => object} described a panel, as dockview stores it
 * @returns {SerializedDockview} the arrangement in dockview's own words
 */
export function toDockview({ upright = false, parts }, { width, height }, described) {
  let count = 0;
  /** @param {Split} part @returns {object} */
  const node = (part) => {
    if ("split" in part) return { type: "branch", size: part.size, data: part.split.map(node) };
    count += 1;
    const data = { id: String(count), views: part.tabs, activeView: part.shown ?? part.tabs[0] };
    return { type: "leaf", size: part.size, data };
  };
  const scaled = scaledTo(parts, upright ? [height, width] : [width, height]);
  const root = { type: "branch", size: upright ? width : height, data: scaled.map(node) };
  const used = parts.flatMap(tabsOf);
  const layout = {
    grid: { root, width, height, orientation: upright ? "VERTICAL" : "HORIZONTAL" },
    panels: Object.fromEntries(used.map((id) => [id, described(id)])),
    activeGroup: "1",
  };
  return /** @type {SerializedDockview} */ (/** @type {unknown} */ (layout));
}

/** @param {Split[]} parts @param {[number, number]} room along them and across, px @returns {Split[]} that fill it */
function scaledTo(parts, [along, across]) {
  const sum = parts.reduce((all, { size }) => all + size, 0);
  return parts.map((part) => {
    const size = (part.size / sum) * along;
    return "split" in part
      ? { split: scaledTo(part.split, [across, size]), size }
      : { ...part, size };
  });
}

/** @typedef {{type: string, size?: number, data: DockviewNode[] | {views?: string[], activeView?: string}}} DockviewNode */

/** @param {SerializedDockview} stored @returns {Arrangement} what dockview shows now */
export function fromDockview({ grid }) {
  const root = /** @type {DockviewNode} */ (/** @type {unknown} */ (grid.root));
  const parts = Array.isArray(root.data) ? root.data : [root];
  return { upright: grid.orientation === "VERTICAL", parts: parts.flatMap(partOf) };
}

/** @param {DockviewNode} node @returns {Split[]} one, or none of a group without tabs */
function partOf({ size = LEAST_SIZE, data }) {
  if (Array.isArray(data)) return [{ split: data.flatMap(partOf), size }];
  const { views = [], activeView } = data;
  if (views.length === 0) return [];
  return [{ tabs: [...views], size, ...(activeView ? { shown: activeView } : {}) }];
}
