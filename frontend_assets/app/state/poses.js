/** The named poses of the open robot, as the studio last told them. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Poses } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";

/** @type {Signal<Poses>} */
export const poses = signal({ type: "poses", poses: [], path: "", only_here: "", trouble: "" });

/** @param {Poses} event */
export function takePoses(event) {
  poses.value = event;
}
