/** The order in which frames are offered: those of the world and of the robot's base by REP 105, then all others. */

const REP_105 = ["earth", "map", "odom", "world", "base_footprint", "base_link"];

/** @param {string} frame @returns {number} its place in REP 105, also below a prefix as in `robot1/odom` */
function placeOf(frame) {
  const at = REP_105.indexOf(frame.split("/").at(-1) ?? "");
  return at < 0 ? REP_105.length : at;
}

/** @param {readonly string[]} frames @returns {string[]} those without a place in REP 105 keep their order */
export const inFrameOrder = (frames) =>
  [...frames].sort((one, other) => placeOf(one) - placeOf(other));
