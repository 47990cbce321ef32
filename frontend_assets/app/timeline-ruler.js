/** The timeline's ruler: drawn, dragged, zoomed by wheel and fingers, and a slider for keys. */

/** @import { Colors } from "./timeline-drawing.js" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { language, t } from "../lib/i18n.js";
import {
  nearestTo,
  pannedTime,
  placeOf,
  sinceStart,
  timeAfterKey,
  timeAt,
  zoomedTime,
} from "../lib/timeline.js";
import { clockTime } from "../model/log.js";
import {
  askMarks,
  bookmarks,
  dragTime,
  followNow,
  followTicks,
  loopFromNow,
  loopTime,
  markTopic,
  mayMoveTime,
  now_s,
  seekTime,
  seenRange,
  timeMarks,
  timeState,
  timeTicks,
  timeZoom,
  wholeTime,
} from "../model/time.js";
import { theme } from "../model/view.js";
import { bookmarkNow } from "./timeline-commands.js";
import { paintTimeline, RULER_PX } from "./timeline-drawing.js";

/** @typedef {import("../lib/timeline.js").Range} Range */

const NEAR_PX = 6;
/** A press that moves less is a click. */
const STILL_PX = 3;
const WHEEL = 0.0016;
const KEY_ZOOM = 1.5;
/** Marks are asked anew when what is seen is so much another. */
const OTHER_SHARE = 0.004;
const BAR_PX = 2;

/** @param {{thin?: boolean}} props `thin`: without ruler, marks and loop */
export function TimelineRuler({ thin = false }) {
  const box = useRef(/** @type {HTMLElement | null} */ (null));
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const size = useSignal({ width: 0, height: 0 });
  const pointed_px = useSignal(/** @type {number | null} */ (null));
  const draft = useSignal(/** @type {Range | null} */ (null));
  useEffect(() => {
    const watcher = new ResizeObserver(([entry]) => {
      if (entry) size.value = { width: entry.contentRect.width, height: entry.contentRect.height };
    });
    if (box.current) watcher.observe(box.current);
    return () => watcher.disconnect();
  }, []);
  useEffect(() => followNow(), []);
  useEffect(() => (thin ? undefined : followTicks()), [thin]);
  useEffect(() => effect(() => void (thin || wishMarks(size.value.width))), [thin]);
  useEffect(() => effect(() => draw(canvas.current, { ...size.value, thin, draft })), [thin]);
  useEffect(() => effect(() => tellValue(box.current)), []);
  useEffect(() => listen(box.current, { thin, pointed_px, draft }), [thin]);
  return html`<div ref=${box} class=${`timeline-ruler ${thin ? "thin" : ""}`} role="slider" tabindex="0" aria-label=${t("timeline.slider")}
    aria-orientation="horizontal" aria-disabled=${mayMoveTime.value ? null : "true"} onKeyDown=${onKeyDown}>
    <canvas ref=${canvas} aria-hidden="true"></canvas>
    <${Head} width=${size.value.width} />
    <${Bubble} width=${size.value.width} pointed_px=${pointed_px} draft=${draft} />
  </div>`;
}

/** @param {{width: number}} props where the time stands */
function Head({ width }) {
  const x = placeOf(now_s.value, seenRange.value, width);
  if (width === 0 || x < -1 || x > width + 1) return null;
  return html`<span class="timeline-head" style=${`transform:translateX(${x.toFixed(2)}px)`}></span>`;
}

/** @param {{width: number, pointed_px: Signal<number | null>, draft: Signal<Range | null>}} props what is pointed at */
function Bubble({ width, pointed_px, draft }) {
  const x = pointed_px.value;
  const state = timeState.value;
  if (x === null || !state) return null;
  const range = seenRange.value;
  const at_s = timeAt(x, range, width);
  const reach_s = (NEAR_PX / Math.max(width, 1)) * (range.to_s - range.from_s);
  const tick = nearestTo(timeTicks.value.ticks, at_s, reach_s);
  const bookmark = nearestTo(bookmarks.value, at_s, reach_s);
  const part = draft.value;
  const words = part
    ? t("timeline.loop.length", { seconds: (part.to_s - part.from_s).toFixed(2) })
    : timeWords(tick?.at_s ?? bookmark?.at_s ?? at_s);
  const share = x / Math.max(width, 1);
  return html`<div class="timeline-bubble" style=${`left:${x.toFixed(0)}px;transform:translateX(${(-100 * share).toFixed(1)}%)`}>
    <span class="numbers">${words}</span>
    ${bookmark && html`<span class="timeline-bubble-name">${bookmark.name}</span>`}
    ${tick && html`<span class=${`timeline-bubble-tick ${tick.level}`}><b>${tick.source}</b> ${tick.text}</span>`}</div>`;
}

