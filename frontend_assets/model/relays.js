/**
 * Relays, which pass the class on: whether the studio behind ours is there, the way to another once
 * ours is gone, and those that the presenter has added.
 */

/** @import { RelayView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal, untracked } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { connection, documentId, turnedAway } from "./connection.js";
import { ask, leaveTo } from "./requests.js";
import { fullView } from "./view.js";
import { giveUp, silentFor, subscribe } from "./wire.js";

/** Ours is tried several times meanwhile: it may only be started anew. */
const GONE_AFTER_MS = 2000;
const AGAIN_MS = 3000;
const OWN_PATIENCE_MS = 1500;
/** A relay whose machine sleeps or has no network closes no lane: after such a silence it is asked. */
const SILENT_MS = 15_000;
const SILENT_PATIENCE_MS = 5000;
/** The sentence that we go on elsewhere is to be read. */
const SAY_MS = 1500;

/** The presenter's; null: not told. @type {Signal<readonly RelayView[] | null>} */
export const relays = signal(null);
/** This page came by a relay. */
export const isAtRelay = signal(false);
/** What the page shows is the last that came. */
export const studioAway = signal(false);
/** Our relay is gone, and the page is about to go on at another. */
export const movesOn = signal(false);

/** Where this person goes on; each holds their pass, so they are nowhere else. @type {readonly string[]} */
let others = [];
/** It was begun while ours was there: what it may reach is as the relay said then. @type {Worker | null} */
let probe = null;

subscribe("relays", (event) => {
  relays.value = event.relays;
});

subscribe("relay_state", (event) => {
  isAtRelay.value = true;
  studioAway.value = event.studio === "away";
  const before = String(others.map(healthOf));
  others = event.others ?? [];
  if (String(others.map(healthOf)) === before) return;
  probe?.terminate();
  probe =
    others.length > 0
      ? new Worker(new URL("../workers/probe.js", import.meta.url), { type: "module" })
      : null;
});

/** @param {string} line that `studio relay` printed */
export const addRelay = (line) => ask({ type: "add_relay", line });
/** @param {string} endpoint */
export const removeRelay = (endpoint) => ask({ type: "remove_relay", endpoint });

/** @param {string} other address of another relay @returns {string} what answers if it is there, without the pass */
export function healthOf(other) {
  const found = new URL("health", other);
  return found.origin + found.pathname;
}

/**
 * @param {string} other address of another relay
 * @param {string} document to be shown there; empty: the first one
 * @param {boolean} full in full screen
 * @returns {string}
 */
export function wayTo(other, document, full) {
  const found = new URL(other);
  if (document) found.searchParams.set("next", `/d/${document}`);
  if (full) found.searchParams.set("fullscreen", "1");
  return found.href;
}

/** @template T @param {readonly T[]} all @returns {T[]} in any order, so that people spread */
function shuffled(all) {
  const keyed = all.map((one) => ({ one, key: Math.random() }));
  return keyed.sort((a, b) => a.key - b.key).map(({ one }) => one);
}

/** @returns {Promise<string | null>} another relay that is there */
function findOther() {
  const asked = probe;
  const byHealth = new Map(shuffled(others).map((one) => [healthOf(one), one]));
  if (!asked || byHealth.size === 0) return Promise.resolve(null);
  return new Promise((resolve) => {
    asked.onmessage = ({ data }) => resolve(byHealth.get(data) ?? null);
    asked.onerror = () => resolve(null);
    asked.postMessage([...byHealth.keys()]);
  });
}

/** @param {number} patience_ms @returns {Promise<boolean>} our own relay answers */
async function isOwnThere(patience_ms) {
  const patience = AbortSignal.timeout(patience_ms);
  const asked = fetch(address("/health"), { cache: "no-store", signal: patience });
  const answer = await asked.catch(() => null);
  return answer?.ok ?? false;
}

/** @param {() => boolean} isOver */
async function moveOn(isOver) {
  // If ours answers, only the lane is lost, and comes back.
  const [own, other] = await Promise.all([isOwnThere(OWN_PATIENCE_MS), findOther()]);
  if (isOver() || own || turnedAway.peek() || other === null) return;
  movesOn.value = true;
  await new Promise((read) => setTimeout(read, SAY_MS));
  if (isOver()) return;
  leaveTo(wayTo(other, documentId.peek(), fullView.peek()));
}

effect(() => {
  if (connection.value !== "lost") return undefined;
  let over = false;
  /** @type {ReturnType<typeof setTimeout>} */
  let timer;
  const later = (/** @type {number} */ delay) => {
    timer = setTimeout(async () => {
      if (others.length > 0) await moveOn(() => over);
      if (!over && !movesOn.peek()) later(AGAIN_MS);
    }, delay);
  };
  untracked(() => {
    studioAway.value = false; // what is said then is that nobody answers
    later(GONE_AFTER_MS);
  });
  return () => {
    over = true;
    movesOn.value = false;
    clearTimeout(timer);
  };
});

effect(() => {
  if (connection.value !== "connected") return undefined;
  const look = async () => {
    const isSilent = () => others.length > 0 && silentFor() > SILENT_MS;
    if (isSilent() && !(await isOwnThere(SILENT_PATIENCE_MS)) && isSilent()) giveUp();
  };
  const timer = setInterval(look, SILENT_MS);
  return () => clearInterval(timer);
});
