/**
 * Which texts the source panel has open and where in them one is; other panels ask here for a
 * line. While somebody types in the midst of a tag, no alarm says that the robot cannot be built.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { TextsChanged } from "../types/wire.d.ts" */

import { computed, effect, signal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { allSites, showingLastGood, sitesRevision } from "./document.js";
import { subscribe } from "./wire.js";

/**
 * A place in a text; line and column from 1. Each request is an object of its own, so that the same place
 * can be wanted twice.
 * @typedef {{file: string, line: number, column: number}} WantedPlace
 */

/** Where the source panel goes next; it takes the request away when it is there. @type {Signal<WantedPlace | null>} */
export const wantedPlace = signal(null);

/** Files that have a tab, in its order. @type {Signal<readonly string[]>} */
export const openFiles = signal([]);

/** The file in front in the source panel; empty: none. @type {Signal<string>} */
export const shownFile = signal("");

/** Where its cursor stands. @type {Signal<WantedPlace | null>} */
export const cursorPlace = signal(null);

/** Lines that light up in the source, for instance those of the property under the pointer. @type {Signal<readonly {file: string, line: number}[]>} */
export const litPlaces = signal([]);

/** The search in all files, and the words that it begins with; null: it is closed. @type {Signal<{text: string, turn: number} | null>} */
export const filesSearch = signal(null);

/** A text that another panel wants written at the cursor of the source. @type {Signal<{text: string, stops: readonly (readonly number[])[]} | null>} */
export const wantedSnippet = signal(null);

/** @param {string} text written at the cursor of the source @param {readonly (readonly number[])[]} stops that the cursor then visits */
export function writeSnippet(text, stops) {
  wantedSnippet.value = { text, stops };
  commandById("panel.source")?.run();
}

/**
 * Bring the source panel to the front with this line in view and the cursor on it.
 *
 * @param {string} file as the studio names it
 * @param {number} line from 1
 * @param {number} [column] from 1
 */
export function showSource(file, line, column = 1) {
  wantedPlace.value = { file, line: Math.max(line, 1), column: Math.max(column, 1) };
  commandById("panel.source")?.run();
}

/** @param {string} file comes to the front, the cursor where it was left */
export function showFile(file) {
  openFile(file);
  commandById("panel.source")?.run();
}

/** @param {string} file gets a tab, and is in front */
export function openFile(file) {
  if (!openFiles.value.includes(file)) openFiles.value = [...openFiles.value, file];
  shownFile.value = file;
}

/** @param {string} file whose tab goes; its neighbour comes to the front */
export function closeFile(file) {
  const at = openFiles.value.indexOf(file);
  const left = openFiles.value.filter((one) => one !== file);
  openFiles.value = left;
  if (shownFile.value === file) shownFile.value = left[Math.min(at, left.length - 1)] ?? "";
}

/** @type {Map<string, Set<(event: TextsChanged) => void>>} */
const followers = new Map();

/** @param {string} file @param {(event: TextsChanged) => void} take @returns {() => void} ends it */
export function followText(file, take) {
  const those = followers.get(file) ?? new Set();
  followers.set(file, those.add(take));
  return () => those.delete(take);
}

subscribe("texts_changed", (event) => {
  for (const take of followers.get(event.file) ?? []) take(event);
});

/** A text that rests so long is meant to be complete. */
const REST_MS = 1500;

const typing = signal(false);
/** @type {ReturnType<typeof setTimeout> | undefined} */
let resting;

/** Something was typed into a source text here. */
export function noteTyping() {
  typing.value = true;
  clearTimeout(resting);
  resting = setTimeout(() => {
    typing.value = false;
  }, REST_MS);
}

/** It was said once, and stays said until the robot is whole again. */
const said = signal(false);
effect(() => {
  if (!showingLastGood.value) said.value = false;
  else if (!typing.value) said.value = true;
});

/** Only the editor shows what is wrong so far. */
export const heldBack = computed(() => showingLastGood.value && !said.value);

const line = computed(() => {
  const place = cursorPlace.value;
  return place ? `${place.line} ${place.file}` : "";
});

/** Ids of sites; empty while nobody was in the source. */
export const cursorSites = computed(() => {
  sitesRevision.value;
  const wanted = line.value;
  if (wanted === "") return new Set();
  const there = [...allSites().values()].filter((one) => `${one.line} ${one.file}` === wanted);
  return new Set(there.map(({ id }) => id));
});
