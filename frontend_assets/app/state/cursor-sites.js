/** The properties that the line with the source panel's cursor sets. */

import { computed } from "vendor/preact.js";
import { allSites, sitesRevision } from "./document.js";
import { cursorPlace } from "./source.js";

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
