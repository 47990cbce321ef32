/** @import { Door } from "./door.js" */
/** @import { Numbers } from "./lens.js" */
/** @import { Object3D } from "./viser.d.ts" */

import { isSeen } from "./extent.js";

const ROOT = "/live/";

/**
 * A node that a display draws.
 *
 * @typedef {object} LiveNode
 * @property {string} name of the node
 * @property {string} display id
 * @property {string} path of its group in the drawing
 * @property {string} shape its name in the group
 * @property {string} node what tells the nodes of one shape apart
 * @property {string} kind the type of the message that made it
 * @property {Props} props
 * @property {Object3D} object
 * @property {Object3D} group that it moves with
 */

/**
 * What is read of it; numbers one after the other.
 *
 * @typedef {object} Props
 * @property {Numbers} [points] (N, 3) of a cloud, (N, 2, 3) of lines and arrows
 * @property {Numbers} [batched_positions] (N, 3)
 * @property {Numbers} [batched_wxyzs] (N, 4)
 * @property {Numbers | null} [batched_scales] (N, 3)
 * @property {Numbers} [vertices] (V, 3)
 * @property {Numbers} [faces] (F, 3)
 * @property {number} [axes_length] m
 * @property {number} [point_size] half of a point's width, m
 * @property {boolean} [studio_size_by_z] that width is for each metre of its z
 * @property {number} [studio_point_px] instead of it, a point's width on the screen
 * @property {number} [thickness]
 * @property {"world" | "screen"} [thickness_units]
 * @property {number} [head_radius] m
 * @property {number} [cell_size] of a grid, m
 */

/** All nodes of displays that are seen. @param {Door} door @returns {LiveNode[]} */
export function liveNodes(door) {
  /** @type {LiveNode[]} */
  const found = [];
  for (const [name, entry] of Object.entries(window.__viserSceneTree?.getState() ?? {})) {
    const named = entry && namesIn(name);
    const object = named ? door.node(name) : undefined;
    const group = named ? door.node(name.slice(0, name.lastIndexOf("/"))) : undefined;
    if (!entry || !named || !object || !group || !isSeen(object)) continue;
    const props = /** @type {Props} */ (entry.message.props ?? {});
    found.push({ name, ...named, kind: entry.message.type, props, object, group });
  }
  return found;
}

/** Ids and names in the name of a node; null: it is none of a shape. @param {string} name */
export function namesIn(name) {
  if (!name.startsWith(ROOT)) return null;
  const parts = name.slice(ROOT.length).split("/");
  if (parts.length !== 3) return null;
  const [display = "", path = "", last = ""] = parts.map(unquoted);
  const dot = last.lastIndexOf(".");
  if (dot < 0) return null;
  return { display, path, shape: last.slice(0, dot), node: last.slice(dot + 1) };
}

/** An empty name is written as a sign that stands for nothing else. @param {string} part */
const unquoted = (part) => (part === "%" ? "" : decodeURIComponent(part));

/** The node of a group of a display. @param {string} display @param {string} path */
export function groupName(display, path) {
  return `${ROOT}${quoted(display)}/${quoted(path)}`;
}

/** The node of a shape that is one mesh. @param {string} group name of its node @param {string} shape */
export const meshName = (group, shape) => `${group}/${quoted(`${shape}.mesh`)}`;

/** @param {string} part */
const quoted = (part) => encodeURIComponent(part) || "%";
