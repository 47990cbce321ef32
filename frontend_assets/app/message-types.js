/** What types are made of, as the studio told it: each is asked for once, until it may be another. */

/** @import { MessageView } from "../types/wire.d.ts" */

import { effect, untracked } from "vendor/preact.js";
import { interfaces } from "./state/interfaces.js";
import { RefusedError, send } from "./wire.js";

/** @typedef {{messages: readonly MessageView[] | null, reason: string}} Told null: it is not known, and why */

/** @type {Map<string, Promise<Told>>} */
const types = new Map();
/** Names that nobody knew when they were asked for. @type {Set<string>} */
const unknown = new Set();

/** @param {string} name @returns {Promise<Told>} what a type is made of, or why that is not known */
export function typeOf(name) {
  const known = types.get(name) ?? askType(name);
  types.set(name, known);
  return known;
}

/** @param {string} name @returns {Promise<Told>} */
async function askType(name) {
  try {
    const answer = await send({ type: "get_interface", name });
    unknown.delete(name);
    return { messages: answer.type === "interface" ? answer.messages : null, reason: "" };
  } catch (error) {
    types.delete(name); // somebody may tell it later
    unknown.add(name);
    return { messages: null, reason: error instanceof RefusedError ? error.message : "…" };
  }
}

/**
 * Say which types may be others than they were, whenever somebody gives texts of types: those that
 * were not known, and those that are no ROS distribution's.
 *
 * @param {(name: string) => void} tell
 */
export function whenTypesChange(tell) {
  effect(() => {
    const doubtful = new Set([...unknown, ...(interfaces.value?.own ?? [])]);
    for (const name of [...types.keys(), ...unknown]) {
      if (!doubtful.delete(name)) continue;
      types.delete(name);
      untracked(() => tell(name));
    }
  });
}
