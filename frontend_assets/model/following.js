/**
 * Looking at what the presenter looks at: their page sends camera, pointer, selection and panel, and
 * the pages of others take them until a gesture of their own leaves.
 */

/** @import { Focus } from "../types/wire.d.ts" */
/** @import { View } from "./wire.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { classState, control } from "./class.js";
import { connection, documentId, ownerOf, person, role } from "./connection.js";
import { isOwnCopy } from "./copies.js";
import { hoverSite, pointedSite } from "./origin.js";
import { goTo } from "./requests.js";
import { part, selection, selectPart } from "./selection.js";
import { activePanel } from "./view.js";
import { viewport } from "./viewport.js";
import { onView, send, subscribe } from "./wire.js";

/** Of the presenter's camera; more often nobody sees. */
const SHOW_EVERY_MS = 33;
/** A shorter way of the camera is none: what is at rest costs nothing. */
const STILL_M = 1e-5;
/** What is selected by following is by nobody here. */
const BY = "presenter";
/** So long after a press a change is still its doing. */
const GESTURE_MS = 1000;

/** Whether the presenter shows others what they look at. */
export const leading = signal(false);
/** Whether this page takes part in that. */
export const follows = signal(true);
/** Others than the presenter may follow while they are led; on a copy of their own they work alone. */
export const canFollow = computed(
  () => leading.value && control.value.class_open && role.value !== "presenter" && !isOwnCopy.value,
);
/** This page shows what the presenter looks at. */
export const isFollowing = computed(
  () => canFollow.value && follows.value && connection.value === "connected",
);
/** How many are shown what this page, the presenter's, looks at. */
const followers = computed(
  () =>
    (classState.value?.members ?? []).filter((one) => one.follows).length +
    (classState.value?.viewers ?? 0),
);
/** A page that nobody has touched yet leads nobody: it may be the one on the projector. */
const touched = signal(false);
const leads = computed(
  () =>
    role.value === "presenter" &&
    leading.value &&
    touched.value &&
    followers.value > 0 &&
    connection.value === "connected",
);

/** @param {boolean} wanted */
export const lead = (wanted) => send({ type: "lead", leading: wanted }).catch(() => null);
export const gatherAll = () => send({ type: "gather_all" }).catch(() => null);

/** Look around for oneself: a click comes back. */
export function explore() {
  if (canFollow.value) follows.value = false;
}

/** Come back to what the presenter looks at. */
export function comeBack() {
  follows.value = true;
}

subscribe("leading", (event) => {
  leading.value = event.leading;
});
subscribe("gather", ({ document }) => {
  if (!isOwnCopy.value) comeBack();
  else if (document !== documentId.value) goTo(documentId.value.split("~")[0] ?? "");
});
subscribe("focus", (event) => {
  if (isFollowing.value) takeFocus(event);
});
onView((view) => {
  if (isFollowing.value) takeView(view);
});

/** @param {View} view */
function takeView({ eye, target, pointer, up, flat, field }) {
  viewport.value?.setCamera({ position: eye, target, up, flat, field });
  viewport.value?.setGuide(pointer);
}

/** The panel that is open, as far as this page was told of it. @type {string | null | undefined} */
let opened;

/** Shows something to those who lead the class, and to nobody who follows. */
const OF_LEADERS = "people";

/** @param {Focus} focus */
function takeFocus({ document, part: key, site, panel }) {
  if (document && document !== documentId.value) {
    // The owner of a copy that is shown works on it, or came back from it: they are told instead.
    return ownerOf(document) === person.value ? undefined : goTo(document);
  }
  if (key !== (part.peek() ?? "")) {
    if (key) selectPart(key, "", "", BY);
    else selection.value = null;
  }
  hoverSite(site || null);
  if (panel && panel !== OF_LEADERS && panel !== activePanel.peek()) {
    opened = panel; // not by a hand on this page
    commandById(`panel.${panel}`)?.run();
  }
  return undefined;
}

/** Keep the studio, the 3D view and the followers informed. */
export function followPresenter() {
  effect(() => {
    const wanted = isFollowing.value;
    if (connection.value !== "connected" || role.value === "presenter") return;
    send({ type: "follow", following: wanted }).catch(() => null);
    if (!wanted) untracked(() => viewport.value?.setGuide(null));
  });
  effect(() => leaveByHand(viewport.value));
  effect(() => leaveBySelecting(selection.value));
  effect(() => leaveByOpening(activePanel.value));
  effect(showFocus);
  effect(() => (leads.value ? showViews() : undefined));
  addEventListener("pointerdown", touch, { capture: true });
  addEventListener("keydown", touch, { capture: true });
}

let touchedAt_ms = Number.NEGATIVE_INFINITY;

function touch() {
  touched.value = true;
  touchedAt_ms = performance.now();
}

/** What changes now was changed by a hand on this page, and not by what it is sent. */
const isByHand = () => performance.now() - touchedAt_ms < GESTURE_MS;

/** @param {import("./viewport.js").Studio3d | null} view @returns {(() => void) | undefined} */
function leaveByHand(view) {
  if (!view) return undefined;
  const leave = () => {
    touch();
    explore();
  };
  view.events.addEventListener("touch", leave);
  return () => view.events.removeEventListener("touch", leave);
}

/** @param {import("./selection.js").Selection | null} chosen */
function leaveBySelecting(chosen) {
  if (chosen && chosen.by !== BY && isByHand()) untracked(explore);
}

/** @param {string | null} panel */
function leaveByOpening(panel) {
  // The panel that the page begins with is nobody's choice.
  const isChosen = opened !== undefined && opened !== null && panel !== opened;
  opened = panel;
  if (isChosen && isByHand()) untracked(explore);
}

function showFocus() {
  const focus = {
    part: part.value ?? "",
    site: pointedSite.value ?? "",
    panel: activePanel.value ?? "",
  };
  if (leads.value) send({ type: "show_focus", ...focus }).catch(() => null);
}

/** @returns {() => void} the end of it */
function showViews() {
  let last = "";
  const show = () => {
    const view = viewport.peek();
    const camera = view?.getCamera();
    if (!view || !camera) return;
    const { position, target, up, flat, field } = camera;
    const pointer = view.pointedPlace();
    const places = [position, target, up, pointer ?? [], [field]].flat().map(rounded);
    const now = `${places} ${flat}`;
    if (now === last) return;
    last = now;
    send({
      type: "show_view",
      eye: [...position],
      target: [...target],
      up: [...up],
      ...{ flat, field, pointer },
    }).catch(() => null);
  };
  const timer = setInterval(show, SHOW_EVERY_MS);
  return () => clearInterval(timer);
}

/** @param {number} value */
const rounded = (value) => Math.round(value / STILL_M);
