/**
 * Displays of topics in the 3D view: which there are, their state and settings, the fixed frame,
 * and what can be asked of them.
 */

/** @import { Command, DisplayKindView, DisplayState, DisplayStates, DisplayView, FrameView, LiveDisplays, Remark, TopicView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Asked } from "./wire.js" */
/** @import { Move } from "../lib/live-displays.js" */

import { computed, signal } from "vendor/preact.js";
import { latestSender } from "../lib/latest.js";
import { groupNames, moveOfDisplay, moveOfGroup } from "../lib/live-displays.js";
import { ask } from "./requests.js";
import { send, subscribe } from "./wire.js";

/** @type {Signal<LiveDisplays>} */
const state = signal({
  type: "live_displays",
  displays: [],
  groups_off: [],
  fixed_frame: "",
  kinds: 0,
});
/** @type {Signal<DisplayStates>} */
const fares = signal({ type: "display_states", states: [], fixed_frame_trouble: "" });

/** Kinds of displays, once somebody asked for them. @type {Signal<ReadonlyMap<string, DisplayKindView>>} */
export const kinds = signal(new Map());
/** Why files of the owner's own displays are switched off. @type {Signal<Readonly<Record<string, string>>>} */
export const pluginFaults = signal({});
/** In the order in which they are listed. */
export const liveDisplays = computed(() => state.value.displays);
export const groupsOff = computed(() => state.value.groups_off);
/** Empty: that of the robot's root link. */
export const fixedFrame = computed(() => state.value.fixed_frame);
/** Why nothing can be drawn in the fixed frame; empty: it can. */
export const frameTrouble = computed(() => fares.value.fixed_frame_trouble);
/** @type {import("vendor/preact.js").ReadonlySignal<ReadonlyMap<string, DisplayState>>} */
export const displayStates = computed(
  () => new Map(fares.value.states.map((one) => [one.id, one])),
);

/** Values on their way, by display and name: they are shown at once. @type {Signal<ReadonlyMap<string, boolean | number | string>>} */
const onTheirWay = signal(new Map());

/** @param {string} display @param {string} name */
const wayKey = (display, name) => `${display} ${name}`;

/** @param {DisplayView} display @param {string} name @returns {boolean | number | string | undefined} as it is, or as it is about to be */
export const settingOf = ({ id, values }, name) =>
  onTheirWay.value.get(wayKey(id, name)) ??
  (Object.hasOwn(values, name) ? values[name] : undefined);

subscribe("live_displays", (event) => {
  const isOther = event.kinds !== state.peek().kinds;
  state.value = event;
  // A file of the owner's own displays came, changed or went: who knew the kinds asks again.
  if (isOther && kinds.peek().size > 0) askForKinds();
});

subscribe("display_states", (event) => {
  fares.value = event;
});

/** @typedef {boolean | number | string} Value */
/** @typedef {{topic: string, reliable?: boolean | null, latched?: boolean | null, depth?: number | null}} Listening null: as fits its publishers */

/** @param {string} kind @param {string} [topic] */
export const addDisplay = (kind, topic = "") => ask({ type: "add_display", kind, topic });
/** @param {string} display */
export const removeDisplay = (display) => ask({ type: "remove_display", display });
/** @param {string} display */
export const duplicateDisplay = (display) => ask({ type: "duplicate_display", display });
/** @param {string} display @param {string} name */
export const renameDisplay = (display, name) => ask({ type: "arrange_display", display, name });
/** @param {string} display @param {string} group empty: out of any */
export const groupDisplay = (display, group) => ask({ type: "arrange_display", display, group });
/** @param {string} display @param {boolean} enabled */
export const switchDisplay = (display, enabled) =>
  ask({ type: "switch_displays", display, enabled });
/** @param {string} group @param {boolean} enabled */
export const switchGroup = (group, enabled) => ask({ type: "switch_displays", group, enabled });
/** @param {string} display @param {Listening} listening */
export const listenTo = (display, listening) =>
  ask({ type: "set_display_topic", display, ...listening });
