/** How the parts of a robot say that they are: asked while somebody looks. */

/** @import { DiagnosticsAnswer } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "../../model/asking.js";

const EVERY_MS = 1000;

/** @type {Signal<DiagnosticsAnswer | null>} null: not known yet */
export const diagnostics = signal(null);
export const diagnosticsRefused = signal("");

/** Keep them true while somebody looks; gives the end of looking. */
export const followDiagnostics = polled(async () => {
  const told = await askOrKeepWhy({ type: "get_diagnostics" }, diagnosticsRefused);
  if (told?.type === "diagnostics") diagnostics.value = told;
}, EVERY_MS);
