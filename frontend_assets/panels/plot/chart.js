/** The picture of what comes now: drawn anew while it runs, held still while somebody looks closer. */

/** @import { Signal } from "vendor/preact.js" */

/** @typedef {{from_s: number, to_s: number, now_s: number}} Span of time that is seen, and the moment from which its axis counts */

import { html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import {
  columnsOf,
  columnTimes,
  nowOfSamples,
  samplesOf,
  series,
  span_s,
} from "../../model/plotting.js";
import { theme } from "../../model/view.js";
import { createChart, linesOf, whileSeen } from "./lines.js";

/** @param {{hidden: ReadonlySet<string>, held: Signal<Span | null>, pointed_s: Signal<number | null>}} props */
export function PlotChart({ hidden, held, pointed_s }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const drawn = useRef({ from_s: 0, to_s: 0, now_s: 0 });
  const all = series.value;
  useEffect(() => {
    const parent = element.current;
    if (!parent) return undefined;
    const time = (/** @type {number} */ axis_s) => drawn.current.now_s + axis_s;
    const chart = createChart(parent, linesOf(all, hidden, parent), {
      words: (times) => times.map((one) => `${round(one)} s`),
      onPoint: (axis_s) => {
        pointed_s.value = axis_s === null ? null : time(axis_s);
      },
      onZoom: (from_s, to_s) => {
        held.value = { from_s: time(from_s), to_s: time(to_s), now_s: drawn.current.now_s };
      },
      onReset: () => {
        held.value = null;
      },
    });
    const draw = () => {
      const span = held.peek() ?? running();
      drawn.current = span;
      const columns = chart.width();
      const from_s = span.from_s - span.now_s;
      const to_s = span.to_s - span.now_s;
      const values = all.map((one) => columnsOf(samplesOf(one), span.from_s, span.to_s, columns));
      chart.draw(columnTimes(columns, from_s, to_s), values, from_s, to_s);
    };
    const stop = whileSeen(draw);
    const watcher = new ResizeObserver(() => chart.resize());
    watcher.observe(parent);
    return () => {
      stop();
      watcher.disconnect();
      chart.destroy();
    };
  }, [all, hidden, theme.value]);
  return html`<div class="plot-chart" ref=${element} role="img" aria-label=${t("plot.picture", { count: all.length })}></div>`;
}

/** @returns {Span} */
function running() {
  const now_s = nowOfSamples();
  const to_s = Number.isNaN(now_s) ? 0 : now_s;
  return { from_s: to_s - span_s.peek(), to_s, now_s: to_s };
}

/** @param {number} value @returns {number} */
const round = (value) => Number(value.toPrecision(6));
