/**
 * The page's own part of a config file: how its panels stand, the layouts that this person saved,
 * and what is plotted. Nothing of a file is believed, and no layout of this browser is lost for it.
 */

/** @import { Arrangement } from "../lib/arrangement.js" */
/** @import { OwnLayout } from "./layouts.js" */

import { readArrangement } from "../lib/arrangement.js";
import { isSeries, SERIES_MAX, series, span_s } from "../model/plotting.js";
import { pagePart } from "../model/rviz-configs.js";
import { layoutControl } from "../model/view.js";
import { addLayouts, ownLayouts, readLayouts } from "./layouts.js";
import { PANELS } from "./panels.js";

const SPAN_LEAST_S = 1;
const SPAN_MOST_S = 3600;

/** Has files that are saved hold it, and those that are opened bring it. */
export function followPagePart() {
  pagePart.told = () => JSON.stringify(toldPart(layoutControl.value?.present() ?? null));
  pagePart.take = (text) => takePart(text);
}

/** @param {Arrangement | null} arrangement of the panels now */
export function toldPart(arrangement) {
  return {
    ...(arrangement && { Panels: arrangement }),
    Layouts: ownLayouts.value,
    Plots: series.value,
    "Plot span": span_s.value,
  };
}

/** @param {string} id of a panel */
const isKnown = (id) => Object.hasOwn(PANELS, id);

/** @typedef {{arrangement: Arrangement | null, layouts: OwnLayout[], open: string[], plots: import("../model/plotting.js").Series[] | null, span_s: number | null}} ReadPart */

/** @param {string} text @param {(id: string) => boolean} [known] whether there is such a panel @returns {ReadPart} null: it says nothing that is believed */
export function readPart(text, known = isKnown) {
  const told = parsed(text);
  const arrangement = readArrangement(told.Panels, known)?.arrangement ?? null;
  const { Open: open, Plots: plots } = told;
  const span = told["Plot span"];
  return {
    arrangement,
    layouts: Array.isArray(told.Layouts) ? readLayouts(told.Layouts, known).layouts : [],
    open: Array.isArray(open) ? open.filter((id) => typeof id === "string" && known(id)) : [],
    plots: Array.isArray(plots) ? plots.filter(isSeries).slice(0, SERIES_MAX).map(plain) : null,
    span_s: typeof span === "number" && span >= SPAN_LEAST_S && span <= SPAN_MOST_S ? span : null,
  };
}

/** @param {{topic: string, path: string}} series */
const plain = ({ topic, path }) => ({ topic, path });

/** @param {string} text @returns {Record<string, unknown>} */
function parsed(text) {
  try {
    const told = JSON.parse(text);
    return typeof told === "object" && told !== null ? told : {};
  } catch {
    return {};
  }
}

/** @param {readonly OwnLayout[]} layouts @param {readonly OwnLayout[]} own @returns {OwnLayout[]} a layout that had to get another name is no new one the next time */
export function newOnes(layouts, own) {
  const asRead = (/** @type {OwnLayout} */ { arrangement }) =>
    JSON.stringify(readArrangement(arrangement, () => true)?.arrangement);
  const known = new Set(own.map(asRead));
  return layouts.filter((one) => !known.has(asRead(one)));
}

/** @param {string} text */
function takePart(text) {
  addLayouts(newOnes(readPart(text).layouts, ownLayouts.value));
  takePanels(text);
}

/** @returns {string} how the panels stand and what is plotted, without the layouts that are this person's own */
export function toldPanels() {
  return JSON.stringify({
    ...toldPart(layoutControl.peek()?.present() ?? null),
    Layouts: undefined,
  });
}

/** @param {string} text how the panels are to stand, and what is plotted; nothing of it is believed */
export function takePanels(text) {
  const { arrangement, open, plots, span_s: span } = readPart(text);
  if (plots) series.value = plots;
  if (span) span_s.value = span;
  if (arrangement) layoutControl.value?.arrange(arrangement);
  else if (open.length > 0) layoutControl.value?.open(open);
}
