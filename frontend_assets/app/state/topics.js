/** What a person looks at among the topics; their own, as every filter is. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { TopicRow } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { remembered } from "../../lib/remembered.js";

/** As they were told last; null: not yet. @type {Signal<readonly TopicRow[] | null>} */
export const topics = signal(null);
/** The topic that is looked at. @type {Signal<string | null>} */
export const chosenTopic = signal(null);
/** Names that every node has, and hidden ones, are shown. */
export const showsNoise = remembered("topics.noise", false);

/** How a topic is listened to; null: as fits its publishers. @type {Signal<import("../listening-menu.js").Listening>} */
export const listening = signal({ reliable: null, latched: null });