/** @param {number} at_s @returns {string} since the start, and by the clock */
export function timeWords(at_s) {
  const state = timeState.value;
  if (!state) return "";
  const start = sinceStart(at_s - startOf(state), 3);
  return isOfDay(state.zero_s) ? `${start} · ${clockTime(state.zero_s + at_s)}` : start;
}

/** A simulation counts from its own beginning. */
const EPOCH_FROM_S = 1e9;

/** @param {number} zero_s @returns {boolean} its seconds are those of a clock */
export const isOfDay = (zero_s) => zero_s >= EPOCH_FROM_S;

/** @param {import("../types/wire.d.ts").TimeState} state @returns {number} what people count from: a bag's first message, else now */
export const startOf = ({ mode, begin_s }) => (mode === "bag" ? begin_s : wholeTime.value.to_s);

/** @param {HTMLElement | null} box is told its value as a slider, ten times a second at most */
function tellValue(box) {
  const state = timeState.value;
  if (!box || !state) return;
  const { from_s, to_s } = wholeTime.value;
  const at_s = now_s.value;
  const time = sinceStart(at_s - startOf(state), 1);
  const clock = new Date((state.zero_s + at_s) * 1000).toLocaleTimeString(language.value);
  const valuetext = isOfDay(state.zero_s) ? t("timeline.value", { time, clock }) : time;
  if (box.getAttribute("aria-valuetext") === valuetext) return;
  box.setAttribute("aria-valuetext", valuetext);
  box.setAttribute("aria-valuemin", from_s.toFixed(1));
  box.setAttribute("aria-valuemax", to_s.toFixed(1));
  box.setAttribute("aria-valuenow", at_s.toFixed(1));
}

/** @type {{topic: string, range: Range, bins: number} | null} */
let wished = null;

/** Asks for what is drawn, unless it is nearly there. @param {number} width px */
function wishMarks(width) {
  const { value: range } = seenRange;
  const topic = markTopic.value;
  const bins = Math.round(width / BAR_PX);
  if (width === 0 || !timeState.value) return;
  const apart = wished
    ? Math.abs(range.from_s - wished.range.from_s) + Math.abs(range.to_s - wished.range.to_s)
    : Number.POSITIVE_INFINITY;
  const isNear =
    timeMarks.value !== null &&
    wished?.topic === topic &&
    wished.bins === bins &&
    apart < OTHER_SHARE * (range.to_s - range.from_s);
  if (isNear) return;
  wished = { topic, range, bins };
  askMarks(range, bins);
}

/** @returns {Colors} */
function colorsNow() {
  const style = getComputedStyle(document.documentElement);
  const of = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
  return {
    ...{
      text: of("text"),
      panel: of("panel"),
      muted: of("muted"),
      line: of("line"),
      track: of("line-strong"),
    },
    ...{ accent: of("accent"), soft: of("field"), red: of("red"), amber: of("amber") },
    violet: of("violet"),
  };
}

/** @param {HTMLCanvasElement | null} canvas @param {{width: number, height: number, thin: boolean, draft: Signal<Range | null>}} what */
function draw(canvas, { width, height, thin, draft }) {
  theme.value; // other colours
  const state = timeState.value;
  const context = canvas?.getContext("2d");
  if (!canvas || !context || !state || width === 0) return;
  const scale = devicePixelRatio;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  context.setTransform(scale, 0, 0, scale, 0, 0);
  const part = draft.value;
  const marks = timeMarks.value;
  paintTimeline(
    context,
    {
      ...{ width, height, thin, range: seenRange.value, kept: wholeTime.value },
      zero_s: startOf(state),
      marks: marks?.topic === markTopic.value ? marks : null,
      ticks: timeTicks.value.ticks,
      bookmarks: bookmarks.value,
      loop: part ? [part.from_s, part.to_s] : state.loop,
    },
    colorsNow(),
    getComputedStyle(canvas).fontFamily,
  );
}

