/** The named poses of the open robot, and what can be asked of them. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Poses } from "../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { ask } from "./requests.js";
import { RefusedError, send, subscribe } from "./wire.js";

/** @type {Signal<Poses>} */
export const poses = signal({ type: "poses", poses: [], path: "", only_here: "", trouble: "" });

subscribe("poses", (event) => {
  poses.value = event;
});

/** Long enough to see which joints move. */
const WAY_S = 0.6;

/** @param {string} key the joints go there, at once for those who want little motion */
export function applyPose(key) {
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  return ask({ type: "apply_pose", key, duration_s: still ? 0 : WAY_S });
}

/** @param {string} name @returns {Promise<string>} why it was not kept; empty: it was */
export const savePose = (name) => orWhyNot({ type: "save_pose", name, replace: false });

/** @param {string} name of one's own pose that becomes where the joints are now */
export const updatePose = (name) => ask({ type: "save_pose", name, replace: true });

/** @param {string} name @param {string} newName @returns {Promise<string>} why it was not done; empty: it was */
export const renamePose = (name, newName) =>
  orWhyNot({ type: "rename_pose", name, new_name: newName });

/** @param {string} name */
export const deletePose = (name) => ask({ type: "delete_pose", name });

/** @param {import("./wire.js").Asked<import("../types/wire.d.ts").Command>} command @returns {Promise<string>} */
async function orWhyNot(command) {
  try {
    await send(command);
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}