/** @param {string} frame empty: that of the robot's root link */
export const setFixedFrame = (frame) => ask({ type: "set_fixed_frame", frame });

/** @param {string} group @param {string} name */
export async function renameGroup(group, name) {
  const members = liveDisplays.value.filter((one) => one.group === group);
  for (const { id } of members) if (!(await groupDisplay(id, name))) return;
}

/** @param {string} group all that are in it go with it */
export async function removeGroup(group) {
  const members = liveDisplays.value.filter((one) => one.group === group);
  for (const { id } of members) if (!(await removeDisplay(id))) return;
}

/** @param {string} display @param {1 | -1} step */
export const moveDisplay = (display, step) =>
  placeDisplays(moveOfDisplay(liveDisplays.value, display, step));
/** @param {string} group @param {1 | -1} step */
export const moveGroup = (group, step) =>
  placeDisplays(moveOfGroup(liveDisplays.value, group, step));

/** @param {readonly Move[] | null} moves one after the other */
export async function placeDisplays(moves) {
  for (const one of moves ?? []) if (!(await ask({ type: "arrange_display", ...one }))) return;
}

/** @returns {string[]} */
export const groupsNow = () => groupNames(liveDisplays.value);

/** @type {Map<string, ReturnType<typeof latestSender<Value>>>} */
const senders = new Map();

/** @param {string} display @param {string} name @returns {ReturnType<typeof latestSender<Value>>} */
function senderOf(display, name) {
  const key = wayKey(display, name);
  const sender =
    senders.get(key) ??
    latestSender((/** @type {Value} */ value) =>
      ask({ type: "set_display_property", display, name, value }),
    );
  senders.set(key, sender);
  return sender;
}

/** @param {string} display @param {string} name @param {Value} value the newest wins, and is shown at once */
export async function setProperty(display, name, value) {
  const key = wayKey(display, name);
  const sender = senderOf(display, name);
  onTheirWay.value = new Map(onTheirWay.value).set(key, value);
  sender.push(value);
  await sender.settled();
  if (sender.busy()) return;
  senders.delete(key);
  const left = new Map(onTheirWay.value);
  left.delete(key);
  onTheirWay.value = left;
}

/** @param {Remark} remark do what it offers */
export function mendDisplay({ mend }) {
  if (mend) ask(/** @type {Asked<Command>} */ (/** @type {unknown} */ (mend.command)));
}

/** Have the kinds of displays be known; asked for once. */
export async function needKinds() {
  if (kinds.value.size === 0) await askForKinds();
}

async function askForKinds() {
  const answer = await ask({ type: "get_display_kinds" });
  if (answer?.type !== "display_kinds") return;
  kinds.value = new Map(answer.kinds.map((one) => [one.kind, one]));
  pluginFaults.value = answer.plugin_faults;
}

/** @returns {Promise<readonly TopicView[] | null>} null: the studio does not answer */
export async function topicsNow() {
  try {
    const answer = await send({ type: "get_topics" });
    return answer.type === "topics" ? answer.topics : null;
  } catch {
    return null; // asked again with the next change: what is in the way says itself elsewhere
  }
}

/** @returns {Promise<readonly FrameView[]>} */
export async function framesNow() {
  const answer = await ask({ type: "get_tf" });
  return answer?.type === "tf_frames" ? answer.frames : [];
}

/** @param {string} frame @param {string} fixed @returns {Promise<{pose: import("../types/wire.d.ts").TfPose | null, trouble: string}>} where a frame is in another; or why that is not known */
export async function poseNow(frame, fixed) {
  try {
    const answer = await send({ type: "get_tf", frame, seen_from: fixed, pose_only: true });
    return answer.type === "tf_frames" ? answer : { pose: null, trouble: "" };
  } catch {
    return { pose: null, trouble: "" }; // the connection says itself elsewhere what is in the way
  }
}
