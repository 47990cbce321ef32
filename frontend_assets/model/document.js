/**
 * The open document as the studio last told it. Only its events write here, so that what the page
 * shows is always the studio's own answer.
 */

/** @import { Displays, DocumentEntry, DocumentState, History, LeftWorkEntry, Problem, Progress, Restored, RobotState, SiteView, Sites } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, signal } from "vendor/preact.js";
import { movableJoints } from "../lib/joints.js";
import { remembered } from "../lib/remembered.js";
import { isChanged } from "../lib/sites.js";
import { linkTree } from "../lib/tree.js";
import { documentId } from "./connection.js";
import { onJointFrame, subscribe } from "./wire.js";

/** @type {Signal<readonly DocumentEntry[]>} */
export const documents = signal([]);
/** @type {Signal<DocumentState | null>} */
export const documentState = signal(null);
/** @type {Signal<RobotState | null>} */
export const robot = signal(null);
/** Of the robot and its texts. @type {Signal<readonly Problem[]>} */
export const documentProblems = signal([]);
/** Of the packages around it, as far as somebody looked. @type {import("vendor/preact.js").Signal<readonly Problem[]>} */
export const packageProblems = signal([]);
/** Both. */
export const problems = computed(() => [...documentProblems.value, ...packageProblems.value]);
export const showingLastGood = signal(false);
/** @type {Signal<History>} */
export const history = signal({
  type: "history",
  undo: [],
  redo: [],
  unsaved_files: [],
  unsaved_count: 0,
});
/** @type {Signal<Displays["displays"]>} */
export const displays = signal({});
/** Work that is going on, by task. @type {Signal<ReadonlyMap<string, Progress>>} */
export const progress = signal(new Map());
/** @type {Signal<{ok: boolean, duration_ms: number} | null>} */
export const built = signal(null);
/** The last file that another program wrote and that was merged. @type {Signal<import("../types/wire.d.ts").DiskMerged | null>} */
export const diskMerged = signal(null);
export const animating = signal(false);
/** The document was closed, here or in another tab; or the studio does not know it (any more). */
export const gone = signal(false);

/** @type {Signal<readonly string[]>} */
export const siteOrder = signal([]);
/** Counts changes of which sites there are and where they are listed, not of what they say. */
export const sitesRevision = signal(0);
/** @type {Signal<ReadonlySet<string>>} */
const changedSites = signal(new Set());
/** @type {Map<string, Signal<SiteView>>} */
const sites = new Map();
/** @type {Map<string, Signal<number>>} */
const positions = new Map();

export const movable = computed(() => movableJoints(robot.value?.joints ?? []));
export const links = computed(() => (robot.value ? linkTree(robot.value) : []));
/** How many sites say something else than the files on disk. */
export const changedCount = computed(() => changedSites.value.size);
export const title = computed(() => documentState.value?.title ?? "");
export const unsaved = computed(
  () => history.value.unsaved_count > 0 || history.value.unsaved_files.length > 0,
);

/** @param {string} id @returns {Signal<SiteView> | undefined} follows this one site */
export function site(id) {
  return sites.get(id);
}

/** @returns {Map<string, SiteView>} all sites now; follow `sitesRevision` beside it */
export function allSites() {
  return new Map([...sites].map(([id, one]) => [id, one.peek()]));
}

/** @param {string} id of a site @returns {string[]} of the properties that its expression may name */
export function namesBeside(id) {
  const names = [...allSites().values()]
    .filter((one) => one.kind === "property" && one.id !== id && /^[A-Za-z_]\w*$/.test(one.name))
    .map(({ name }) => name);
  return [...new Set(names)];
}

/** @param {string} joint @returns {Signal<number>} its position, rad or m */
export function position(joint) {
  let found = positions.get(joint);
  if (!found) {
    found = signal(0);
    positions.set(joint, found);
  }
  return found;
}

