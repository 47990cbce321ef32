/**
 * The open document as the studio last told it. Only `receive` writes here, so that what the page
 * shows is always the studio's own answer.
 */

/**
 * @import { Displays, DocumentEntry, DocumentState, Event, History, JointPositions, Problem, Progress,
 *   RobotState, SiteView, Sites } from "../../types/wire.d.ts"
 * @import { Signal } from "vendor/preact.js"
 */

import { batch, computed, signal } from "vendor/preact.js";
import { movableJoints } from "../../lib/joints.js";
import { isChanged } from "../../lib/sites.js";
import { linkTree } from "../../lib/tree.js";
import { role, session, version } from "./connection.js";
import { takeCalls, takeGoals, takePublications } from "./deeds.js";
import { takeLeftWork, takeRestored } from "./keeping.js";
import { takeDisplayStates, takeLiveDisplays } from "./live.js";
import { takeParameterNews } from "./parameter-values.js";
import { takePoses } from "./poses.js";
import { takeFeed, takeRos } from "./ros.js";
import { takeTextNews } from "./source.js";
import { takeComparison, takeVariants } from "./variants.js";

/** Id of the document that this page shows; empty: none. */
export const documentId = signal("");
/** @type {Signal<readonly DocumentEntry[]>} */
export const documents = signal([]);
/** @type {Signal<DocumentState | null>} */
export const documentState = signal(null);
/** @type {Signal<RobotState | null>} */
export const robot = signal(null);
/** @type {Signal<readonly Problem[]>} */
export const problems = signal([]);
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
/** The last file that another program wrote and that was merged. @type {Signal<import("../../types/wire.d.ts").DiskMerged | null>} */
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
export function takeJointFrame({ revision, positions: values }) {
  const joints = movable.value;
  if (revision !== robot.value?.revision || values.length !== joints.length) return;
  batch(() => {
    joints.forEach((joint, at) => {
      position(joint.name).value = values[at] ?? 0;
    });
  });
}

/** @param {Event} event one that the studio sent by itself */
export function receive(event) {
  batch(() => takeEvent(event));
}

/** @type {{[Type in Event["type"]]?: (event: Extract<Event, {type: Type}>) => void}} */
const TAKERS = {
  hello: (event) => {
    role.value = event.role;
    version.value = event.version;
    session.value = event.session;
    // Whatever was going on when the lane was lost is told anew, if it still is.
    progress.value = new Map();
  },
  documents: (event) => {
    documents.value = event.documents;
  },
  document: (event) => {
    documentState.value = event;
    gone.value = false;
  },
  robot: (event) => {
    robot.value = event;
  },
  joints: (/** @type {JointPositions} */ event) => {
    takePositions(event.positions);
    animating.value = event.animating;
  },
  sites: takeSites,
  problems: (event) => {
    problems.value = event.problems;
    showingLastGood.value = event.showing_last_good;
  },
  history: (event) => {
    history.value = event;
  },
  displays: (event) => {
    displays.value = event.displays;
  },
  progress: takeProgress,
  built: (event) => {
    built.value = event;
  },
  texts_changed: takeTextNews,
  variants: takeVariants,
  poses: takePoses,
  calls: takeCalls,
  goals: takeGoals,
  publications: takePublications,
  parameters_changed: takeParameterNews,
  wire_state: takeRos,
  wire_feed: takeFeed,
  live_displays: takeLiveDisplays,
  display_states: takeDisplayStates,
  comparison: takeComparison,
  disk_merged: (event) => {
    diskMerged.value = event;
  },
  restored: takeRestored,
  left_work: takeLeftWork,
  gone: (event) => {
    if (event.document === documentId.value) gone.value = true;
  },
};

/** @param {Event} event */
function takeEvent(event) {
  const taker = /** @type {((event: Event) => void) | undefined} */ (TAKERS[event.type]);
  taker?.(event);
}
