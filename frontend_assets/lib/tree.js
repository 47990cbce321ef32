/** The robot as a tree of links: what hangs on what, and which rows a list of it shows. */

/** @import { JointView, LinkView, RobotState } from "../types/wire.d.ts" */

/**
 * @typedef {{link: LinkView, joint: JointView | null, children: LinkNode[]}} LinkNode
 * @typedef {{node: LinkNode, level: number, expandable: boolean, expanded: boolean}} LinkRow
 */

/**
 * @param {RobotState} robot
 * @returns {LinkNode[]} the root first, then links that hang on nothing known; each link once
 */
export function linkTree(robot) {
  /** @type {Map<string, LinkNode>} */
  const nodes = new Map();
  for (const link of robot.links) nodes.set(link.name, { link, joint: null, children: [] });
  for (const joint of robot.joints) hang(nodes, joint);
  const loose = [...nodes.values()].filter((node) => node.joint === null);
  return loose.sort(
    (a, b) => Number(b.link.name === robot.root) - Number(a.link.name === robot.root),
  );
}

/** @param {Map<string, LinkNode>} nodes @param {JointView} joint */
function hang(nodes, joint) {
  const child = nodes.get(joint.child);
  const parent = nodes.get(joint.parent);
  if (!child || !parent || child.joint || isBelow(parent, child, nodes)) return;
  child.joint = joint;
  parent.children.push(child);
}

/**
 * @param {LinkNode} node
 * @param {LinkNode} ancestor
 * @param {Map<string, LinkNode>} nodes
 * @returns {boolean} hanging `ancestor` on `node` would close a ring
 */
function isBelow(node, ancestor, nodes) {
  /** @type {LinkNode | undefined} */
  let at = node;
  while (at) {
    if (at === ancestor) return true;
    at = at.joint ? nodes.get(at.joint.parent) : undefined;
  }
  return false;
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
  return roots.flatMap((node) => {
    if (wanted && !subtreeMatches(node, wanted)) return [];
    const expanded = node.children.length > 0 && (wanted !== "" || !collapsed.has(node.link.name));
    const row = { node, level, expandable: node.children.length > 0, expanded };
    return expanded ? [row, ...linkRows(node.children, collapsed, filter, level + 1)] : [row];
  });
}

/** @param {LinkNode} node @param {string} wanted lower case @returns {boolean} */
function subtreeMatches(node, wanted) {
  return (
    node.link.name.toLowerCase().includes(wanted) ||
    node.children.some((child) => subtreeMatches(child, wanted))
  );
}

/** @param {RobotState} robot @param {string} link @returns {string[]} the links above it, nearest first */
export function ancestorsOf(robot, link) {
  const above = new Map(robot.joints.map((joint) => [joint.child, joint.parent]));
  /** @type {string[]} */
  const found = [];
  let at = above.get(link);
  while (at !== undefined && !found.includes(at)) {
    found.push(at);
    at = above.get(at);
  }
  return found;
}
