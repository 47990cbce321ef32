/** What a person can ask of the live scene. */

/** @import { FrameView, Remark, TopicView } from "../types/wire.d.ts" */
/** @import { Asked } from "./wire.js" */
/** @import { Command } from "../types/wire.d.ts" */
/** @import { Move } from "../lib/live-drop.js" */

import { latestSender } from "../lib/latest.js";
import { groupNames, moveOfDisplay, moveOfGroup } from "../lib/live-displays.js";
import { ask } from "./actions.js";
import { kinds, liveDisplays, onTheirWay, wayKey } from "./state/live.js";
import { send } from "./wire.js";

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
  if (kinds.value.size > 0) return;
  const answer = await ask({ type: "get_display_kinds" });
  if (answer?.type === "display_kinds")
    kinds.value = new Map(answer.kinds.map((one) => [one.kind, one]));
}

/** @returns {Promise<readonly TopicView[] | null>} null: the studio does not answer */
export async function topicsNow() {
  try {
    const answer = await send({ type: "get_topics" });
    return answer.type === "topics" ? answer.topics : null;
  } catch {
    return null; // asked again and again: what is in the way says itself elsewhere
  }
}

/** @returns {Promise<readonly FrameView[]>} */
export async function framesNow() {
  const answer = await ask({ type: "get_tf" });
  return answer?.type === "tf_frames" ? answer.frames : [];
}
