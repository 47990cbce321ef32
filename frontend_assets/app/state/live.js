/** The live scene as the studio last told it: displays of topics, how they fare, and the fixed frame. */

/** @import { DisplayKindView, DisplayState, DisplayStates, DisplayView, LiveDisplays } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";

/** @type {Signal<LiveDisplays>} */
const told = signal({ type: "live_displays", displays: [], groups_off: [], fixed_frame: "" });
/** @type {Signal<DisplayStates>} */
const fares = signal({ type: "display_states", states: [], fixed_frame_trouble: "" });

/** Kinds of displays, once somebody asked for them. @type {Signal<ReadonlyMap<string, DisplayKindView>>} */
export const kinds = signal(new Map());
/** In the order in which they are listed. */
export const liveDisplays = computed(() => told.value.displays);
export const groupsOff = computed(() => told.value.groups_off);
/** Empty: that of the robot's root link. */
export const fixedFrame = computed(() => told.value.fixed_frame);
/** Why nothing can be drawn in the fixed frame; empty: it can. */
export const frameTrouble = computed(() => fares.value.fixed_frame_trouble);
/** @type {import("vendor/preact.js").ReadonlySignal<ReadonlyMap<string, DisplayState>>} */
export const displayStates = computed(
  () => new Map(fares.value.states.map((one) => [one.id, one])),
);

/** Values on their way, by display and name: they are shown at once. @type {Signal<ReadonlyMap<string, boolean | number | string>>} */
export const onTheirWay = signal(new Map());

/** @param {string} display @param {string} name */
export const wayKey = (display, name) => `${display} ${name}`;

/** @param {DisplayView} display @param {string} name @returns {boolean | number | string | undefined} as it is, or as it is about to be */
export const settingOf = ({ id, values }, name) =>
  onTheirWay.value.get(wayKey(id, name)) ??
  (Object.hasOwn(values, name) ? values[name] : undefined);

/** @param {LiveDisplays} event */
export function takeLiveDisplays(event) {
  told.value = event;
}

/** @param {DisplayStates} event */
export function takeDisplayStates(event) {
  fares.value = event;
}
