/** What the links weigh, as the studio told it last; asked for while somebody looks. */

/** @import { LinkMassView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { send } from "../wire.js";
import { askWhenBuilt, sharedLook } from "./frames.js";

/** A drag is not slowed by what it weighs. */
const REST_MS = 150;

/** Links that have an inertial, in the order of the robot; null until they are known. @type {Signal<readonly LinkMassView[] | null>} */
export const masses = signal(null);

/** Keep `masses` true while somebody looks. @type {() => () => void} gives the end of looking */
export const followMasses = sharedLook(() => askWhenBuilt(askMasses, REST_MS));

async function askMasses() {
  const answer = await send({ type: "get_masses" }).catch(() => null);
  if (answer?.type === "masses") masses.value = answer.links;
}
