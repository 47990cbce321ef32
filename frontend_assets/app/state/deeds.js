/** What is done in the ROS 2 system from any page, as the studio told it last. */

/** @import { Calls, CallView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { withDeeds } from "../../lib/deeds.js";

/** The newest last. @type {Signal<readonly CallView[]>} */
export const calls = signal([]);

/** @param {Calls} event */
export function takeCalls(event) {
  calls.value = withDeeds(calls.value, event);
}
