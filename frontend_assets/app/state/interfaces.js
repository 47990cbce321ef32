/** The types of ROS that the studio knows, which of them is looked at, and a text that is to be added. */

/** @import { InterfaceAnswer, InterfacesAnswer } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal } from "vendor/preact.js";
import { session } from "./connection.js";
import { askOrKeepWhy } from "./refusals.js";

/** @type {Signal<InterfacesAnswer | null>} */
export const interfaces = signal(null);
export const interfacesRefused = signal("");
/** Full name of the type that is looked at; empty: none. */
export const interfaceName = signal("");
/** @type {Signal<InterfaceAnswer | null>} */
export const interfaceShown = signal(null);
export const interfaceRefused = signal("");
/** A text that a person is about to give; null: nobody is. @type {Signal<{name: string, text: string} | null>} */
export const draft = signal(null);

/** Ask which types there are. */
export async function askInterfaces() {
  const told = await askOrKeepWhy({ type: "list_interfaces" }, interfacesRefused);
  if (told?.type === "interfaces") interfaces.value = told;
}

/** Look at a type. @param {string} name */
export async function showInterface(name) {
  interfaceName.value = name;
  interfaceShown.value = null;
  if (name === "") return;
  const told = await askOrKeepWhy(
    { type: "get_interface", name, with_text: true },
    interfaceRefused,
  );
  // Another one may be looked at since.
  if (told?.type !== "interface" || told.name !== interfaceName.value) return;
  interfaceShown.value = told;
  // A node may just have told it.
  if (interfaces.value && !interfaces.value.names.includes(name)) await askInterfaces();
}

// A studio that was started anew has forgotten what was added.
effect(() => {
  session.value;
  interfaces.value = null;
});
