/** The picture of a plot: drawn anew while it runs, held still while somebody looks closer. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Span } from "./plot.js" */

import { html, useEffect, useRef } from "vendor/preact.js";
import { createChart } from "../lib/chart.js";
import { t } from "../lib/i18n.js";
import {
  columnsOf,
  columnTimes,
  keyOf,
  nowOfSamples,
  samplesOf,
  series,
  span_s,
} from "../model/plotting.js";
import { theme } from "../model/view.js";

const FRAME_MS = 30;
const COLORS = 8;

/** @param {number} at @returns {string} the CSS colour of a line */
export const colorOf = (at) => `var(--plot-${(at % COLORS) + 1})`;

/** @param {{hidden: ReadonlySet<string>, held: Signal<Span | null>, pointed_s: Signal<number | null>}} props */
export function PlotChart({ hidden, held, pointed_s }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const drawn = useRef({ from_s: 0, to_s: 0, now_s: 0 });
  const all = series.value;
  useEffect(() => {
    const parent = element.current;
    if (!parent) return undefined;
    const style = getComputedStyle(parent);
    const lines = all.map((one, at) => ({
      label: keyOf(one),
      color: style.getPropertyValue(`--plot-${(at % COLORS) + 1}`),
      shown: !hidden.has(keyOf(one)),
    }));
    const look = {
      grid: style.getPropertyValue("--line"),
      text: style.getPropertyValue("--muted"),
      font: `11px ${style.fontFamily}`,
    };
    const time = (/** @type {number} */ axis_s) => drawn.current.now_s + axis_s;
    const chart = createChart(parent, lines, look, {
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

/** @param {() => void} draw as often as it can be seen @returns {() => void} the end of it */
function whileSeen(draw) {
  let next_ms = 0;
  let frame = requestAnimationFrame(function step(now_ms) {
    frame = requestAnimationFrame(step);
    if (now_ms < next_ms) return;
    next_ms = now_ms + FRAME_MS;
    draw();
  });
  return () => cancelAnimationFrame(frame);
}
