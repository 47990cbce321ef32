/** The picture of a plot: drawn anew while it runs, held still while somebody looks closer. */

/** @import { Signal } from "vendor/preact.js" */

/** @typedef {{from_s: number, to_s: number, now_s: number}} Span of time that is seen, and the moment from which its axis counts */

import { html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import {
  columnsOf,
  columnTimes,
  keyOf,
  nowOfSamples,
  samplesOf,
  series,
  span_s,
} from "../../model/plotting.js";
import { theme } from "../../model/view.js";
import Plot from "../../vendor/uplot.js";

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

/** @typedef {{label: string, color: string, shown: boolean}} Line */
/** @typedef {{grid: string, text: string, font: string}} Look */
/**
 * @typedef {object} Events
 * @property {(time_s: number | null) => void} onPoint where the pointer is, in the seconds of the axis; null: elsewhere
 * @property {(from_s: number, to_s: number) => void} onZoom a span was dragged over
 * @property {() => void} onReset a double click
 */

/** A drag of fewer pixels was a click. */
const DRAG_LEAST_PX = 6;

/**
 * Lines over time: uPlot, wrapped.
 *
 * @param {HTMLElement} parent
 * @param {readonly Line[]} lines
 * @param {Look} look
 * @param {Events} events
 */
function createChart(parent, lines, look, events) {
  const axis = {
    stroke: look.text,
    font: look.font,
    grid: { stroke: look.grid, width: 1 },
    ticks: { show: false },
  };
  const chart = new Plot(
    {
      width: Math.max(parent.clientWidth, 50),
      height: Math.max(parent.clientHeight, 50),
      legend: { show: false },
      scales: { x: { time: false, auto: false }, y: { range: padded } },
      axes: [
        { ...axis, size: 28, values: (_, all) => all.map((one) => `${round(one)} s`) },
        { ...axis, size: 58 },
      ],
      cursor: { points: { size: 5 }, drag: { x: true, y: false, setScale: false } },
      series: [{}, ...lines.map(({ label, color, shown }) => lineOf(label, color, shown))],
      hooks: {
        setCursor: [
          (one) => {
            const left = one.cursor.left ?? -1;
            events.onPoint(left < 0 ? null : one.posToVal(left, "x"));
          },
        ],
        setSelect: [(one) => zoom(one, events)],
      },
    },
    [[], ...lines.map(() => [])],
    parent,
  );
  const reset = () => events.onReset();
  chart.over.addEventListener("dblclick", reset);
  return {
    /** @param {readonly number[]} times @param {readonly (readonly (number | null | undefined)[])[]} values @param {number} from_s @param {number} to_s */
    draw(times, values, from_s, to_s) {
      chart.batch(() => {
        chart.setData(/** @type {any} */ ([times, ...values]), false);
        chart.setScale("x", { min: from_s, max: to_s });
      });
    },
    resize() {
      const width = Math.max(parent.clientWidth, 50);
      const height = Math.max(parent.clientHeight, 50);
      if (width !== chart.width || height !== chart.height) chart.setSize({ width, height });
    },
    width: () => Math.max(1, Math.round(chart.over.clientWidth)),
    destroy: () => chart.destroy(),
  };
}

/** @param {string} label @param {string} stroke @param {boolean} show */
const lineOf = (label, stroke, show) => ({
  label,
  stroke,
  show,
  width: 1.5,
  points: { show: false },
});

/** @param {number} value @returns {number} */
const round = (value) => Number(value.toPrecision(6));

/** @param {unknown} _plot @param {number | null} least @param {number | null} largest @returns {[number, number]} */
function padded(_plot, least, largest) {
  const low = least ?? 0;
  const high = largest ?? 1;
  const room = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

/** @param {Plot} chart @param {Events} events */
function zoom(chart, events) {
  const { left, width } = chart.select;
  if (width < DRAG_LEAST_PX) return;
  events.onZoom(chart.posToVal(left, "x"), chart.posToVal(left + width, "x"));
  chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
}
