/** Who we are to the studio, whether it is there, and which document is shown. */

import { computed, signal } from "vendor/preact.js";

/** @typedef {"connecting" | "connected" | "lost"} Connection */

/** @type {import("vendor/preact.js").Signal<Connection>} */
export const connection = signal("connecting");
/** @type {import("vendor/preact.js").Signal<"presenter" | "viewer">} */
export const role = signal("viewer");
export const version = signal("");
/** Changes when the studio was started anew. */
export const session = signal("");
/** Id of the document that this page shows; empty: none. */
export const documentId = signal("");
/** Set when the studio turned us away for good, e.g. without its cookie. */
export const turnedAway = signal(false);

export const mayEdit = computed(
  () => role.value === "presenter" && connection.value === "connected",
);
