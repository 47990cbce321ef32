/**
 * What this page knows of turtlesim and asks of it: the grounds in the ROS 2 system, how each
 * looked since it is watched, the calls of its services, and the colour of the bare ground.
 */

/** @import { CallView } from "../../types/wire.d.ts" */
/** @import { Pen, Turtle } from "./world.js" */
/** @import { Point } from "./drawing.js" */

import { effect, signal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { latestSender } from "../../lib/latest.js";
import { askOrKeepWhy } from "../../model/asking.js";
import { echo, trace } from "../../model/data-lane.js";
import { calls, followOperations, plainOf, services } from "../../model/operations.js";
import { called, followNamespaces, inNamespaces, keptFor } from "../demo-panel.js";
import { Paper } from "./drawing.js";
import { bytesOf, colorOf, groundsOf, penOf, serviceNamed, World } from "./world.js";

const WORLDS_MAX = 4;
const POSE = [".x", ".y", ".theta", ".linear_velocity", ".angular_velocity"];
const COLOR = [".r", ".g", ".b"];

export const grounds = inNamespaces(groundsOf);

/** Know which there are, and what is asked of them, while somebody looks; gives the end of it. */
export function followGrounds() {
  const ends = [followNamespaces(), followOperations("calls")];
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

/** What was called of a ground so far counts once. @type {Map<string, number>} by namespace, the last operation */
const counted = new Map();

/** Have pens, wiping and resetting count that any page of this studio asks for. @param {string} prefix @param {World} world @returns {() => void} the end of it */
export function followTurtleCalls(prefix, world) {
  return effect(() => {
    const last = counted.get(prefix) ?? 0;
    for (const call of calls.value) {
      if (call.state !== "answered" || call.operation <= last) continue;
      countCall(prefix, world, call);
      counted.set(prefix, Math.max(counted.get(prefix) ?? 0, call.operation));
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

const NAMES = /** @type {const} */ (["background_r", "background_g", "background_b"]);
/** So often at most the node is asked. */
const REST_MS = 150;
/** What others change may hide what this one did at the same moment. */
const OTHERS_REST_MS = 2000;

/** Why the node did not take the colour that was chosen last. */
export const backgroundRefused = signal("");

/**
 * @param {string} node full name
 * @param {(color: number) => void} tell at first and at every change, 0xrrggbb
 * @returns {() => void} the end of it
 */
export function followBackground(node, tell) {
  const sender = latestSender(
    async () => {
      const color = await backgroundOf(node);
      if (color !== null) tell(color);
    },
    (go) => setTimeout(go, REST_MS),
  );
  let asked_ms = 0;
  const ask = () => {
    asked_ms = performance.now();
    sender.push(undefined);
  };
  ask();
  backgroundRefused.value = "";
  const onMessage = (/** @type {{value: any}} */ { value }) => {
    if (value?.node === node || performance.now() - asked_ms > OTHERS_REST_MS) ask();
  };
  const events = { onState: () => {}, onMessage };
  return echo("/parameter_events", { mostHz: 60 }, events).leave;
}

/** @param {string} node @returns {Promise<number | null>} null: it does not tell */
async function backgroundOf(node) {
  const answer = await askOrKeepWhy({ type: "get_parameters", node }, signal(""));
  if (answer?.type !== "parameters") return null;
  const known = new Map(answer.parameters.map(({ name, value }) => [name, plainOf(value)]));
  const bytes = NAMES.map((name) => known.get(name));
  const isColor = bytes.every((one) => typeof one === "number" && one >= 0 && one <= 255);
  return isColor ? colorOf(.../** @type {[number, number, number]} */ (bytes)) : null;
}

/** @type {ReturnType<typeof latestSender<{node: string, hex: string}>>} */
const setter = latestSender(setNow);

/** @param {string} node @param {string} hex the newest wins */
export const setBackground = (node, hex) => setter.push({ node, hex });

/** @param {{node: string, hex: string}} wished */
async function setNow({ node, hex }) {
  backgroundRefused.value = "";
  const bytes = bytesOf(hex);
  for (const [n, name] of NAMES.entries()) {
    const refused = signal("");
    const text = String(bytes[n]);
    await askOrKeepWhy({ type: "set_parameter", node, name, text, value_type: "integer" }, refused);
    if (refused.value) backgroundRefused.value = refused.value;
  }
}

/** Why the last one was not done; empty: it was. */
export const turtleTrouble = signal("");

/** @param {string} name @returns {boolean} somebody serves it */
export const isServed = (name) => serviceNamed(services.value ?? [], name) !== null;

/** @param {string} name of the service @param {object} values @returns {Promise<any>} its reply; null: there is none, which is said */
async function ask(name, values) {
  const service = serviceNamed(services.peek() ?? [], name);
  const { reply, trouble } = service
    ? await called(service, values)
    : { reply: null, trouble: t("turtlesim.not_served", { name }) };
  turtleTrouble.value = trouble;
  return reply;
}

/** @param {string} prefix @param {Point} place m @param {string} name empty: turtlesim gives one @returns {Promise<string>} the name that it got; empty: there is none */
export async function spawn(prefix, { x, y }, name) {
  const reply = await ask(`${prefix}/spawn`, { x, y, theta: 0, name });
  if (reply && !reply.name) turtleTrouble.value = t("turtlesim.not_spawned", { name });
  return reply?.name ?? "";
}

/** @param {string} prefix @param {string} name */
export const kill = (prefix, name) => ask(`${prefix}/kill`, { name });
/** @param {string} prefix */
export const clear = (prefix) => ask(`${prefix}/clear`, {});
/** @param {string} prefix */
export const reset = (prefix) => ask(`${prefix}/reset`, {});
/** @param {string} path of the turtle @param {Point & {theta: number}} place m, m and rad */
export const teleport = (path, { x, y, theta }) =>
  ask(`${path}/teleport_absolute`, { x, y, theta });

/** @param {string} path of the turtle @param {Pen} pen */
export const setPen = (path, { color, width, isDown }) =>
  ask(`${path}/set_pen`, {
    ...{ r: (color >> 16) & 255, g: (color >> 8) & 255, b: color & 255 },
    ...{ width, off: isDown ? 0 : 1 },
  });
