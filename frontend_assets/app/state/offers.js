/** Which services and actions there are: asked again and again while somebody looks. */

/** @import { OfferView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { polled } from "./polling.js";
import { askOrKeepWhy } from "./refusals.js";

const EVERY_MS = 1500;

/** Null: not told yet. @type {Signal<readonly OfferView[] | null>} */
export const services = signal(null);
/** @type {Signal<readonly OfferView[] | null>} */
export const actions = signal(null);
export const offersRefused = signal("");

/** Ask now. */
export async function askServices() {
  const told = await askOrKeepWhy({ type: "get_services" }, offersRefused);
  if (told?.type === "services") services.value = told.services;
}
export const followServices = polled(askServices, EVERY_MS);

/** Ask now. */
export async function askActions() {
  const told = await askOrKeepWhy({ type: "get_actions" }, offersRefused);
  if (told?.type === "actions") actions.value = told.actions;
}
export const followActions = polled(askActions, EVERY_MS);
