/** The layout for a robot that runs: the 3D view amid what is heard of it and done to it. */

/** @import { Split } from "../lib/arrangement.js" */

/** Its name among the layouts; one that a person gives never begins with a space. */
export const LIVE = " live";

const MIDDLE = ["scene", "turtlesim", "jerry"];
const LEFT = ["displays", "frames", "joints", "lessons"];
const BELOW = ["plot", "log", "image", "diagnostics"];
const UPPER = ["graph", "interfaces", "lifecycle"];
const LOWER = ["topics", "services", "actions", "parameters", "publish", "teleop"];
const LOW_SHARE = 0.36;
const UPPER_SHARE = 0.4;

/**
 * @param {"wide" | "medium"} kind
 * @param {number} width px
 * @param {number} height px
 * @param {(id: string) => boolean} isPanel those that there are
 * @returns {Split[]} a row, left to right; a split in it stacks from top to bottom
 */
export function liveLayout(kind, width, height, isPanel) {
  const [left, below, upper, lower] = /** @type {[string[], string[], string[], string[]]} */ (
    [LEFT, BELOW, UPPER, LOWER].map((ids) => ids.filter(isPanel))
  );
  const low = Math.round(height * LOW_SHARE);
  const middle = [{ tabs: MIDDLE.filter(isPanel), size: height - low }, ...tabs(below, low)];
  if (kind === "medium") {
    const right = Math.round(Math.min(380, width * 0.44));
    return [{ split: middle, size: width - right }, ...tabs([...lower, ...left, ...upper], right)];
  }
  const side = Math.round(Math.min(270, width * 0.2));
  const right = Math.round(Math.min(470, width * 0.32));
  const upperHeight = Math.round(height * UPPER_SHARE);
  return [
    ...tabs(left, side),
    { split: middle, size: width - side - right },
    { split: [...tabs(upper, upperHeight), ...tabs(lower, height - upperHeight)], size: right },
  ];
}

/** @param {string[]} ids @param {number} size @returns {Split[]} none where no panel is */
const tabs = (ids, size) => (ids.length > 0 ? [{ tabs: ids, size }] : []);
