/** Who we are to the studio, whether it is there, and which document is shown. */

import { computed, signal } from "vendor/preact.js";

/** @typedef {"connecting" | "connected" | "lost"} Connection */

/** @type {import("vendor/preact.js").Signal<Connection>} */
export const connection = signal("connecting");
/** @type {import("vendor/preact.js").Signal<"presenter" | "helper" | "student" | "guest">} */
export const role = signal("guest");
/** Id of this person in the class; empty: not in it. */
export const person = signal("");
/** Whether this person has control of the ROS system. */
export const hasControl = signal(false);
/** Who of the class has control, and of which document; empty: the presenter has it of all. */
export const lent = signal({ holder: "", document: "" });
export const version = signal("");
/** Changes when the studio was started anew. */
export const session = signal("");
/** Id of the document that this page shows; empty: none. */
export const documentId = signal("");
/** Set when the studio turned us away for good, e.g. without its cookie. */
export const turnedAway = signal(false);

const isConnected = computed(() => connection.value === "connected");

/** @param {string} id of a document @returns {string} the person whose copy it is; empty: it is shared */
export const ownerOf = (id) => id.split("~")[1] ?? "";

/** @param {string} id of a document @returns {boolean} it is this person's to change */
function controls(id) {
  const { holder, document } = lent.value;
  const owner = ownerOf(id);
  if (role.value === "presenter") return owner !== "" || holder === "" || id !== document;
  if (owner) return owner === person.value;
  return hasControl.value && id === document;
}

/** The robot and its texts are this person's to change. */
export const mayEdit = computed(() => isConnected.value && controls(documentId.value));
/** The ROS system is: publishing, calling, driving. */
export const mayAct = computed(() => isConnected.value && hasControl.value);
/** What concerns the whole studio is: opening, connecting, starting demos, sharing. */
export const mayManage = computed(() => isConnected.value && role.value === "presenter");
