/** The picture of a recording: all of it or the part that is looked at, with the moment that is shown. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { Series } from "../../model/plotting.js" */

import { effect, html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { shownNumber } from "../../lib/numbers.js";
import { pannedTime, placesOf, sinceStart, zoomedTime } from "../../lib/timeline.js";
import { keyOf, series } from "../../model/plotting.js";
import {
  coarseShare,
  drawnOf,
  followRecorded,
  recordedColumns,
  recordedPicture,
  valuesAt,
  wholeLength,
} from "../../model/recorded-series.js";
import {
  dragTime,
  followNow,
  mayMoveTime,
  now_s,
  seekTime,
  seenRange,
  timeState,
  timeZoom,
  wholeTime,
} from "../../model/time.js";
import { theme } from "../../model/view.js";
import { createChart, linesOf, whileSeen } from "./lines.js";

const WHEEL_FACTOR = 1.2;
const PAN_SHARE = 0.1;

/** @param {{hidden: ReadonlySet<string>, pointed_s: Signal<number | null>}} props */
export function RecordedChart({ hidden, pointed_s }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const all = series.value;
  const moves = mayMoveTime.value;
  useEffect(followNow, []);
  useEffect(() => followRecorded(all), [all]);
  useEffect(() => {
    const parent = element.current;
    if (!parent) return undefined;
    const chart = createChart(parent, linesOf(all, hidden, parent), {
      words: (times) => ruler(times),
      onPoint: (time_s) => {
        pointed_s.value = time_s;
      },
      onZoom: moves
        ? null
        : (from_s, to_s) => {
            timeZoom.value = { from_s, to_s };
          },
      onReset: () => {
        timeZoom.value = null;
      },
    });
    const end = steered(chart.over, moves);
    const line = document.createElement("div");
    line.className = "plot-now";
    chart.over.append(line);
    const tell = () => {
      const { from_s, to_s } = seenRange.value;
      const picture = recordedPicture.value;
      const drawn = picture ? drawnOf(picture, all, wholeLength()) : { times: [], values: [] };
      chart.draw(drawn.times, picture ? drawn.values : all.map(() => []), from_s, to_s);
    };
    const forget = effect(tell);
    const stop = whileSeen(() => {
      const place = chart.placeOf(now_s.peek());
      line.hidden = !(place >= 0 && place <= chart.over.clientWidth);
      line.style.transform = `translateX(${place.toFixed(1)}px)`;
    });
    const fit = () => {
      chart.resize();
      recordedColumns.value = chart.width();
    };
    const watcher = new ResizeObserver(fit);
    watcher.observe(parent);
    fit();
    return () => {
      recordedColumns.value = 0;
      stop();
      forget();
      end();
      watcher.disconnect();
      chart.destroy();
    };
  }, [all, hidden, moves, theme.value]);
  const share = coarseShare(recordedPicture.value);
  return html`<div class=${`plot-chart ${share === null ? "" : "coarse"}`} ref=${element} role="img" aria-label=${t("plot.picture", { count: all.length })}></div>`;
}

/** @param {readonly number[]} times @returns {string[]} since the start */
function ruler(times) {
  const places = placesOf(Math.max((times[1] ?? 1) - (times[0] ?? 0), 1e-3));
  const start_s = timeState.peek()?.begin_s ?? 0;
  return times.map((one) => sinceStart(one - start_s, places));
}

/** A wheel looks closer, a drag moves the time. @param {HTMLElement} over @param {boolean} moves @returns {() => void} the end of it */
function steered(over, moves) {
  const timeOf = (/** @type {MouseEvent} */ { clientX }) => {
    const { left, width } = over.getBoundingClientRect();
    const { from_s, to_s } = seenRange.peek();
    return from_s + ((clientX - left) / Math.max(width, 1)) * (to_s - from_s);
  };
  const wheel = (/** @type {WheelEvent} */ event) => {
    event.preventDefault();
    const range = seenRange.peek();
    const along = event.shiftKey ? event.deltaY || event.deltaX : event.deltaX;
    timeZoom.value =
      event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)
        ? pannedTime(
            range,
            Math.sign(along) * PAN_SHARE * (range.to_s - range.from_s),
            wholeTime.peek(),
          )
        : zoomedTime(
            range,
            WHEEL_FACTOR ** -Math.sign(event.deltaY),
            timeOf(event),
            wholeTime.peek(),
          );
  };
  const press = (/** @type {PointerEvent} */ event) => {
    if (event.button !== 0 || event.detail > 1) return;
    over.setPointerCapture(event.pointerId);
    dragTime(timeOf(event));
  };
  const move = (/** @type {PointerEvent} */ event) => {
    if (over.hasPointerCapture(event.pointerId)) dragTime(timeOf(event));
  };
  const release = (/** @type {PointerEvent} */ event) => {
    if (!over.hasPointerCapture(event.pointerId)) return;
    over.releasePointerCapture(event.pointerId);
    void seekTime(timeOf(event));
  };
  over.addEventListener("wheel", wheel, { passive: false });
  if (moves) {
    over.addEventListener("pointerdown", press);
    over.addEventListener("pointermove", move);
    over.addEventListener("pointerup", release);
    over.addEventListener("pointercancel", release);
  }
  return () => over.removeEventListener("wheel", wheel);
}

/** That not all was read yet, and how much was. */
export function CoarseNote() {
  const share = coarseShare(recordedPicture.value);
  if (share === null) return null;
  return html`<span class="plot-coarse" role="status">${t("plot.coarse", { percent: Math.floor(share * 100) })}</span>`;
}

/** @param {Series} one @param {number | null} pointed_s @returns {string} its values there, or at the moment that is shown */
export function recordedText(one, pointed_s) {
  const found = valuesAt(recordedPicture.value, keyOf(one), pointed_s ?? now_s.value);
  if (!found) return "–";
  const [least, largest] = found;
  return least === largest ? shownNumber(least) : `${shownNumber(least)} … ${shownNumber(largest)}`;
}

/** @param {Series} one @returns {string} why there is no line, in a sentence; empty: all is well */
export const recordedTrouble = (one) =>
  recordedPicture.value?.answers.get(keyOf(one))?.trouble ?? "";
