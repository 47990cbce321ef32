/** Managed nodes and their states: asked while somebody looks. */

/** @import { ManagedNodes } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "../../model/asking.js";

const EVERY_MS = 1000;

/** @type {Signal<ManagedNodes | null>} null: not known yet */
export const managed = signal(null);
export const managedRefused = signal("");

export async function askManaged() {
  const told = await askOrKeepWhy({ type: "get_managed" }, managedRefused);
  if (told?.type === "managed_nodes") managed.value = told;
}

/** Keep them true while somebody looks; gives the end of looking. */
export const followManaged = polled(askManaged, EVERY_MS);
