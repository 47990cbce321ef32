/**
 * What this person selected in 3D with the tool Select: items of displays and links of the robot. The
 * studio says what they are; they are asked about again and again, since they move and go.
 */

/** @import { ItemDetails, ItemRef, ItemsDescribed, ItemView, PickedNode } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, effect, signal } from "vendor/preact.js";
import { askOrKeepWhy, polled } from "./asking.js";
import { documentId } from "./connection.js";
import { selectLink } from "./selection.js";

/** @typedef {"replace" | "add" | "remove"} How */
/** @typedef {{nodes: readonly PickedNode[], links: readonly string[], how: How, left_out: number}} Picked */
/**
 * @typedef {object} Selected
 * @property {ItemRef} ref
 * @property {ItemView | null} view as the studio said last; null: it was not said yet
 * @property {boolean} gone the studio knows it no more
 */

const EVERY_MS = 500;
/** Many are asked about less often: their answer is long. */
const MANY = 200;
const EVERY_OF_MANY_MS = 2000;
/** The studio describes no more of them in full at once. */
const DETAILS_MAX = 40;
const ITEMS_MAX = 4000;

/** @param {ItemRef} ref @returns {string} no id of a display has a space in it */
export const idOf = ({ display, key }) => `${display} ${key}`;

/** By their ids, in the order in which they were selected. @type {Signal<ReadonlyMap<string, Selected>>} */
export const selectedItems = signal(new Map());
/** All that is known of some of them, by their ids. @type {Signal<ReadonlyMap<string, ItemDetails>>} */
export const itemDetails = signal(new Map());
/** Parts that the last rectangle touched, and that were too many. */
export const leftOut = signal(0);
/** Those whose details are looked at. @type {Signal<ReadonlySet<string>>} */
export const openItems = signal(new Set());
/** Whether a click adds to the selection, as it does with Shift: a finger has no keys. */
export const adding = signal(false);
/** The frame that places are said in. */
export const placesIn = signal("");
export const itemsRefused = signal("");

/** What 3D draws boxes around. */
export const outlined = computed(() =>
  [...selectedItems.value.values()].flatMap(({ ref, view, gone }) => {
    if (gone || !view) return [];
    const path = ref.display === "" ? ref.key : view.path;
    return [{ display: ref.display, path, shape: view.shape, box: view.box }];
  }),
);

/**
 * @param {ReadonlyMap<string, Selected>} before
 * @param {readonly ItemRef[]} refs
 * @param {How} how
 * @returns {Map<string, Selected>}
 */
export function changedBy(before, refs, how) {
  const now = new Map(how === "replace" ? [] : before);
  for (const ref of refs) {
    const id = idOf(ref);
    if (how === "remove") now.delete(id);
    else if (now.size < ITEMS_MAX) now.set(id, before.get(id) ?? { ref, view: null, gone: false });
  }
  return now;
}

/** Counts what was pointed at: of two answers that of the later one counts. */
let turn = 0;

/** @param {Picked} picked */
export async function takePicked({ nodes, links, how: asked, left_out: lost }) {
  const how = asked === "replace" && adding.value ? "add" : asked;
  turn += 1;
  const mine = turn;
  const items = await itemsAt(nodes);
  if (mine !== turn || !items) return;
  const refs = [...links.map((key) => ({ display: "", key })), ...items.refs];
  batch(() => {
    const now = changedBy(selectedItems.value, refs, how);
    const kept = how === "remove" ? refs : refs.filter((ref) => now.has(idOf(ref)));
    selectedItems.value = now;
    leftOut.value = lost + items.left_out + refs.length - kept.length;
    openItems.value = opened(openItems.value, selectedItems.value);
    if (how === "replace") selectLink(links[0] ?? null, "scene");
  });
}

