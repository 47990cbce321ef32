/**
 * The connection to ROS 2: its state, the places where it was looked for, what of the robot goes
 * out and comes in, and what can be asked of it.
 */

/** @import { ExamineWire, WireFeed, WireReport, WireRobots, WireState } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { remembered } from "../lib/remembered.js";
import { mayEdit } from "./connection.js";
import { ask, goTo } from "./requests.js";
import { RefusedError, send, subscribe } from "./wire.js";

/** @typedef {{address: string, domain: number, distro: NonNullable<ExamineWire["distro"]>}} Place `distro` empty: as it was */

export const DISTROS = /** @type {const} */ (["jazzy", "kilted", "humble"]);
export const DOMAIN_MAX = 232;
const KEPT = 6;

/** @param {unknown} value @returns {value is Place} */
export function isPlace(value) {
  if (typeof value !== "object" || value === null) return false;
  const { address, domain, distro } = /** @type {Record<string, unknown>} */ (value);
  return typeof address === "string" && typeof distro === "string" && isDomain(Number(domain));
}

/** @param {number} domain */
export const isDomain = (domain) => Number.isInteger(domain) && domain >= 0 && domain <= DOMAIN_MAX;

/** @param {Place} one @param {Place} other */
export const isSamePlace = (one, other) =>
  one.address === other.address && one.domain === other.domain && one.distro === other.distro;

/** @param {readonly Place[]} places @param {Place} place @returns {Place[]} it first, each once, and not too many */
export const withRecent = (places, place) =>
  [place, ...places.filter((one) => !isSamePlace(one, place))].slice(0, KEPT);

/** @param {string} endpoint as Zenoh writes it @returns {string} the machine that is meant; empty: this one, or none */
export function hostOf(endpoint) {
  const host = endpoint.replace(/^[^/]*\//, "").replace(/:\d+([?#].*)?$/, "");
  return /^(localhost|127\.[\d.]+|\[::1\])$/.test(host) ? "" : host;
}

/** @type {Signal<WireState>} */
export const ros = signal({
  type: "wire_state",
  state: "off",
  router: "",
  endpoint: "",
  domain: 0,
  distro: "",
  nodes: [],
  node_count: 0,
  behind: {},
  bridges: [],
  nearby_count: 0,
  trouble: "",
});
/** @type {Signal<WireFeed>} */
export const feed = signal({
  type: "wire_feed",
  source: "sliders",
  source_state: "",
  rate_hz: 0,
  strangers: [],
  publishes_robot: false,
  publishes_joints: false,
  joints_paused: false,
  rivals: [],
  description_from: "",
  trouble: "",
});

/** Where this browser joined of late. */
export const recentPlaces = remembered(
  "ros.places",
  /** @type {readonly Place[]} */ ([]),
  (value) => Array.isArray(value) && value.every(isPlace),
);

/** The joints are this page's to move: nothing on the wire moves them. */
export const mayMove = computed(() => mayEdit.value && feed.value.source === "sliders");

subscribe("wire_state", (event) => {
  ros.value = event;
});

subscribe("wire_feed", (event) => {
  feed.value = event;
});

export const connectRos = () => ask({ type: "connect_wire" });

/** @param {Place} place @returns {Promise<string>} why it is not joined; empty: it is */
export async function connectAt(place) {
  try {
    await send({ type: "connect_wire", ...place });
    recentPlaces.value = withRecent(recentPlaces.value, place);
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}

/** @param {Place} place @returns {Promise<WireReport | string>} or why it cannot be looked at */
export async function examineAt(place) {
  try {
    const answer = await send({ type: "examine_wire", ...place });
    return answer.type === "wire_report" ? answer : "…";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}

/** All that goes out or comes in, for any robot, ends with it. */
export const disconnectRos = () => ask({ type: "disconnect_wire" });

/** @param {"sliders" | "animation" | "joint_states" | "tf"} source of the joints' positions */
export const chooseSource = (source) => ask({ type: "set_joint_source", source });

/** @param {boolean} running `/robot_description` and TF go out */
export const publishRobot = (running) => ask({ type: "publish_robot", running });

/** @param {boolean} running `/joint_states` goes out */
export const publishJoints = (running) => ask({ type: "publish_joints", running });

/** @returns {Promise<WireRobots | string>} or why they are not known */
export async function findRobots() {
  try {
    const answer = await send({ type: "find_wire_robots" });
    return answer.type === "wire_robots" ? answer : "…";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}

/**
 * @param {{topic: string} | {node: string, parameter: string}} place where its description is told
 * @returns {Promise<string>} why it was not opened; empty: it was
 */
export async function openFromRos(place) {
  try {
    const answer = await send({ type: "open_from_wire", ...place });
    if (answer.type === "opened") goTo(answer.document);
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}
