/** The names of the lines of a plot, with their values: now, or where the pointer is. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Series } from "../model/plotting.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shownNumber } from "../lib/numbers.js";
import { overdue_s, shortTime } from "../lib/times.js";
import { IconButton } from "../lib/ui.js";
import { laneOpen } from "../model/data-lane.js";
import {
  heardTopics,
  keyOf,
  nowOfSamples,
  removeSeries,
  samplesOf,
  series,
  unreadTopics,
} from "../model/plotting.js";
import { colorOf } from "./plot-chart.js";

const REFRESH_MS = 200;
/** So many of the last tell how often they come. */
const LOOKED_BACK = 10;

/** @param {{hidden: Signal<ReadonlySet<string>>, pointed_s: Signal<number | null>}} props */
export function PlotLegend({ hidden, pointed_s }) {
  const round = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => {
      round.value += 1;
    }, REFRESH_MS);
    return () => clearInterval(timer);
  }, []);
  // Read, so that values are told anew as time goes by.
  const at = round.value;
  return html`<ul class="plot-legend" aria-label=${t("plot.lines")}>${series.value.map(
    (one, n) =>
      html`<${Line} key=${keyOf(one)} one=${one} color=${colorOf(n)} hidden=${hidden} at_s=${pointed_s.value} round=${at} />`,
  )}</ul>`;
}

/** @param {{one: Series, color: string, hidden: Signal<ReadonlySet<string>>, at_s: number | null}} props */
function Line({ one, color, hidden, at_s }) {
  const key = keyOf(one);
  const isHidden = hidden.value.has(key);
  const toggle = () => {
    const now = new Set(hidden.value);
    if (!now.delete(key)) now.add(key);
    hidden.value = now;
  };
  const trouble = troubleOf(one);
  return html`<li class=${isHidden ? "off" : ""} title=${[key, trouble].filter(Boolean).join("\n")}>
    <button type="button" class="plot-name" aria-pressed=${!isHidden} onClick=${toggle}><span class="plot-mark" style=${`background:${color}`}></span><span>${nameOf(one)}</span></button>
    <output>${valueText(one, at_s)}</output>
    ${trouble && html`<span class="plot-trouble">${trouble}</span>`}
    <${IconButton} icon="close" label=${t("plot.remove", { name: key })} size=${12} class="narrow" onClick=${() => removeSeries(one)} />
  </li>`;
}

/** @param {Series} one @returns {string} as short as it tells them apart */
function nameOf({ topic, path }) {
  const fields = series.value.filter((other) => other.path === path);
  return fields.length > 1 ? topic + path : path.replace(/^\./, "") || topic;
}

/** @param {Series} one @param {number | null} at_s */
function valueText(one, at_s) {
  const samples = samplesOf(one);
  const value = at_s === null ? samples.newest() : samples.valueAt(at_s);
  return value === null ? "–" : shownNumber(value);
}

/** @param {Series} one @returns {string} why there is no line, or it goes on no more; empty: all is well */
function troubleOf(one) {
  const heard = heardTopics.value.get(one.topic);
  const unread = unreadTopics.value.get(one.topic);
  if (!laneOpen.value) return t("plot.state.lane");
  if (heard?.state === "refused") return heard.reason;
  if (heard && heard.state !== "hearing") return t(`plot.state.${heard.state}`);
  if (unread) return t("plot.unread", { reason: unread });
  return heard ? troubleOfSamples(samplesOf(one), heard.latched) : "";
}

/** @param {ReturnType<typeof samplesOf>} samples @param {boolean} latched what is latched is said once and holds */
function troubleOfSamples(samples, latched) {
  if (samples.count === 0) return t(samples.others > 0 ? "plot.no_number" : "plot.state.waiting");
  const silent_s = overdue_s(samples.last(LOOKED_BACK), nowOfSamples());
  return silent_s > 0 && !latched ? t("plot.state.silent", { time: shortTime(silent_s) }) : "";
}
