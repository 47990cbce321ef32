/** What is drawn over time; a person's own, kept over reloads. */

import { signal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { remembered } from "../../lib/remembered.js";
import { commandById } from "../commands.js";
import { notify } from "./view.js";

/** @typedef {{topic: string, path: string}} Series */

export const SERIES_MAX = 16;

/** @param {any} one @returns {boolean} */
const isSeries = (one) => typeof one?.topic === "string" && typeof one?.path === "string";

/** @type {import("vendor/preact.js").Signal<readonly Series[]>} */
export const series = remembered(
  "plot.series",
  /** @type {readonly Series[]} */ ([]),
  (value) => Array.isArray(value) && value.length <= SERIES_MAX && value.every(isSeries),
);
/** How its topics are listened to. @type {import("vendor/preact.js").Signal<import("../listening-menu.js").Listening>} */
export const plotListening = signal({ reliable: null, latched: null });
/** Seconds that are seen. */
export const span_s = remembered("plot.span", 30);

/** @param {Series} one @returns {string} */
export const keyOf = ({ topic, path }) => topic + path;

/** @param {string} topic @param {string} path of a number in its messages */
export function addSeries(topic, path) {
  const one = { topic, path };
  if (series.value.some((other) => keyOf(other) === keyOf(one))) return;
  if (series.value.length >= SERIES_MAX) {
    notify(t("plot.full", { count: SERIES_MAX }), { bad: true });
    return;
  }
  series.value = [...series.value, one];
}

/** @param {string} topic @param {string} path draw it, and show where */
export function plot(topic, path) {
  addSeries(topic, path);
  commandById("panel.plot")?.run();
}

/** @param {Series} one */
export function removeSeries(one) {
  series.value = series.value.filter((other) => keyOf(other) !== keyOf(one));
}
