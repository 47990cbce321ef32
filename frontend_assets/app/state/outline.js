/** What the files of the open robot hold, as the studio told it last. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Outline } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { askOrKeepWhy } from "../../model/asking.js";

/** @type {Signal<Outline | null>} */
export const outline = signal(null);

/** Why it was not told at last; empty: it was. */
export const outlineRefused = signal("");

/** Ask for it again. */
export async function fetchOutline() {
  const answer = await askOrKeepWhy({ type: "get_outline" }, outlineRefused);
  if (answer?.type === "outline") outline.value = answer.outline;
}
