/** The layouts that this person saved in this browser, by name, and which one is in use. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Arrangement } from "../../lib/arrangement.js" */
/** @import { OwnLayout } from "../../lib/layout-file.js" */

import { effect, signal } from "vendor/preact.js";
import { freeName, LAYOUTS_MOST, readLayouts, tidyName } from "../../lib/layout-file.js";
import { recall, remember, remembered } from "../../lib/remembered.js";

const STORE = "layouts";

/** Any panel is let through: one that this studio lacks is left out when the layout is shown. */
const anyPanel = () => true;

/** @returns {readonly OwnLayout[]} */
function stored() {
  const found = recall(STORE);
  return Array.isArray(found) ? readLayouts(found, anyPanel).layouts : [];
}

/** @type {Signal<readonly OwnLayout[]>} */
export const ownLayouts = signal(stored());
effect(() => remember(STORE, ownLayouts.value.length > 0 ? ownLayouts.value : undefined));

/** Name of the layout in use; empty: the studio's own. @type {Signal<string>} */
export const layoutInUse = remembered("layout.in_use", "");

/** @param {string} name @returns {Arrangement | null} */
export const ownArrangement = (name) =>
  ownLayouts.value.find((one) => one.name === name)?.arrangement ?? null;

/** @param {string} name @param {Arrangement} arrangement under a name that exists it takes its place @returns {boolean} kept */
export function saveLayout(name, arrangement) {
  const called = tidyName(name);
  if (called === "") return false;
  const layout = { name: called, arrangement };
  const known = ownLayouts.value.some((one) => one.name === called);
  if (!known && ownLayouts.value.length >= LAYOUTS_MOST) return false;
  ownLayouts.value = known
    ? ownLayouts.value.map((one) => (one.name === called ? layout : one))
    : [...ownLayouts.value, layout];
  layoutInUse.value = called;
  return true;
}

/** @param {string} name @param {string} wanted @returns {boolean} false: that name is taken, or none */
export function renameLayout(name, wanted) {
  const called = tidyName(wanted);
  if (called === name) return true;
  if (called === "" || ownArrangement(called)) return false;
  ownLayouts.value = ownLayouts.value.map((one) =>
    one.name === name ? { ...one, name: called } : one,
  );
  if (layoutInUse.value === name) layoutInUse.value = called;
  return true;
}

/** @param {string} name */
export function deleteLayout(name) {
  ownLayouts.value = ownLayouts.value.filter((one) => one.name !== name);
  if (layoutInUse.value === name) layoutInUse.value = "";
}

/** @param {readonly OwnLayout[]} layouts from a file; none takes the place of another @returns {number} how many had room */
export function addLayouts(layouts) {
  const all = [...ownLayouts.value];
  for (const { name, arrangement } of layouts.slice(0, LAYOUTS_MOST - all.length))
    all.push({ name: freeName(name, all), arrangement });
  const added = all.length - ownLayouts.value.length;
  ownLayouts.value = all;
  return added;
}
