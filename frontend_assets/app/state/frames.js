/**
 * Where the links stand now, computed here from the frames of the joints and their positions: it
 * follows every joint frame without a word to the studio. The frames are asked for while somebody
 * looks, and asked anew when something was built.
 */

/** @import { Frames } from "../../types/wire.d.ts" */
/** @import { Pose } from "../../lib/kinematics.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { rootFromLinks } from "../../lib/kinematics.js";
import { connection } from "./connection.js";
import { built, movable, position, robot } from "./document.js";
import { askOrKeepWhy } from "./refusals.js";

/** @type {Signal<Frames["origins"] | null>} */
const origins = signal(null);
/** Why they were not told at last; empty: they were. */
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
export const followFrames = sharedLook(() => askWhenBuilt(askFrames));

/** Ask for the frames of the joints again. */
export async function askFrames() {
  const answer = await askOrKeepWhy({ type: "get_frames" }, framesRefused);
  if (answer?.type === "frames") origins.value = answer.origins;
}

/**
 * Ask at once and whenever something was built: never twice at a time, and once more when more was
 * built meanwhile.
 *
 * @param {() => Promise<void>} ask
 * @param {number} [restMs] between two, for what costs the studio more
 * @returns {() => void} the end of it
 */
export function askWhenBuilt(ask, restMs = 0) {
  let asking = false;
  let again = false;
  let over = false;
  const go = async () => {
    asking = true;
    do {
      again = false;
      await untracked(ask);
      if (restMs > 0) await new Promise((resolve) => setTimeout(resolve, restMs));
    } while (again && !over);
    asking = false;
  };
  const end = effect(() => {
    built.value;
    if (connection.value !== "connected" || robot.value === null) return;
    if (asking) again = true;
    else go();
  });
  return () => {
    over = true;
    end();
  };
}

/**
 * However many look, one asks.
 *
 * @param {() => () => void} begin to ask; gives the end of it
 * @returns {() => () => void} begin to look; gives the end of looking
 */
export function sharedLook(begin) {
  let lookers = 0;
  /** @type {() => void} */
  let stop = () => {};
  return () => {
    lookers += 1;
    if (lookers === 1) stop = begin();
    let over = false;
    return () => {
      if (over) return;
      over = true;
      lookers -= 1;
      if (lookers === 0) stop();
    };
  };
}