/** @typedef {{thin: boolean, pointed_px: Signal<number | null>, draft: Signal<Range | null>}} Ruler */
/** @typedef {{kind: "seek" | "loop", from_px: number, moved: boolean, anchor_s: number}} Drag */

/** @param {HTMLElement | null} box @param {Ruler} ruler @returns {() => void} the end of it */
function listen(box, ruler) {
  if (!box) return () => {};
  const stop = new AbortController();
  const { signal } = stop;
  /** @type {Map<number, number>} where each finger is, px */
  const fingers = new Map();
  /** @type {Drag | null} */
  let drag = null;
  const place = (/** @type {PointerEvent | WheelEvent} */ event) => {
    const { left, top, width } = box.getBoundingClientRect();
    return { x: Math.min(Math.max(event.clientX - left, 0), width), y: event.clientY - top, width };
  };
  /** @param {PointerEvent} event */
  const down = (event) => {
    if (event.button !== 0) return;
    const { x, y, width } = place(event);
    fingers.set(event.pointerId, x);
    box.setPointerCapture(event.pointerId);
    if (fingers.size > 1) {
      drag = null; // two of them zoom
      ruler.draft.value = null;
      return;
    }
    if (!mayMoveTime.peek()) return;
    drag = begun(x, y, width, ruler.thin);
    ruler.pointed_px.value = x;
    if (drag.kind === "seek") dragTime(timeAt(x, seenRange.peek(), width));
  };
  /** @param {PointerEvent} event */
  const move = (event) => {
    const { x, width } = place(event);
    if (fingers.size > 1 && fingers.has(event.pointerId)) {
      pinch(fingers, event.pointerId, x, width);
      return;
    }
    ruler.pointed_px.value = event.pointerType === "touch" && !drag ? null : x;
    if (!drag) return;
    drag.moved ||= Math.abs(x - drag.from_px) > STILL_PX;
    const at_s = timeAt(x, seenRange.peek(), width);
    if (drag.kind === "seek") dragTime(at_s);
    else if (drag.moved) ruler.draft.value = ordered(drag.anchor_s, at_s);
  };
  /** @param {PointerEvent} event */
  const up = (event) => {
    const { x, width } = place(event);
    fingers.delete(event.pointerId);
    if (event.pointerType === "touch") ruler.pointed_px.value = null;
    const ended = drag;
    drag = null;
    const part = ruler.draft.peek();
    ruler.draft.value = null;
    if (!ended) return;
    if (ended.kind === "loop" && part) void loopTime(part);
    else void seekTime(ended.moved ? timeAt(x, seenRange.peek(), width) : clicked(x, width));
  };
  const cancel = (/** @type {PointerEvent} */ event) => {
    fingers.delete(event.pointerId);
    if (drag?.kind === "seek") void seekTime(now_s.peek());
    drag = null;
    ruler.draft.value = null;
    ruler.pointed_px.value = null;
  };
  const leave = () => {
    if (!drag) ruler.pointed_px.value = null;
  };
  /** @param {WheelEvent} event */
  const wheel = (event) => {
    event.preventDefault();
    const { x, width } = place(event);
    turned(event, x, width);
  };
  box.addEventListener("pointerdown", down, { signal });
  box.addEventListener("pointermove", move, { signal });
  box.addEventListener("pointerup", up, { signal });
  box.addEventListener("pointercancel", cancel, { signal });
  box.addEventListener("pointerleave", leave, { signal });
  box.addEventListener("wheel", wheel, { signal, passive: false });
  return () => stop.abort();
}

