/** Where panels stand, in words of our own: a tree of rows and columns that a file may hold, too. */

/** @import { SerializedDockview } from "vendor/dockview.js" */

/**
 * A leaf holds tabs, one of which is shown; in a split the parts stand across their parent.
 * @typedef {{tabs: string[], size: number, shown?: string} | {split: Split[], size: number}} Split
 */

/**
 * A window of tabs over the others: its place and size are shares of the room of all panels.
 * @typedef {{tabs: string[], shown?: string, home?: string, left: number, top: number, width: number, height: number}} Floating `home`: a panel beside which it is docked again
 */

/**
 * Sizes count only in relation to those beside them.
 * @typedef {{upright?: boolean, parts: Split[], floating?: Floating[]}} Arrangement `upright`: the parts stand above one another
 */

/** No window holds more than this; a file from elsewhere may claim anything. */
const DEPTH_MOST = 8;
const LEAST_SIZE = 1;
const FLOATING_MOST = 20;
/** Share of the room; a smaller window could not be taken hold of. */
const LEAST_SHARE = 0.05;

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
  const { parts, upright, floating } =
    /** @type {{parts?: unknown, upright?: unknown, floating?: unknown}} */ (stored ?? {});
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
  const over = Array.isArray(floating) ? floating.slice(0, FLOATING_MOST) : [];
  const windows = over.flatMap((one) => readFloating(one, admit));
  const arrangement = { upright: upright === true, parts: read };
  return {
    arrangement: windows.length > 0 ? { ...arrangement, floating: windows } : arrangement,
    dropped,
  };
}

/** @param {unknown} stored @param {(id: string) => boolean} admit @returns {Floating[]} one or none */
function readFloating(stored, admit) {
  const { left, top, width, height, home, ...part } =
    /** @type {Record<"left" | "top" | "width" | "height" | "home", unknown>} */ (stored ?? {});
  const [read] = readPart(part, admit, DEPTH_MOST);
  if (!read || "split" in read) return [];
  const { size: _, ...tabs } = read;
  const across = { width: share(width, LEAST_SHARE, 0.3), height: share(height, LEAST_SHARE, 0.4) };
  return [
    {
      ...tabs,
      ...(typeof home === "string" && { home }),
      left: Math.min(share(left, 0, 0.3), 1 - across.width),
      top: Math.min(share(top, 0, 0.2), 1 - across.height),
      ...across,
    },
  ];
}

/** @param {unknown} value @param {number} least @param {number} otherwise @returns {number} of the room */
const share = (value, least, otherwise) =>
  typeof value === "number" && Number.isFinite(value)
    ? Math.min(Math.max(value, least), 1)
    : otherwise;

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
 * @param {{width: number, height: number, gap: number}} room px; `gap`: between neighbours
 * @param {(id: string) => object} described a panel, as dockview stores it
 * @returns {SerializedDockview} the arrangement in dockview's own words
 */
export function toDockview(
  { upright = false, parts, floating = [] },
  { width, height, gap },
  described,
) {
  let count = 0;
  /** @param {{tabs: string[], shown?: string}} part */
  const group = ({ tabs, shown }) => {
    count += 1;
    return { id: String(count), views: tabs, activeView: shown ?? tabs[0] };
  };
  /** @param {Split} part @returns {object} */
  const node = (part) => {
    if ("split" in part) return { type: "branch", size: part.size, data: part.split.map(node) };
    return { type: "leaf", size: part.size, data: group(part) };
  };
  const scaled = scaledTo(parts, upright ? [height, width] : [width, height], gap);
  const root = { type: "branch", size: upright ? width : height, data: scaled.map(node) };
  const used = [...parts.flatMap(tabsOf), ...floating.flatMap(({ tabs }) => tabs)];
  const windows = floating.map((one) => ({
    data: group(one),
    position: {
      left: one.left * width,
      top: one.top * height,
      width: one.width * width,
      height: one.height * height,
    },
  }));
  const layout = {
    grid: { root, width, height, orientation: upright ? "VERTICAL" : "HORIZONTAL" },
    panels: Object.fromEntries(used.map((id) => [id, described(id)])),
    ...(windows.length > 0 && { floatingGroups: windows }),
    activeGroup: "1",
  };
  return /** @type {SerializedDockview} */ (/** @type {unknown} */ (layout));
}

/** @param {Split[]} parts @param {[number, number]} room along them and across, px @param {number} gap px @returns {Split[]} that fill it */
function scaledTo(parts, [along, across], gap) {
  const sum = parts.reduce((all, { size }) => all + size, 0);
  const gaps = gap * (parts.length - 1);
  return parts.map((part) => {
    const shown = (part.size / sum) * (along - gaps);
    // The dock takes the gaps off again, of each part as much as of any other.
    const size = shown + gaps / parts.length;
    return "split" in part
      ? { split: scaledTo(part.split, [across, shown], gap), size }
      : { ...part, size };
  });
}

/** @typedef {{type: string, size?: number, data: DockviewNode[] | {views?: string[], activeView?: string}}} DockviewNode */

/** @param {SerializedDockview} stored @returns {Arrangement} what dockview shows now */
export function fromDockview({ grid, floatingGroups = [] }) {
  const root = /** @type {DockviewNode} */ (/** @type {unknown} */ (grid.root));
  const parts = Array.isArray(root.data) ? root.data : [root];
  const windows = /** @type {DockviewWindow[]} */ (/** @type {unknown} */ (floatingGroups));
  const floating = windows.flatMap((one) => floatingOf(one, grid));
  return {
    upright: grid.orientation === "VERTICAL",
    parts: parts.flatMap(partOf),
    ...(floating.length > 0 && { floating }),
  };
}

/** @typedef {Record<"left" | "right" | "top" | "bottom", number | undefined> & {width: number, height: number}} AnchoredBox from two sides, px */
/** @typedef {{data?: {views?: string[], activeView?: string}, grid?: {root: DockviewNode}, position: AnchoredBox}} DockviewWindow with one group, or with several side by side */

/** @param {DockviewWindow} window @param {{width: number, height: number}} room px @returns {Floating[]} one; groups that stand side by side in it become tabs */
function floatingOf({ data, grid, position }, room) {
  const inside = grid ? partOf(grid.root) : data ? partOf({ type: "leaf", data }) : [];
  const tabs = inside.flatMap(tabsOf);
  if (tabs.length === 0 || room.width <= 0 || room.height <= 0) return [];
  const { width, height } = position;
  const left = position.left ?? room.width - width - (position.right ?? 0);
  const top = position.top ?? room.height - height - (position.bottom ?? 0);
  return [
    {
      tabs,
      ...(data?.activeView && { shown: data.activeView }),
      left: left / room.width,
      top: top / room.height,
      width: width / room.width,
      height: height / room.height,
    },
  ];
}

/** @param {DockviewNode} node @returns {Split[]} one, or none of a group without tabs */
function partOf({ size = LEAST_SIZE, data }) {
  if (Array.isArray(data)) return [{ split: data.flatMap(partOf), size }];
  const { views = [], activeView } = data;
  if (views.length === 0) return [];
  return [{ tabs: [...views], size, ...(activeView ? { shown: activeView } : {}) }];
}
