/** What the files of the open robot hold, as the studio told it last. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Outline } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { send } from "../wire.js";

/** @type {Signal<Outline | null>} */
export const outline = signal(null);

/** Ask for it again. */
export async function fetchOutline() {
  const answer = await send({ type: "get_outline" }).catch(() => null);
  if (answer?.type === "outline") outline.value = answer.outline;
}
