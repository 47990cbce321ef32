/** The topics that can be published on: those that there are, asked again and again while somebody looks. */

/** @import { OfferView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "../../model/asking.js";

const EVERY_MS = 1500;

/** Null: not told yet. @type {Signal<readonly OfferView[] | null>} */
export const publishable = signal(null);
export const publishableRefused = signal("");

/** Ask now. */
export async function askPublishable() {
  const told = await askOrKeepWhy({ type: "list_topics" }, publishableRefused);
  if (told?.type === "topic_table")
    publishable.value = told.topics.map(({ name, types }) => ({ name, types, nodes: [] }));
}
export const followPublishable = polled(askPublishable, EVERY_MS);
