/**
 * The one selection of this person: every panel reads it here, and says here what was selected in it.
 * It opens no panel, moves no focus and no cursor; those who show it bring it into view by themselves.
 */

import { batch, computed, effect, untracked } from "vendor/preact.js";
import { ofLink, ofPart, splitKey as split, stillThere } from "../../lib/selection.js";
import { robot } from "./document.js";
import { hovered, onlySelected, selection } from "./view.js";

export { selection };

/** Key of the selected part; null: none. */
export const part = computed(() => selection.value?.part ?? null);

/** Name of the selected joint; null: none, or a link is. */
export const selectedJoint = computed(() => {
  const [kind, name] = split(robot.value, part.value ?? "");
  return kind === "joint" ? name : null;
});

/** @param {string} key @returns {[string, string]} kind and name of a part */
export const splitKey = (key) => split(robot.value, key);

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

/** @param {import("../../types/wire.d.ts").RobotState} known */
function forgetGone(known) {
  const before = selection.value;
  const now = stillThere(before, known);
  if (before?.link && !now?.link) onlySelected.value = false;
  selection.value = now;
  const isThere = known.links.some(({ name }) => name === hovered.value);
  if (!isThere) hovered.value = null;
}
