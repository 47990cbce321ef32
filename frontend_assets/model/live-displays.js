/**
 * Displays of topics in the 3D view: which there are, their state and settings, the fixed frame,
 * and what can be asked of them.
 */

/** @import { Command, DisplayKindView, DisplayState, DisplayStates, DisplayView, FrameView, LiveDisplays, Remark, TopicView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Asked } from "./wire.js" */
/** @import { Move } from "../lib/display-groups.js" */

import { computed, signal } from "vendor/preact.js";
import { groupName, groupPaths, isWithin, outerGroup } from "../lib/display-groups.js";
import { t } from "../lib/i18n.js";
import { latestValues } from "../lib/latest.js";
import { ask } from "./requests.js";
import { notify } from "./view.js";
import { send, subscribe } from "./wire.js";

/** @type {Signal<LiveDisplays>} */
const state = signal({
  type: "live_displays",
  displays: [],
  groups_off: [],
  fixed_frame: "",
  kinds: 0,
  paused: false,
  background: "",
  frame_rate: 0,
});
/** @type {Signal<DisplayStates>} */
const fares = signal({
  type: "display_states",
  states: [],
  fixed_frame: { frame: "", level: "ok", sentence: "" },
  fixed_frame_trouble: "",
});

/** Kinds of displays, once somebody asked for them. @type {Signal<ReadonlyMap<string, DisplayKindView>>} */
export const kinds = signal(new Map());
/** Why files of the owner's own displays are switched off. @type {Signal<Readonly<Record<string, string>>>} */
export const pluginFaults = signal({});
/** In the order in which they are listed. */
export const liveDisplays = computed(() => state.value.displays);
/** Behind the 3D view, as `#rrggbb`; empty: that of the theme. */
export const background = computed(() => state.value.background);
/** Pictures of the 3D view per second at most; 0: as many as there can be. */
export const frameRate = computed(() => state.value.frame_rate);
export const groupsOff = computed(() => state.value.groups_off);
/** Empty: that of the robot's root link. */
export const fixedFrame = computed(() => state.value.fixed_frame);
/** Whether drawing is paused, for all who look at the document. */
export const paused = computed(() => state.value.paused);
/** Whether there is a frame of that name, as RViz's global status has it. */
export const fixedFrameState = computed(() => fares.value.fixed_frame);
/** Why the robot cannot be drawn in the fixed frame; empty: it can. */
export const frameTrouble = computed(() => fares.value.fixed_frame_trouble);
/** @type {import("vendor/preact.js").ReadonlySignal<ReadonlyMap<string, DisplayState>>} */
export const displayStates = computed(
  () => new Map(fares.value.states.map((one) => [one.id, one])),
);

/** @type {ReturnType<typeof latestValues<Value>>} */
const properties = latestValues((display, name, value) =>
  ask({ type: "set_display_property", display, name, value }),
);

/** @param {DisplayView} display @param {string} name @returns {boolean | number | string | undefined} as it is, or as it is about to be */
export const settingOf = ({ id, values }, name) =>
  properties.coming(id, name) ?? (Object.hasOwn(values, name) ? values[name] : undefined);

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
/** @param {string} display @param {string} name as it is told of, with the way back */
export async function removeDisplay(display, name) {
  if (await ask({ type: "remove_display", display })) offerBack(name, [display]);
}
/** @param {string} group all that is in it goes with it */
export async function removeGroup(group) {
  const gone = liveDisplays.value.filter((one) => isWithin(one.group, group));
  if (!(await ask({ type: "remove_display", group }))) return;
  offerBack(
    groupName(group),
    gone.map(({ id }) => id),
  );
}

/** @param {string} name @param {string[]} displays */
function offerBack(name, displays) {
  const run = () => void ask({ type: "restore_displays", displays });
  notify(t("live.removed", { name }), { action: { label: t("command.undo"), run } });
}

/** @param {string} display */
export const duplicateDisplay = (display) => ask({ type: "duplicate_display", display });
/** @param {string} display @param {string} name */
export const renameDisplay = (display, name) => ask({ type: "arrange_display", display, name });
/** @param {string} display @param {boolean} enabled */
export const switchDisplay = (display, enabled) =>
  ask({ type: "switch_displays", display, enabled });
/** @param {string} group @param {boolean} enabled */
export const switchGroup = (group, enabled) => ask({ type: "switch_displays", group, enabled });
/** @param {boolean} enabled each of them, and all groups */
export const switchAll = (enabled) => ask({ type: "switch_displays", enabled });
/** @param {boolean} on for all who look at the document */
export const pauseScene = (on) => ask({ type: "pause_scene", paused: on });
/** Have all that was received be forgotten, as RViz's Reset does. */
export const resetScene = () => ask({ type: "reset_scene" });
/** @param {string} display @param {Listening} listening */
export const listenTo = (display, listening) =>
  ask({ type: "set_display_topic", display, ...listening });
/** @param {string} frame empty: that of the robot's root link */
export const setFixedFrame = (frame) => ask({ type: "set_fixed_frame", frame });

/** @param {string} group its path @param {string} name with slashes it goes into groups of that name */
export const renameGroup = (group, name) =>
  ask({
    type: "arrange_group",
    group,
    to: [outerGroup(group), name].filter(Boolean).join("/"),
  });
/** @param {string} group what is in it stands where it stood */
export const dissolveGroup = (group) => ask({ type: "arrange_group", group, to: "" });
/** @param {Move | null} move null: there is nothing to do */
export const moveLive = (move) => move && ask(move);

/** @returns {string[]} */
export const groupsNow = () => groupPaths(liveDisplays.value);

/** Of a display, by its id and the name of the property; the newest wins, and is shown at once. */
export const setProperty = properties.set;

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

/** What a server of interactive markers publishes, below its namespace. */
const MARKER_UPDATES = { type: "visualization_msgs/msg/InteractiveMarkerUpdate", name: "/update" };

/** @returns {Promise<string[]>} namespaces of servers of interactive markers */
export async function markerServersNow() {
  const { type, name: last } = MARKER_UPDATES;
  const topics = (await topicsNow()) ?? [];
  return topics
    .filter(({ name, types }) => types.includes(type) && name.endsWith(last))
    .map(({ name }) => name.slice(0, -last.length));
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
