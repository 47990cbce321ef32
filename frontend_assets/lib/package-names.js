/** What a ROS package may be called: the studio's own rule, said while a name is typed. */

const LENGTH_LIMIT = 60;
const ENDING = "_description";

/** @type {readonly [RegExp, string][]} what is wrong with a name, most telling first */
const FAULTS = [
  [/^.?$/, "name.short"],
  [new RegExp(`^.{${LENGTH_LIMIT + 1},}$`), "name.long"],
  [/[A-Z]/, "name.capital"],
  [/[\s-]/, "name.blank"],
  [/[^a-z0-9_]/, "name.sign"],
  [/^[^a-z]/, "name.first"],
  [/__/, "name.double"],
  [/_$/, "name.last"],
];

/** @param {string} name @returns {string} key of a sentence; empty when nothing is wrong */
export function nameFault(name) {
  return FAULTS.find(([pattern]) => pattern.test(name))?.[1] ?? "";
}

/** @param {string} name of a package @returns {string} the robot that it describes */
export function robotOf(name) {
  const short = name.endsWith(ENDING) ? name.slice(0, -ENDING.length) : name;
  return short || name;
}
