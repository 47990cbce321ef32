/** What the links weigh, as the studio told it last; asked for while somebody looks. */

/** @import { LinkMassView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { askWhenBuilt, sharedLook } from "./frames.js";
import { askOrKeepWhy } from "./refusals.js";

/** A drag is not slowed by what it weighs. */
const REST_MS = 150;

/** Links that have an inertial, in the order of the robot; null until they are known. @type {Signal<readonly LinkMassView[] | null>} */
export const masses = signal(null);

/** Why they were not told at last; empty: they were. */
export const massesRefused = signal("");

/** Keep `masses` true while somebody looks. @type {() => () => void} gives the end of looking */
export const followMasses = sharedLook(() => askWhenBuilt(askMasses, REST_MS));

/** Ask for them again. */
export async function askMasses() {
  const answer = await askOrKeepWhy({ type: "get_masses" }, massesRefused);
  if (answer?.type === "masses") masses.value = answer.links;
}