/** @param {readonly PickedNode[]} nodes @returns {Promise<{refs: readonly ItemRef[], left_out: number} | null>} */
async function itemsAt(nodes) {
  if (nodes.length === 0) return { refs: [], left_out: 0 };
  const answer = await askOrKeepWhy({ type: "pick_items", nodes: [...nodes] }, itemsRefused);
  return answer?.type === "items_picked" ? { refs: answer.items, left_out: answer.left_out } : null;
}

/** What is open stays so; one that is alone is opened. @param {ReadonlySet<string>} before @param {ReadonlyMap<string, Selected>} items */
function opened(before, items) {
  const [only] = items.keys();
  return items.size === 1 && only
    ? new Set([only])
    : new Set([...before].filter((id) => items.has(id)));
}

/** Empty the selection. */
export function selectNothing() {
  turn += 1;
  if (selectedItems.peek().size === 0) return;
  batch(() => {
    selectedItems.value = new Map();
    itemDetails.value = new Map();
    openItems.value = new Set();
    leftOut.value = 0;
  });
}

/** @param {readonly ItemRef[]} refs take these out of the selection */
export function deselect(refs) {
  selectedItems.value = changedBy(selectedItems.value, refs, "remove");
}

/** @param {string} id @param {boolean} open */
export function openItem(id, open) {
  const now = new Set(openItems.value);
  if (open) now.add(id);
  else now.delete(id);
  openItems.value = now;
}

/** @returns {{display: string, keys: string[]}[]} what is asked about, display by display */
function keysNow() {
  /** @type {Map<string, string[]>} */
  const keys = new Map();
  for (const { ref } of selectedItems.value.values()) {
    const all = keys.get(ref.display);
    if (all) all.push(ref.key);
    else keys.set(ref.display, [ref.key]);
  }
  return [...keys].map(([display, all]) => ({ display, keys: all }));
}

async function describe() {
  const detailed = [...openItems.value]
    .flatMap((id) => selectedItems.value.get(id)?.ref ?? [])
    .slice(0, DETAILS_MAX);
  const answer = await askOrKeepWhy(
    { type: "describe_items", items: keysNow(), detailed },
    itemsRefused,
  );
  if (answer?.type === "items_described") take(answer);
}

/** @param {ItemsDescribed} answer */
function take({ items, details, fixed }) {
  const views = new Map(items.map((view) => [idOf(view), view]));
  batch(() => {
    placesIn.value = fixed;
    selectedItems.value = described(selectedItems.value, views);
    itemDetails.value = new Map([
      // What is gone keeps what was known of it last.
      ...[...itemDetails.value].filter(([id]) => openItems.value.has(id)),
      ...details.map((one) => /** @type {[string, ItemDetails]} */ ([idOf(one), one])),
    ]);
  });
}

/**
 * @param {ReadonlyMap<string, Selected>} before
 * @param {ReadonlyMap<string, ItemView>} views of those that are there
 * @returns {Map<string, Selected>}
 */
export function described(before, views) {
  return new Map(
    [...before].map(([id, { ref, view }]) => {
      const now = views.get(id);
      return [id, { ref, view: now ?? view, gone: now === undefined }];
    }),
  );
}

/** What is asked about: when it changes it is asked at once. */
const watched = computed(() => [...selectedItems.value.keys(), "", ...openItems.value].join("\n"));
const count = computed(() => selectedItems.value.size);
const followFew = polled(
  describe,
  EVERY_MS,
  () => watched.value !== "" && count.value > 0 && count.value <= MANY,
);
const followMany = polled(
  describe,
  EVERY_OF_MANY_MS,
  () => watched.value !== "" && count.value > MANY,
);

/** Keep asking while there is a selection. @returns {() => void} the end of it */
export function followSelection() {
  const ends = [followFew(), followMany(), forgetWithDocument()];
  return () => {
    for (const end of ends) end();
  };
}

function forgetWithDocument() {
  return effect(() => {
    documentId.value;
    selectNothing();
  });
}
