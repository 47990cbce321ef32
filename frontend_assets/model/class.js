/** The class that shares the studio: who we are in it, who has control, and what leaders see of it. */

/** @import { ClassState, Control, MemberView, SetClass, You } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { hasControl, lent, person, role } from "./connection.js";
import { halt } from "./driving.js";
import { ask } from "./requests.js";
import { notify } from "./view.js";
import { subscribe } from "./wire.js";

/** @type {Signal<You>} */
export const you = signal({
  type: "you",
  person: "",
  name: "",
  role: "guest",
  has_control: false,
  asking: false,
  hand: false,
});
/** @type {Signal<Control>} */
export const control = signal({
  type: "control",
  class_open: false,
  holder: "",
  name: "",
  document: "",
});
/** Null: we do not lead it. @type {Signal<ClassState | null>} */
export const classState = signal(null);

/** Presenters and helpers lead: they give control, and see who is there. */
export const leads = computed(() => role.value === "presenter" || role.value === "helper");
/** Who takes part may ask for control, raise a hand, and stop the robot. */
export const takesPart = computed(() => role.value !== "guest");

/** @returns {readonly MemberView[]} who waits for control, the first one first */
export const asking = computed(() => byTime(classState.value?.members ?? [], "asks_s"));
/** @returns {readonly MemberView[]} whose hand is raised, the first one first */
export const hands = computed(() => byTime(classState.value?.members ?? [], "hand_s"));
export const hereCount = computed(
  () => (classState.value?.members ?? []).filter(({ here }) => here).length,
);

/**
 * @param {readonly MemberView[]} members
 * @param {"asks_s" | "hand_s"} what
 * @returns {MemberView[]} those who do, in the order in which they began
 */
export function byTime(members, what) {
  const found = members.filter((one) => one.here && typeof one[what] === "number");
  return found.sort((one, other) => Number(one[what]) - Number(other[what]));
}

subscribe("you", (event) => {
  const before = you.value;
  you.value = event;
  role.value = event.role;
  person.value = event.person;
  hasControl.value = event.has_control;
  if (!leads.value) classState.value = null;
  if (before.person === event.person) sayControl(before, event);
});

/** @param {You} before @param {You} now */
function sayControl(before, now) {
  if (now.role === "presenter" || before.has_control === now.has_control) return;
  notify(t(now.has_control ? "class.control.came" : "class.control.went"));
}

subscribe("control", (event) => {
  control.value = event;
  lent.value = { holder: event.holder, document: event.document };
});

subscribe("class_state", (event) => {
  const before = asking.peek();
  classState.value = event;
  const known = new Set(before.map(({ person }) => person));
  const added = asking.peek().find(({ person }) => !known.has(person));
  if (added) notify(t("class.asks", { name: added.name }));
});

subscribe("stopped", ({ name }) => {
  halt();
  notify(name ? t("class.stopped.by", { name }) : t("class.stopped"), { bad: true });
});

export const startClass = () => ask({ type: "start_class" });
export const pauseClass = () => ask({ type: "pause_class" });
export const endClass = () => ask({ type: "end_class" });
/** @param {Omit<SetClass, "type" | "request" | "document" | "id">} changes */
export const setClass = (changes) => ask({ type: "set_class", ...changes });
export const renewCode = () => ask({ type: "renew_code" });
/** @param {string} person @param {"helper" | "student" | "guest"} chosen */
export const setMemberRole = (person, chosen) =>
  ask({ type: "set_member_role", person, role: chosen });
/** @param {string} person */
export const removeMember = (person) => ask({ type: "remove_member", person });
/** @param {string} person */
export const readmitMember = (person) => ask({ type: "readmit_member", person });
/** @param {string} person empty: back to the presenter */
export const giveControl = (person) => ask({ type: "give_control", person });
export const takeControl = () => ask({ type: "take_control" });
export const returnControl = () => ask({ type: "return_control" });
/** @param {boolean} wanted */
export const askControl = (wanted) => ask({ type: "ask_control", asking: wanted });
/** @param {boolean} raised */
export const raiseHand = (raised) => ask({ type: "raise_hand", raised });
/** @param {string} [person] everybody's, if none is named */
export const lowerHand = (person = "") => ask({ type: "lower_hand", person });
export const stopRobot = () => ask({ type: "stop_robot" });
/** @param {string} name */
export const setName = (name) => ask({ type: "set_name", name });
