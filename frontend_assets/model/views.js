/**
 * RViz's views as a person works with them: the one that is shown, those that are saved with the
 * robot for all, and those that this browser saved for itself. The camera is the person's own, so the
 * studio is only told what is saved for all.
 */

/** @import { SavedView, ViewKindView } from "../types/wire.d.ts" */
/** @import { Triple, Value } from "../lib/view-poses.js" */
/** @import { ShownView } from "./viewport.js" */

import { computed, signal } from "vendor/preact.js";
import { addCommands } from "../lib/commands.js";
import { remembered } from "../lib/remembered.js";
import { isFlat as isFlatView, isKind, isOn, ORTHOGRAPHIC } from "../lib/view-poses.js";
import { ask } from "./requests.js";
import { isFree } from "./view.js";
import { shownView, viewport } from "./viewport.js";
import { send, subscribe } from "./wire.js";

/** @typedef {ShownView & {name: string}} ViewSpec a view with its name, as it is saved */
/** @typedef {ViewSpec & {id: string}} Saved */

const OWN_MAX = 100;
const NAME_MAX = 80;

/** In RViz's order, once somebody asked for them. @type {import("vendor/preact.js").Signal<readonly ViewKindView[]>} */
export const viewKinds = signal([]);
/** Saved with the robot, for all who look at it. @type {import("vendor/preact.js").Signal<readonly SavedView[]>} */
export const sharedViews = signal([]);
/** Saved in this browser. @type {import("vendor/preact.js").Signal<readonly Saved[]>} */
export const ownViews = remembered("views", /** @type {readonly Saved[]} */ ([]), areViews);
/** Whether the cube in the corner is shown. */
export const showsCube = remembered("view.cube", true);
/** What was shown before the view was exchanged for another. @type {import("vendor/preact.js").Signal<ShownView | null>} */
export const viewBefore = signal(null);

/** Whether it is seen without perspective. */
export const isFlat = computed(() => {
  const { kind, values } = shownView.value ?? { kind: "", values: {} };
  return isKind(kind) && isFlatView({ kind, values });
});
/** Whether it can be seen with perspective and without. */
export const canFlatten = computed(() => shownView.value?.kind !== "TopDownOrtho");

subscribe("saved_views", (event) => {
  sharedViews.value = event.views;
});

/** @param {unknown} stored */
function areViews(stored) {
  if (!Array.isArray(stored) || stored.length > OWN_MAX) return false;
  return stored.every(
    (one) =>
      typeof one?.id === "string" &&
      typeof one.name === "string" &&
      isKind(one.kind) &&
      typeof one.values === "object" &&
      one.values !== null,
  );
}

export async function askViewKinds() {
  if (viewKinds.peek().length > 0) return;
  const answer = await send({ type: "get_view_kinds" }).catch(() => null);
  if (answer?.type === "view_kinds") viewKinds.value = answer.kinds;
}

/** The view that is shown, with all that a hand did. @param {string} [name] @returns {ViewSpec | null} null: there is no 3D view */
export function currentView(name = "") {
  const view = viewport.peek()?.getView();
  return view ? { ...view, name } : null;
}

/** Fly to a view. @param {ShownView} view @param {boolean} [animate] */
export function useView({ kind, values }, animate = true) {
  leave();
  viewport.peek()?.useView({ kind, values }, animate);
}

/** Another kind of view, which shows the same as far as it can. @param {string} kind */
export function useKind(kind) {
  leave();
  viewport.peek()?.setViewKind(kind);
}

/** @param {string} name RViz's @param {Value} value */
export function setViewValue(name, value) {
  viewport.peek()?.touch();
  viewport.peek()?.setViewValue(name, value);
}

/** The same point from another side. @param {Triple} direction from it to the eye */
export function seeFrom(direction) {
  viewport.peek()?.touch();
  viewport.peek()?.seeFrom(direction);
}

/** As a drag of the mouse across so many px. @param {number} dx @param {number} dy */
export function turnBy(dx, dy) {
  viewport.peek()?.touch();
  viewport.peek()?.turnBy(dx, dy);
}

/** RViz's Zero. */
export function zeroView() {
  leave();
  viewport.peek()?.zero();
}

/** Back to what was shown before; once more comes here again. */
export function goBack() {
  const before = viewBefore.peek();
  if (before) useView(before);
}

/** Before another view takes over, so that there is a way back. */
function leave() {
  viewport.peek()?.touch();
  viewBefore.value = viewport.peek()?.getView() ?? null;
}

export function toggleFlat() {
  const { kind, values } = viewport.peek()?.getView() ?? { kind: "", values: {} };
  if (isKind(kind) && kind !== "TopDownOrtho")
    setViewValue(ORTHOGRAPHIC, !isOn({ kind, values }, ORTHOGRAPHIC));
}

/* Saved for all. */

/** @param {ViewSpec} view @param {string} [before] id of the one that it comes to stand before */
export const saveShared = ({ kind, name, values }, before = "") =>
  ask({ type: "save_view", kind, name, values: { ...values }, before });
/** @param {string} view @param {string} name */
export const renameShared = (view, name) => ask({ type: "rename_view", view, name });
/** @param {string} view */
export const deleteShared = (view) => ask({ type: "delete_view", view });
/** @param {string} view @param {string} before empty: at the end */
export const moveShared = (view, before) => ask({ type: "move_view", view, before });

/* Saved here. */

/** @param {ViewSpec} view @param {string} [before] */
export async function saveOwn({ kind, name, values }, before = "") {
  if (ownViews.value.length >= OWN_MAX) return false;
  const saved = { id: crypto.randomUUID?.() ?? `${Date.now()}`, kind, values };
  placeOwn({ ...saved, name: name.trim().slice(0, NAME_MAX) }, before);
  return true;
}

/** @param {Saved} view @param {string} before */
function placeOwn(view, before) {
  const others = ownViews.value.filter(({ id }) => id !== view.id);
  const at = others.findIndex(({ id }) => id === before);
  ownViews.value = others.toSpliced(at < 0 ? others.length : at, 0, view);
}

/** @param {string} view @param {string} name */
export async function renameOwn(view, name) {
  ownViews.value = ownViews.value.map((one) =>
    one.id === view ? { ...one, name: name.trim().slice(0, NAME_MAX) } : one,
  );
  return true;
}

/** @param {string} view */
export async function deleteOwn(view) {
  ownViews.value = ownViews.value.filter(({ id }) => id !== view);
  return true;
}

/** @param {string} view @param {string} before */
export async function moveOwn(view, before) {
  const moved = ownViews.value.find(({ id }) => id === view);
  if (moved && view !== before) placeOwn(moved, before);
  return true;
}

/** Keys and menus of the camera. */
export function addViewCommands() {
  const isThere = () => viewport.value !== null && isFree();
  addCommands([
    {
      id: "look_at",
      icon: "target",
      keys: ["F"],
      enabled: () => isThere() && viewport.value?.isPointing() === true,
      run: () => viewport.value?.lookAtPointed() || viewport.value?.fit(),
    },
    {
      id: "fit",
      icon: "fit",
      keys: ["F"],
      enabled: isThere,
      run: () => viewport.value?.fit(),
    },
    { id: "zero_view", icon: "reset", keys: ["Z"], enabled: isThere, run: zeroView },
    {
      id: "orthographic",
      icon: "cube",
      keys: ["5"],
      enabled: () => isThere() && canFlatten.value,
      run: toggleFlat,
    },
  ]);
}
