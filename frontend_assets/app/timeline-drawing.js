/** The picture of the timeline: its steps, where messages are, gaps, errors and warnings, bookmarks, and the loop. */

/** @import { Bookmark, TimeTick } from "../types/wire.d.ts" */
/** @import { Range } from "../lib/timeline.js" */

import { gapsIn, placeOf, placesOf, rulerSteps, sinceStart } from "../lib/timeline.js";

/** Height of the ruler above the track, px; a thin bar has none. */
export const RULER_PX = 16;
const FLAG_PX = 7;
const TICK_PX = 6;
/** A name has to have so much room behind its flag. */
const NAME_LEAST_PX = 30;

/**
 * @typedef {object} Painted
 * @property {number} width px
 * @property {number} height px
 * @property {boolean} thin without ruler
 * @property {Range} range that is seen
 * @property {Range} kept what there is
 * @property {number} zero_s what the words of the ruler count from
 * @property {{range: Range, counts: readonly number[]} | null} marks
 * @property {readonly TimeTick[]} ticks
 * @property {readonly Bookmark[]} bookmarks
 * @property {readonly number[] | null} loop
 */

/** @typedef {Record<"text" | "panel" | "muted" | "line" | "track" | "accent" | "soft" | "red" | "amber" | "violet", string>} Colors */

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {string} font */
export function paintTimeline(context, painted, colors, font) {
  const { width, height, thin } = painted;
  context.clearRect(0, 0, width, height);
  context.font = `11px ${font}`;
  const top = thin ? 0 : RULER_PX;
  paintTrack(context, painted, colors, top);
  if (!thin) paintSteps(context, painted, colors);
  if (!thin) paintMarks(context, painted, colors, top);
  paintLoop(context, painted, colors, top);
  paintTicks(context, painted, colors, top);
  paintBookmarks(context, painted, colors, top);
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {number} top */
function paintTrack(context, { width, height, thin, range, kept }, colors, top) {
  const from = Math.max(placeOf(kept.from_s, range, width), 0);
  const to = Math.min(placeOf(kept.to_s, range, width), width);
  context.fillStyle = thin ? colors.track : colors.soft;
  context.beginPath();
  const [y, tall] = thin ? [height / 2 - 3, 6] : [top, height - top];
  context.roundRect(from, y, Math.max(to - from, 2), tall, 3);
  context.fill();
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors */
function paintSteps(context, { width, height, range, zero_s }, colors) {
  const { step_s, times } = rulerSteps(
    { from_s: range.from_s - zero_s, to_s: range.to_s - zero_s },
    width,
  );
  const places = placesOf(step_s);
  context.textBaseline = "middle";
  for (const time_s of times) {
    const x = Math.round(placeOf(time_s + zero_s, range, width));
    context.fillStyle = colors.line;
    context.fillRect(x, RULER_PX - 4, 1, height - RULER_PX + 4);
    const words = sinceStart(time_s, places);
    const room = context.measureText(words).width;
    context.fillStyle = colors.muted;
    // Nothing is cut off at either end.
    context.fillText(words, Math.min(Math.max(x + 4, 2), width - room - 2), RULER_PX / 2);
  }
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {number} top */
function paintMarks(context, { width, height, range, marks }, colors, top) {
  if (!marks || marks.counts.length === 0) return;
  const begin = placeOf(marks.range.from_s, range, width);
  const part = (placeOf(marks.range.to_s, range, width) - begin) / marks.counts.length;
  const most = Math.log1p(Math.max(...marks.counts, 1));
  const room = height - top - TICK_PX - 4;
  context.fillStyle = colors.accent;
  marks.counts.forEach((count, n) => {
    if (count === 0) return;
    // Of many and few messages both are seen: a part with any has a bar.
    const tall = room * (0.25 + 0.75 * (Math.log1p(count) / most));
    context.fillRect(begin + n * part, height - tall, Math.max(part, 1), tall);
  });
  paintGaps(context, { gaps: gapsIn(marks.counts, part), begin, part }, colors, height);
}

/** @param {CanvasRenderingContext2D} context @param {{gaps: [number, number][], begin: number, part: number}} where @param {Colors} colors @param {number} height */
function paintGaps(context, { gaps, begin, part }, colors, height) {
  context.strokeStyle = colors.muted;
  context.setLineDash([2, 3]);
  context.lineWidth = 1;
  for (const [from, to] of gaps) {
    context.beginPath();
    context.moveTo(begin + from * part + 1, height - 2.5);
    context.lineTo(begin + to * part - 1, height - 2.5);
    context.stroke();
  }
  context.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {number} top */
function paintLoop(context, { width, height, range, loop }, colors, top) {
  const [begin_s, end_s] = loop ?? [];
  if (begin_s === undefined || end_s === undefined) return;
  const from = placeOf(begin_s, range, width);
  const to = placeOf(end_s, range, width);
  context.fillStyle = colors.accent;
  context.globalAlpha = 0.22;
  context.fillRect(from, 0, to - from, height);
  context.globalAlpha = 1;
  context.fillRect(from, 0, to - from, top === 0 ? 2 : 3);
  context.fillRect(from - 1, 0, 2, height);
  context.fillRect(to - 1, 0, 2, height);
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {number} top */
function paintTicks(context, { width, range, ticks }, colors, top) {
  const placed = ticks.map(({ at_s, level }) => ({ level, x: placeOf(at_s, range, width) }));
  const seen = placed.filter(({ x }) => x > -TICK_PX && x < width + TICK_PX);
  const paint = (/** @type {TimeTick["level"]} */ wanted, /** @type {string} */ color) => {
    context.fillStyle = color;
    for (const { level, x } of seen)
      if (level === wanted) paintTick(context, x, top + 1, level === "error");
  };
  // Errors are seen above warnings.
  paint("warn", colors.amber);
  paint("error", colors.red);
}

/** By colour and by shape. @param {CanvasRenderingContext2D} context @param {number} x @param {number} y @param {boolean} isError */
function paintTick(context, x, y, isError) {
  context.beginPath();
  if (isError) {
    context.moveTo(x - TICK_PX / 2 - 1, y);
    context.lineTo(x + TICK_PX / 2 + 1, y);
    context.lineTo(x, y + TICK_PX + 1);
  } else context.arc(x, y + TICK_PX / 2, TICK_PX / 2 - 0.5, 0, 2 * Math.PI);
  context.fill();
}

/** @param {CanvasRenderingContext2D} context @param {Painted} painted @param {Colors} colors @param {number} top */
function paintBookmarks(context, { width, height, range, bookmarks, thin }, colors, top) {
  const places = bookmarks.map(({ at_s }) => placeOf(at_s, range, width));
  bookmarks.forEach(({ name }, n) => {
    const x = places[n] ?? 0;
    if (x < -FLAG_PX || x > width) return;
    context.fillStyle = colors.violet;
    context.fillRect(x - 0.5, top, 1.5, height - top);
    const y = height - FLAG_PX - 2;
    context.fillRect(x, y, FLAG_PX, FLAG_PX);
    const room = Math.min(places[n + 1] ?? width, width) - x - FLAG_PX - 6;
    if (!thin && room >= NAME_LEAST_PX)
      paintName(context, name, x + FLAG_PX + 3, y + 4, room, colors);
  });
}

/** @param {CanvasRenderingContext2D} context @param {string} name @param {number} x @param {number} y @param {number} room px @param {Colors} colors */
function paintName(context, name, x, y, room, colors) {
  let shown = name;
  while (shown.length > 1 && context.measureText(shown).width > room)
    shown = `${shown.slice(0, -2)}…`;
  context.fillStyle = colors.panel;
  context.fillRect(x - 2, y - 7, context.measureText(shown).width + 4, 14);
  context.fillStyle = colors.text;
  context.textBaseline = "middle";
  context.fillText(shown, x, y);
}