/** @param {Sites} event */
function takeSites({ order, changed }) {
  const moved = changed.filter((one) => !sameEntry(sites.get(one.id)?.peek(), one)).length > 0;
  const unsavedSites = new Set(changedSites.value);
  for (const one of changed) {
    takeSite(one);
    if (isChanged(one)) unsavedSites.add(one.id);
    else unsavedSites.delete(one.id);
  }
  if (order) dropOthers(order, unsavedSites);
  changedSites.value = unsavedSites;
  if (order) siteOrder.value = order;
  if (order || moved) sitesRevision.value += 1;
}

/** @param {SiteView} one */
function takeSite(one) {
  const known = sites.get(one.id);
  if (known) known.value = one;
  else sites.set(one.id, signal(one));
}

/** @param {readonly string[]} order @param {Set<string>} unsavedSites */
function dropOthers(order, unsavedSites) {
  const kept = new Set(order);
  for (const id of sites.keys()) {
    if (kept.has(id)) continue;
    sites.delete(id);
    unsavedSites.delete(id);
  }
}

/** @param {SiteView | undefined} a @param {SiteView} b @returns {boolean} listed at the same place under the same name */
function sameEntry(a, b) {
  return (
    a !== undefined &&
    a.name === b.name &&
    a.kind === b.kind &&
    a.file === b.file &&
    a.group === b.group &&
    a.owner === b.owner
  );
}

/** @param {Progress} event */
function takeProgress(event) {
  const now = new Map(progress.value);
  if (event.total > 0 && event.done >= event.total) now.delete(event.task);
  else now.set(event.task, event);
  progress.value = now;
}

/** @param {Readonly<Record<string, number>>} values rad or m */
function takePositions(values) {
  for (const [joint, value] of Object.entries(values)) position(joint).value = value;
}

/** @param {{revision: number, positions: Float64Array}} frame one that fits no known robot is dropped */
function takeJointFrame({ revision, positions: values }) {
  const joints = movable.value;
  if (revision !== robot.value?.revision || values.length !== joints.length) return;
  batch(() => {
    joints.forEach((joint, at) => {
      position(joint.name).value = values[at] ?? 0;
    });
  });
}

onJointFrame(takeJointFrame);
subscribe("hello", () => {
  // Whatever was going on when the lane was lost is told anew, if it still is.
  progress.value = new Map();
});
subscribe("documents", (event) => {
  documents.value = event.documents;
});
subscribe("document", (event) => {
  documentState.value = event;
  gone.value = false;
});
subscribe("robot", (event) => {
  robot.value = event;
});
subscribe("joints", (event) => {
  takePositions(event.positions);
  animating.value = event.animating;
});
subscribe("sites", takeSites);
subscribe("problems", (event) => {
  documentProblems.value = event.problems;
  showingLastGood.value = event.showing_last_good;
});
subscribe("history", (event) => {
  history.value = event;
});
subscribe("displays", (event) => {
  displays.value = event.displays;
});
subscribe("progress", takeProgress);
subscribe("built", (event) => {
  built.value = event;
});
subscribe("disk_merged", (event) => {
  diskMerged.value = event;
});
subscribe("gone", (event) => {
  if (event.document === documentId.value) gone.value = true;
});

/** Edits of an earlier run that the studio brought back. @type {import("vendor/preact.js").Signal<Restored | null>} */
export const restored = signal(null);

subscribe("restored", (event) => {
  restored.value = event.at ? event : null;
});

/** Unsaved work on files that are not open. @type {import("vendor/preact.js").Signal<readonly LeftWorkEntry[]>} */
export const leftWork = signal([]);

subscribe("left_work", (event) => {
  leftWork.value = event.entries;
});

export const SAVE_CHOICES = /** @type {const} */ (["always", "several", "never"]);

/** When the changes are shown before they are written. @type {import("vendor/preact.js").Signal<typeof SAVE_CHOICES[number]>} */
export const showBeforeSaving = remembered(
  "save.show",
  /** @type {typeof SAVE_CHOICES[number]} */ ("always"),
  (value) => SAVE_CHOICES.some((one) => one === value),
);
