/**
 * What this person has selected: a part of the robot, the link that stands for it in 3D, perhaps
 * one element or attribute of the part, and the panel in which it was selected. Selecting opens
 * no panel and moves no focus and no cursor; those who show it bring it into view by themselves.
 */

/** @import { JointView, LinkView, RobotState } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, effect, signal, untracked } from "vendor/preact.js";
import { robot } from "./document.js";

/**
 * @typedef {object} Selection
 * @property {string} part `link:<name>`, `joint:<name>`, `material:<name>` or `other:<n>`
 * @property {string | null} link that is lit with it: itself, or what the joint moves
 * @property {string} element path of the element that is looked for; empty: none
 * @property {string} attribute
 * @property {string} by the panel where it was made: that one has it in view already; empty: no panel
 */

/** @typedef {Pick<RobotState, "links" | "joints">} Parts */

/**
 * @param {Parts | null} robot
 * @param {string} key of a part
 * @returns {[string, string]} kind and name; `#2` at the end counts parts of one name
 */
export function splitPartKey(robot, key) {
  const at = key.indexOf(":");
  const kind = key.slice(0, at);
  const name = key.slice(at + 1);
  const known = (kind === "joint" ? robot?.joints : robot?.links) ?? [];
  const isName = known.some((one) => one.name === name);
  return [kind, isName ? name : name.replace(/#\d+$/, "")];
}

/**
 * @param {Parts | null} robot
 * @param {string} key
 * @returns {string | null} the link that is lit with a part, if it has one
 */
export function linkOf(robot, key) {
  const [kind, name] = splitPartKey(robot, key);
  if (kind === "link") return name;
  if (kind !== "joint") return null;
  return robot?.joints.find((joint) => joint.name === name)?.child ?? null;
}

/**
 * @param {string | null} link null: nothing is selected any more
 * @param {string} [by]
 * @returns {Selection | null}
 */
export function ofLink(link, by = "") {
  return link === null ? null : { part: `link:${link}`, link, element: "", attribute: "", by };
}

/**
 * @param {Selection | null} before a part without a link of its own leaves that one lit
 * @param {Parts | null} robot
 * @param {{part: string, element?: string, attribute?: string, by?: string}} chosen
 * @returns {Selection}
 */
export function ofPart(before, robot, { part, element = "", attribute = "", by = "" }) {
  return { part, link: linkOf(robot, part) ?? before?.link ?? null, element, attribute, by };
}

/**
 * @param {Selection | null} before
 * @param {Parts} robot as it is now
 * @returns {Selection | null} the same object when the robot still has it all
 */
export function stillThere(before, robot) {
  if (!before) return null;
  const lit = litNow(before, robot);
  if (lit === before.link) return before;
  if (lit !== null) return { ...before, link: lit };
  const outlived = before.part.startsWith("joint:") && has(robot.links, before.link);
  return outlived ? ofLink(before.link) : null;
}

/** @param {Selection} before @param {Parts} robot @returns {string | null} the link of a part, as the robot is now */
function litNow({ part, link }, robot) {
  const [kind] = splitPartKey(robot, part);
  const lit = kind === "link" || kind === "joint" ? linkOf(robot, part) : link;
  return has(robot.links, lit) ? lit : null;
}

/** @param {readonly {name: string}[]} parts @param {string | null} wanted */
const has = (parts, wanted) => parts.some(({ name }) => name === wanted);

/**
 * The part that was written at a place. One element of a macro makes several: the one that belongs to
 * the link that is lit already is meant.
 *
 * @param {Parts} robot
 * @param {{file: string, line: number, kind: string, name: string}} element `kind` is `link` or `joint`;
 *   `name` as it stands there, perhaps an expression; line from 1
 * @param {string | null} lit the link of the selection
 * @returns {string | null} key of the part
 */
export function partWrittenAt(robot, { file, line, kind, name }, lit) {
  /** @type {readonly (LinkView | JointView)[]} */
  const all = kind === "joint" ? robot.joints : robot.links;
  const here = all.filter((one) => one.file === file);
  const named = here.filter((one) => one.name === name);
  // Lines are those of the last good run; a name that is no expression is surer.
  const found = named.length > 0 ? named : here.filter((one) => one.line === line);
  const keys = found.map((one) => `${kind}:${one.name}`);
  return keys.find((key) => linkOf(robot, key) === lit) ?? keys[0] ?? null;
}

/** Link under the pointer, in 3D or in the tree. @type {Signal<string | null>} */
export const hovered = signal(null);
/** What this person has selected. @type {Signal<Selection | null>} */
export const selection = signal(null);
const selectedLink = computed(() => selection.value?.link ?? null);
/** The link of the selection; one that is written here is selected as a link. */
export const selected = {
  get value() {
    return selectedLink.value;
  },
  set value(link) {
    selection.value = ofLink(link);
  },
  peek: () => selectedLink.peek(),
};
/** @type {Signal<ReadonlySet<string>>} */
export const hiddenLinks = signal(new Set());
/** Links that are not fully opaque here: 0 to 1. @type {Signal<ReadonlyMap<string, number>>} */
export const linkOpacity = signal(new Map());

/** Show only the texts that shape the selected link. */
export const onlySelected = signal(false);
/** @param {string} link @param {boolean} visible for this person only */
export function showLink(link, visible) {
  const now = new Set(hiddenLinks.value);
  if (visible) now.delete(link);
  else now.add(link);
  hiddenLinks.value = now;
}

/** @param {string} link @param {number} opacity 0 to 1, for this person only */
export function fadeLink(link, opacity) {
  const now = new Map(linkOpacity.value);
  if (opacity >= 1) now.delete(link);
  else now.set(link, opacity);
  linkOpacity.value = now;
}

/** Key of the selected part; null: none. */
export const part = computed(() => selection.value?.part ?? null);

/** Name of the selected joint; null: none, or a link is. */
export const selectedJoint = computed(() => {
  const [kind, name] = splitPartKey(robot.value, part.value ?? "");
  return kind === "joint" ? name : null;
});

/** @param {string} key @returns {[string, string]} kind and name of a part */
export const splitKey = (key) => splitPartKey(robot.value, key);

/** @param {string | null} link null: nothing @param {string} by the panel in which it was selected */
export function selectLink(link, by) {
  selection.value = ofLink(link, by);
}

/**
 * Select a part, and the link that belongs to it.
 *
 * @param {string} key
 * @param {string} [element] path of an element in it
 * @param {string} [attribute]
 * @param {string} [by] the panel in which it was selected
 */
export function selectPart(key, element = "", attribute = "", by = "") {
  const chosen = { part: key, element, attribute, by };
  selection.value = ofPart(selection.peek(), robot.value, chosen);
}

// What the robot has no more is not selected any more, nor under the pointer.
effect(() => {
  const known = robot.value;
  if (known) untracked(() => batch(() => forgetGone(known)));
});

/** @param {import("../types/wire.d.ts").RobotState} known */
function forgetGone(known) {
  const before = selection.value;
  const now = stillThere(before, known);
  if (before?.link && !now?.link) onlySelected.value = false;
  selection.value = now;
  const isThere = known.links.some(({ name }) => name === hovered.value);
  if (!isThere) hovered.value = null;
}
