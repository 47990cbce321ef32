/**
 * The frames of TF as a tree with what is wrong in it, the way between two frames, and the order
 * in which frames are offered.
 */

/** @import { FrameView, TfFrames } from "../types/wire.d.ts" */

/** Who tells of the robot's own links when nobody on the wire does; a node's name begins with a slash. */
const OWN = "this robot";

/**
 * @typedef {object} FrameRow
 * @property {FrameView} frame
 * @property {number} level from 1
 * @property {boolean} expandable
 * @property {boolean} expanded
 * @property {string} behind the nearest stale frame above it; empty: none
 */

/** @typedef {{at: string, up: boolean}} FrameStep the frame that is reached, and whether it is the parent of the one before */

/** @param {FrameView} frame @returns {boolean} the studio itself tells of it */
export const isOwn = ({ publisher }) => publisher === OWN;

/**
 * @param {readonly FrameView[]} frames
 * @param {string} fixed the frame whose tree comes first
 * @param {ReadonlySet<string>} folded names of frames whose children are hidden
 * @param {string} filter empty shows all; else frames whose name or publisher holds every word, and the way to them
 * @returns {FrameRow[]} in the order in which they are shown, each frame once
 */
export function frameRows(frames, fixed, folded, filter) {
  const byName = new Map(frames.map((frame) => [frame.name, frame]));
  const children = childrenOf(frames, byName);
  const shown = shownBy(frames, byName, filter);
  const roots = rootsOf(frames, byName, fixed).filter(({ name }) => shown?.has(name) ?? true);
  /** @type {FrameRow[]} */
  const rows = [];
  // By hand, not by calls: a chain of frames may be deeper than calls may go.
  const waiting = roots.map((frame) => ({ frame, level: 1, behind: "" })).reverse();
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const { frame, level, behind } = next;
    const below = children.get(frame.name)?.filter(({ name }) => shown?.has(name) ?? true) ?? [];
    const expanded = below.length > 0 && !(shown === null && folded.has(frame.name));
    rows.push({ frame, level, expandable: below.length > 0, expanded, behind });
    if (!expanded) continue;
    const stale = frame.state === "stale" ? frame.name : behind;
    for (const child of below.toReversed())
      waiting.push({ frame: child, level: level + 1, behind: stale });
  }
  return rows;
}

/** @typedef {ReadonlyMap<string, FrameView>} ByName */

/** @param {readonly FrameView[]} frames @param {ByName} byName @returns {Map<string, FrameView[]>} by parent */
function childrenOf(frames, byName) {
  /** @type {Map<string, FrameView[]>} */
  const found = new Map();
  for (const frame of frames) {
    if (!byName.has(frame.parent)) continue;
    const siblings = found.get(frame.parent);
    if (siblings) siblings.push(frame);
    else found.set(frame.parent, [frame]);
  }
  return found;
}

/** @param {readonly FrameView[]} frames @param {ByName} byName @param {string} fixed @returns {FrameView[]} the root of the fixed frame first */
function rootsOf(frames, byName, fixed) {
  const first = upwards(byName, fixed).at(-1);
  const roots = frames.filter(({ parent }) => !byName.has(parent));
  return roots.sort((a, b) => Number(b.name === first) - Number(a.name === first));
}

/** @param {ByName} byName @param {string} name @returns {string[]} the frame and those above it, nearest first; none that is not known */
function upwards(byName, name) {
  /** @type {Set<string>} */
  const way = new Set();
  for (let at = byName.get(name); at && !way.has(at.name); at = byName.get(at.parent))
    way.add(at.name);
  return [...way];
}

/** @param {readonly FrameView[]} frames @param {ByName} byName @param {string} filter @returns {ReadonlySet<string> | null} null: all */
function shownBy(frames, byName, filter) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return null;
  /** @type {Set<string>} */
  const found = new Set();
  for (const { name, publisher } of frames) {
    const text = `${name} ${publisher}`.toLowerCase();
    if (!words.every((word) => text.includes(word))) continue;
    for (const one of upwards(byName, name)) {
      if (found.has(one)) break;
      found.add(one);
    }
  }
  return found;
}

/** @param {readonly FrameView[]} frames @param {string} name @returns {string[]} the frames above one, nearest first */
export const framesAbove = (frames, name) =>
  upwards(new Map(frames.map((frame) => [frame.name, frame])), name).slice(1);

/**
 * @param {readonly FrameView[]} frames
 * @param {string} from
 * @param {string} to
 * @returns {FrameStep[] | null} the frames after `from`; null: nothing connects the two
 */
export function framesBetween(frames, from, to) {
  const byName = new Map(frames.map((frame) => [frame.name, frame]));
  const [up, down] = [upwards(byName, from), upwards(byName, to)];
  if (up.length === 0 || down.length === 0 || up.at(-1) !== down.at(-1)) return null;
  let meeting = "";
  while (up.length > 0 && down.length > 0 && up.at(-1) === down.at(-1)) {
    meeting = /** @type {string} */ (up.pop());
    down.pop();
  }
  const above = up.length > 0 ? [...up.slice(1), meeting] : [];
  return [
    ...above.map((at) => ({ at, up: true })),
    ...down.reverse().map((at) => ({ at, up: false })),
  ];
}

/**
 * @param {readonly FrameView[]} frames
 * @param {string} from
 * @param {readonly FrameStep[]} way
 * @returns {boolean} the studio itself tells of every frame that is passed
 */
export function isOwnWay(frames, from, way) {
  const byName = new Map(frames.map((frame) => [frame.name, frame]));
  let before = from;
  for (const { at, up } of way) {
    const known = byName.get(up ? before : at);
    if (!known || !isOwn(known)) return false;
    before = at;
  }
  return true;
}

/**
 * TF has no word for a link that no joint holds and that holds none, as in a robot of one link.
 *
 * @param {Pick<TfFrames, "frames" | "fixed" | "more">} answer
 * @param {readonly string[]} links of the robot
 * @returns {readonly FrameView[]} with such links as roots
 */
export function withLooseLinks({ frames, fixed, more }, links) {
  const known = new Set(frames.map(({ name }) => name));
  const loose = more > 0 ? [] : links.filter((name) => !known.has(name));
  if (loose.length === 0) return frames;
  const bare = { parent: "", publisher: "", static: false, rate_hz: 0, age_s: null };
  return [
    ...frames,
    ...loose.map((name) => {
      /** @type {FrameView["state"]} */
      const state = name === fixed ? "fresh" : "broken";
      return { ...bare, name, state };
    }),
  ];
}

/** @param {readonly FrameView[]} frames @returns {{stale: number, broken: number}} how many are in trouble */
export function troubleOf(frames) {
  const count = (/** @type {FrameView["state"]} */ state) =>
    frames.filter((one) => one.state === state).length;
  return { stale: count("stale"), broken: count("broken") };
}

const REP_105 = ["earth", "map", "odom", "world", "base_footprint", "base_link"];

/** @param {string} frame @returns {number} its place in REP 105, also below a prefix as in `robot1/odom` */
function placeOf(frame) {
  const at = REP_105.indexOf(frame.split("/").at(-1) ?? "");
  return at < 0 ? REP_105.length : at;
}

/** @param {readonly string[]} frames @returns {string[]} those without a place in REP 105 keep their order */
export const inFrameOrder = (frames) =>
  [...frames].sort((one, other) => placeOf(one) - placeOf(other));
