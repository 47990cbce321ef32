/** The robot as a tree of links: what hangs on what, and which rows a list of it shows. */

/** @import { JointView, LinkView, Problem, RobotState } from "../types/wire.d.ts" */

/**
 * @typedef {{link: LinkView, joint: JointView | null, children: LinkNode[]}} LinkNode
 * @typedef {{node: LinkNode, level: number, expandable: boolean, expanded: boolean}} LinkRow
 */

/** @type {WeakMap<readonly Problem[], ReadonlySet<string>>} */
const found = new WeakMap();

/**
 * The links that lack an inertia in the eyes of the list of problems: a link that is fixed to one with
 * a mass, or that stands still, may well have none.
 * @param {readonly Problem[]} problems @returns {ReadonlySet<string>}
 */
export function withoutInertia(problems) {
  const known = found.get(problems);
  if (known) return known;
  const links = problems
    .filter(({ code }) => code === "missing-inertial")
    .flatMap(({ parts }) => parts.slice(0, 1))
    .map((part) => part.replace(/^link:/, ""));
  const names = new Set(links);
  found.set(problems, names);
  return names;
}

/**
 * @param {RobotState} robot
 * @returns {LinkNode[]} the root first, then links that hang on nothing known; each link once
 */
export function linkTree(robot) {
  /** @type {Map<string, LinkNode>} */
  const nodes = new Map();
  for (const link of robot.links) nodes.set(link.name, { link, joint: null, children: [] });
  /** @type {Map<LinkNode, LinkNode>} */
  const above = new Map();
  for (const joint of robot.joints) hang(nodes, joint, above);
  const loose = [...nodes.values()].filter((node) => node.joint === null);
  return loose.sort(
    (a, b) => Number(b.link.name === robot.root) - Number(a.link.name === robot.root),
  );
}

/**
 * @param {Map<string, LinkNode>} nodes
 * @param {JointView} joint
 * @param {Map<LinkNode, LinkNode>} above for each that hangs, one that is nearer to its root
 */
function hang(nodes, joint, above) {
  const child = nodes.get(joint.child);
  const parent = nodes.get(joint.parent);
  // What hangs on nothing yet is a root: hung on a link below it, it would close a ring.
  if (!child || !parent || child.joint || rootOf(parent, above) === child) return;
  child.joint = joint;
  parent.children.push(child);
  above.set(child, parent);
}

/** @param {LinkNode} node @param {Map<LinkNode, LinkNode>} above is shortened on the way @returns {LinkNode} */
function rootOf(node, above) {
  let at = node;
  for (let up = above.get(at); up; up = above.get(at)) {
    above.set(at, above.get(up) ?? up);
    at = up;
  }
  return at;
}

/**
 * @param {LinkNode[]} roots
 * @param {ReadonlySet<string>} collapsed names of links whose children are hidden
 * @param {string} filter empty shows all; else links that match and the way to them
 * @param {number} level of the roots
 * @returns {LinkRow[]} in the order in which they are shown
 */
export function linkRows(roots, collapsed, filter, level = 1) {
  const wanted = filter.trim().toLowerCase();
  const shown = wanted === "" ? null : wayTo(roots, wanted);
  /** @type {LinkRow[]} */
  const rows = [];
  // By hand, not by calls: a chain of ten thousand links is deeper than calls may go.
  const waiting = roots.map((node) => ({ node, level })).reverse();
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const { node, level: at } = next;
    if (shown && !shown.has(node)) continue;
    const expandable = node.children.length > 0;
    const expanded = expandable && (shown !== null || !collapsed.has(node.link.name));
    rows.push({ node, level: at, expandable, expanded });
    const below = expanded ? node.children : [];
    for (const child of below.toReversed()) waiting.push({ node: child, level: at + 1 });
  }
  return rows;
}

/** @param {LinkNode[]} roots @param {string} wanted lower case @returns {Set<LinkNode>} those that match, and what is above them */
function wayTo(roots, wanted) {
  const all = [...roots];
  for (let at = 0; at < all.length; at += 1)
    for (const child of all[at]?.children ?? []) all.push(child);
  /** @type {Set<LinkNode>} */
  const found = new Set();
  // From the last back: what hangs on a link comes before it.
  for (const node of all.reverse()) {
    const matches = node.link.name.toLowerCase().includes(wanted);
    if (matches || node.children.some((child) => found.has(child))) found.add(node);
  }
  return found;
}

/** @param {RobotState} robot @param {string} link @returns {string[]} the links above it, nearest first */
export function ancestorsOf(robot, link) {
  const above = new Map(robot.joints.map((joint) => [joint.child, joint.parent]));
  /** @type {Set<string>} */
  const found = new Set();
  for (let at = above.get(link); at !== undefined && !found.has(at); at = above.get(at)) {
    found.add(at);
  }
  return [...found];
}
