/** What this page knows of turtlesim: grounds on the wire, and how each of them looked since it is watched. */

/** @import { CallView } from "../types/wire.d.ts" */
/** @import { Turtle } from "../lib/turtles.js" */

import { effect } from "vendor/preact.js";
import { Paper } from "../lib/turtle-field.js";
import { World } from "../lib/turtle-world.js";
import { groundsOf, penOf } from "../lib/turtles.js";
import { trace } from "./data.js";
import { followNamespaces, inNamespaces, keptFor } from "./namespaces.js";
import { followDeeds } from "./state/deed-following.js";
import { calls } from "./state/deeds.js";

const WORLDS_MAX = 4;
const POSE = [".x", ".y", ".theta", ".linear_velocity", ".angular_velocity"];
const COLOR = [".r", ".g", ".b"];

export const grounds = inNamespaces(groundsOf);

/** Know which there are, and what is asked of them, while somebody looks; gives the end of it. */
export function followGrounds() {
  const ends = [followNamespaces(), followDeeds("calls")];
  return () => {
    for (const end of ends) end();
  };
}

/** What was seen of a ground so far, by its namespace. */
export const worldOf = keptFor(() => new World(new Paper()), WORLDS_MAX);

/** @typedef {{leave: () => void}} Lane */

/**
 * Hear every pose and colour of the turtles of a ground.
 *
 * @param {World} world
 * @returns {{hear: (turtles: readonly Turtle[]) => void, end: () => void}}
 */
export function turtleLanes(world) {
  /** @type {Map<string, Lane>} by topic */
  const lanes = new Map();
  const keep = (/** @type {Map<string, () => Lane>} */ wished) => {
    for (const [topic, lane] of lanes)
      if (!wished.has(topic)) {
        lane.leave();
        lanes.delete(topic);
      }
    for (const [topic, begin] of wished) if (!lanes.has(topic)) lanes.set(topic, begin());
  };
  return {
    hear(turtles) {
      world.keepOnly(turtles.map(({ name }) => name));
      /** @type {Map<string, () => Lane>} */
      const wished = new Map();
      for (const { name, pose, color } of turtles) {
        wished.set(pose, () =>
          traced(pose, POSE, (times, found) => world.addPoses(name, times, found)),
        );
        if (color)
          wished.set(color, () =>
            traced(color, COLOR, (times, found) => world.addColors(name, times, found)),
          );
      }
      keep(wished);
    },
    end: () => keep(new Map()),
  };
}

/** @param {string} topic @param {readonly string[]} paths @param {(times: Float64Array, columns: readonly Float64Array[]) => void} take */
const traced = (topic, paths, take) =>
  trace(
    topic,
    paths,
    {},
    {
      // A turtle that is not heard stays where it was; that nobody publishes is seen by the list of topics.
      onState: () => {},
      onPoints: ({ times, values, ahead_s }) => {
        // By the clock of the node, which tells pose and colour as one: they come apart.
        const told_s = times.map((time_s) => time_s - (ahead_s || 0));
        take(told_s, values);
      },
    },
  );

/** What was called of a ground so far counts once. @type {Map<string, number>} by namespace, the last deed */
const counted = new Map();

/** Have pens, wiping and resetting count that any page of this studio asks for. @param {string} prefix @param {World} world @returns {() => void} the end of it */
export function followTurtleCalls(prefix, world) {
  return effect(() => {
    const last = counted.get(prefix) ?? 0;
    for (const call of calls.value) {
      if (call.state !== "answered" || call.deed <= last) continue;
      countCall(prefix, world, call);
      counted.set(prefix, Math.max(counted.get(prefix) ?? 0, call.deed));
    }
  });
}

/** @param {string} prefix @param {World} world @param {CallView} call */
function countCall(prefix, world, { name, text }) {
  if (name === `${prefix}/reset`) world.reset();
  else if (name === `${prefix}/clear`) world.wipe();
  else if (name.startsWith(`${prefix}/`) && name.endsWith("/set_pen"))
    world.setPen(name.slice(prefix.length + 1, -"/set_pen".length), penOf(text));
}
