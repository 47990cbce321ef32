/** Lines over time: uPlot, wrapped. */

import Plot from "../vendor/uplot.js";

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
 * @param {HTMLElement} parent
 * @param {readonly Line[]} lines
 * @param {Look} look
 * @param {Events} events
 */
export function createChart(parent, lines, look, events) {
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
