/** Lines over time: uPlot, wrapped; and what draws it as long as it is seen. */

/** @import { Series } from "../../model/plotting.js" */

import { keyOf } from "../../model/plotting.js";
import Plot from "../../vendor/uplot.js";

const FRAME_MS = 30;
const COLORS = 8;

/** @param {number} at @returns {string} the CSS colour of a line */
export const colorOf = (at) => `var(--plot-${(at % COLORS) + 1})`;

/** @param {() => void} draw as often as it can be seen @returns {() => void} the end of it */
export function whileSeen(draw) {
  let next_ms = 0;
  let frame = requestAnimationFrame(function step(now_ms) {
    frame = requestAnimationFrame(step);
    if (now_ms < next_ms) return;
    next_ms = now_ms + FRAME_MS;
    draw();
  });
  return () => cancelAnimationFrame(frame);
}

/**
 * @param {readonly Series[]} all @param {ReadonlySet<string>} hidden @param {HTMLElement} parent whose colours they take
 * @returns {Line[]}
 */
export function linesOf(all, hidden, parent) {
  const style = getComputedStyle(parent);
  return all.map((one, at) => ({
    label: keyOf(one),
    color: style.getPropertyValue(`--plot-${(at % COLORS) + 1}`),
    shown: !hidden.has(keyOf(one)),
  }));
}

/** @typedef {{label: string, color: string, shown: boolean}} Line */
/**
 * @typedef {object} Events
 * @property {(times: readonly number[]) => string[]} words of the times of its axis
 * @property {(time_s: number | null) => void} onPoint where the pointer is, in the seconds of the axis; null: elsewhere
 * @property {((from_s: number, to_s: number) => void) | null} onZoom a span was dragged over; null: a drag means something else
 * @property {() => void} onReset a double click
 */

/** A drag of fewer pixels was a click. */
const DRAG_LEAST_PX = 6;

/**
 * Lines over time: uPlot, wrapped.
 *
 * @param {HTMLElement} parent
 * @param {readonly Line[]} lines
 * @param {Events} events
 */
export function createChart(parent, lines, events) {
  const style = getComputedStyle(parent);
  const axis = {
    stroke: style.getPropertyValue("--muted"),
    font: `11px ${style.fontFamily}`,
    grid: { stroke: style.getPropertyValue("--line"), width: 1 },
    ticks: { show: false },
  };
  const chart = new Plot(
    {
      width: Math.max(parent.clientWidth, 50),
      height: Math.max(parent.clientHeight, 50),
      legend: { show: false },
      scales: { x: { time: false, auto: false }, y: { range: padded } },
      axes: [
        { ...axis, size: 28, values: (_, all) => events.words(all) },
        { ...axis, size: 58 },
      ],
      cursor: {
        points: { size: 5 },
        drag: { x: events.onZoom !== null, y: false, setScale: false },
      },
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
    over: chart.over,
    /** @param {number} time_s @returns {number} px from the left of `over` */
    placeOf: (time_s) => chart.valToPos(time_s, "x"),
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
  events.onZoom?.(chart.posToVal(left, "x"), chart.posToVal(left + width, "x"));
  chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
}