/** @param {number} x @param {number} y @param {number} width px @param {boolean} thin @returns {Drag} a drag above the track marks a part to loop, or moves an end of it */
function begun(x, y, width, thin) {
  const range = seenRange.peek();
  const at_s = timeAt(x, range, width);
  const drag = { from_px: x, moved: false, anchor_s: at_s };
  if (thin || y > RULER_PX) return { ...drag, kind: "seek" };
  const [begin_s, end_s] = timeState.peek()?.loop ?? [];
  const isNear = (/** @type {number | undefined} */ one) =>
    one !== undefined && Math.abs(placeOf(one, range, width) - x) <= NEAR_PX;
  if (end_s !== undefined && isNear(begin_s)) drag.anchor_s = end_s;
  else if (begin_s !== undefined && isNear(end_s)) drag.anchor_s = begin_s;
  return { ...drag, kind: "loop" };
}

/** @param {number} one @param {number} other @returns {Range} */
const ordered = (one, other) => ({ from_s: Math.min(one, other), to_s: Math.max(one, other) });

/** @param {number} x @param {number} width px @returns {number} an error, a warning or a bookmark that is clicked leads to its own time */
function clicked(x, width) {
  const range = seenRange.peek();
  const at_s = timeAt(x, range, width);
  const reach_s = (NEAR_PX / Math.max(width, 1)) * (range.to_s - range.from_s);
  const meant =
    nearestTo(timeTicks.peek().ticks, at_s, reach_s) ?? nearestTo(bookmarks.peek(), at_s, reach_s);
  return meant?.at_s ?? at_s;
}

/** @param {Range} range show this; all of it is the whole, also when that grows */
export function showTime(range) {
  const whole = wholeTime.peek();
  const isWhole = range.to_s - range.from_s >= whole.to_s - whole.from_s;
  timeZoom.value = isWhole ? null : range;
}

/** @param {WheelEvent} event @param {number} x @param {number} width px zooms; to the side, or with Shift, it moves along */
function turned({ deltaX, deltaY, shiftKey }, x, width) {
  const range = seenRange.peek();
  const whole = wholeTime.peek();
  const along = shiftKey ? deltaY || deltaX : deltaX;
  if (shiftKey || Math.abs(deltaX) > Math.abs(deltaY))
    showTime(pannedTime(range, (along / Math.max(width, 1)) * (range.to_s - range.from_s), whole));
  else showTime(zoomedTime(range, Math.exp(-deltaY * WHEEL), timeAt(x, range, width), whole));
}

/** @param {Map<number, number>} fingers @param {number} moved its id @param {number} x where it is now @param {number} width px */
function pinch(fingers, moved, x, width) {
  const [one = 0, other = 0] = fingers.values();
  fingers.set(moved, x);
  const [first = 0, second = 0] = fingers.values();
  const range = seenRange.peek();
  const whole = wholeTime.peek();
  const factor = Math.max(Math.abs(first - second), 1) / Math.max(Math.abs(one - other), 1);
  const middle_s = timeAt((first + second) / 2, range, width);
  const by_px = (one + other - first - second) / 2;
  const zoomed = zoomedTime(range, factor, middle_s, whole);
  showTime(pannedTime(zoomed, (by_px / width) * (zoomed.to_s - zoomed.from_s), whole));
}

/** @param {KeyboardEvent} event */
function onKeyDown(event) {
  const whole = wholeTime.peek();
  const range = seenRange.peek();
  const at_s = timeAfterKey(event, now_s.peek(), whole);
  if (at_s !== null && mayMoveTime.peek()) void seekTime(at_s);
  else if (event.ctrlKey || event.metaKey || event.altKey) return;
  else if (event.key === "+") showTime(zoomedTime(range, KEY_ZOOM, now_s.peek(), whole));
  else if (event.key === "-") showTime(zoomedTime(range, 1 / KEY_ZOOM, now_s.peek(), whole));
  else if (event.key === "0") timeZoom.value = null;
  else if (mayMoveTime.peek() && /^[iIoO]$/.test(event.key)) loopFromNow(/i/i.test(event.key));
  else if (mayMoveTime.peek() && /^[bB]$/.test(event.key)) bookmarkNow();
  else return;
  event.preventDefault();
  event.stopPropagation();
}
