/** What a person can ask of ROS 2. */

/** @import { WireReport, WireRobots } from "../types/wire.d.ts" */
/** @import { Place } from "../lib/wire-places.js" */

import { withRecent } from "../lib/wire-places.js";
import { ask, goTo } from "./actions.js";
import { recentPlaces } from "./state/ros.js";
import { RefusedError, send } from "./wire.js";

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
