/** Worlds that are told by the names of topics and services, one for each namespace; one is looked at. */

/** @import { OfferView, TopicRow } from "../types/wire.d.ts" */

import { computed, signal } from "vendor/preact.js";
import { followServices, services } from "./state/offers.js";
import { topics } from "./state/topics.js";
import { followTopics } from "./topics.js";

/**
 * @template {{prefix: string}} T
 * @param {(topics: readonly TopicRow[], services: readonly OfferView[]) => readonly T[]} find
 */
export function inNamespaces(find) {
  /** The namespace that a person chose. */
  const chosen = signal("");
  /** Null: not told yet. */
  const all = computed(() =>
    topics.value && services.value ? find(topics.value, services.value) : null,
  );
  /** The one that is looked at; null: there is none. */
  const shown = computed(
    () => all.value?.find(({ prefix }) => prefix === chosen.value) ?? all.value?.[0] ?? null,
  );
  return { chosen, all, shown };
}

/** Know which there are, while somebody looks; gives the end of it. */
export function followNamespaces() {
  const ends = [followTopics(), followServices()];
  return () => {
    for (const end of ends) end();
  };
}

/**
 * What was seen of each world so far, the one looked at last being the last.
 *
 * @template T
 * @param {() => T} begin
 * @param {number} most that are kept
 * @returns {(prefix: string) => T}
 */
export function keptFor(begin, most) {
  /** @type {Map<string, T>} */
  const kept = new Map();
  return (prefix) => {
    const found = kept.get(prefix) ?? begin();
    kept.delete(prefix);
    kept.set(prefix, found);
    for (const oldest of [...kept.keys()].slice(0, -most)) kept.delete(oldest);
    return found;
  };
}
