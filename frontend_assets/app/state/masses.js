/** What the links weigh, as the studio told it last; asked for while somebody looks. */

/** @import { LinkMassView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { send } from "../wire.js";
import { askWhenBuilt } from "./frames.js";

/** Links that have an inertial, in the order of the robot; null until they are known. @type {Signal<readonly LinkMassView[] | null>} */
export const masses = signal(null);

/** Keep `masses` true while somebody looks. @returns {() => void} the end of looking */
export function followMasses() {
  return askWhenBuilt(async () => {
    const answer = await send({ type: "get_masses" }).catch(() => null);
    if (answer?.type === "masses") masses.value = answer.links;
  });
}
