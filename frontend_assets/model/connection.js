/** Who we are to the studio, whether it is there, and which document is shown. */

import { computed, signal } from "vendor/preact.js";

/** @typedef {"connecting" | "connected" | "lost"} Connection */

/** @type {import("vendor/preact.js").Signal<Connection>} */
export const connection = signal("connecting");
/** @type {import("vendor/preact.js").Signal<"presenter" | "helper" | "student" | "guest">} */
export const role = signal("guest");
/** Whether this person has control of the shared robot and of the ROS system. */
export const hasControl = signal(false);
export const version = signal("");
/** Changes when the studio was started anew. */
export const session = signal("");
/** Id of the document that this page shows; empty: none. */
export const documentId = signal("");
/** Set when the studio turned us away for good, e.g. without its cookie. */
export const turnedAway = signal(false);

/** The robot, its texts and the ROS system are this person's to change. */
export const mayEdit = computed(() => hasControl.value && connection.value === "connected");
/** What concerns the whole studio is: opening, connecting, starting demos, sharing. */
export const mayManage = computed(
  () => role.value === "presenter" && connection.value === "connected",
);
