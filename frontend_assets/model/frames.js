/**
 * Where the links stand now, computed here from the frames of the joints and their positions: it
 * follows every joint frame without a word to the studio. The frames are asked for while somebody
 * looks, and asked anew when something was built.
 */

/** @import { Frames } from "../types/wire.d.ts" */
/** @import { Pose } from "../lib/kinematics.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { rootFromLinks } from "../lib/kinematics.js";
import { askOrKeepWhy, askWhenBuilt, sharedFollowing } from "./asking.js";
import { movable, position, robot } from "./document.js";

/** @type {Signal<Frames["origins"] | null>} */
const origins = signal(null);
/** Why the last request for them failed; empty: it did not. */
export const framesRefused = signal("");
const moving = computed(() => new Set(movable.value.map(({ name }) => name)));

/**
 * The same of these links only, which costs less than of all.
 *
 * @param {readonly string[]} names
 * @returns {ReadonlyMap<string, Pose> | null} by link, of those above them too; null until it is known
 */
export function posesOf(names) {
  const [known, tree, moves] = [origins.value, robot.value, moving.value];
  if (!known || !tree) return null;
  const links = names.map((name) => ({ name }));
  return rootFromLinks(
    { links, joints: tree.joints },
    (joint) => known[joint],
    (joint) => (moves.has(joint) ? position(joint).value : 0),
  );
}

/** Pose of each link in the root frame, by link; null until it is known. Needs `followFrames`. @type {Signal<ReadonlyMap<string, Pose> | null>} */
export const linkPoses = computed(() => {
  return robot.value && posesOf(robot.value.links.map(({ name }) => name));
});

/** Keep `linkPoses` true while somebody looks. @type {() => () => void} gives the end of looking */
export const followFrames = sharedFollowing(() => askWhenBuilt(askFrames));

/** Ask for the frames of the joints again. */
export async function askFrames() {
  const answer = await askOrKeepWhy({ type: "get_frames" }, framesRefused);
  if (answer?.type === "frames") origins.value = answer.origins;
}
