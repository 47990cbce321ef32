/** How a drawing is moved and scaled in its frame: pure steps from one view to the next. */

import { clamp } from "./numbers.js";

/** @typedef {{x: number, y: number, scale: number}} View where the drawing's corner is in the frame, px */
/** @typedef {{width: number, height: number}} Size px */

const SCALE_MIN = 0.12;
const SCALE_MAX = 3;
/** Below it no name can be read: of a large drawing a part is shown rather. */
const FIT_MIN = 0.55;
const MARGIN = 34;
/** Where only so little around it lets all of it be seen. */
const MARGIN_LEAST = 8;

/** @param {View} view @param {number} factor @param {{x: number, y: number}} at stays where it is @param {number} [closest] the largest scale @param {number} [farthest] the smallest @returns {View} */
export function zoomed(view, factor, at, closest = SCALE_MAX, farthest = SCALE_MIN) {
  const scale = Math.min(closest, Math.max(farthest, view.scale * factor));
  const ratio = scale / view.scale;
  return { x: at.x - (at.x - view.x) * ratio, y: at.y - (at.y - view.y) * ratio, scale };
}

/** @param {View} view @param {Size} before @param {Size} now of the frame @returns {View} what was seen is seen still, its middle in the middle */
export function resized(view, before, now) {
  const share = Math.min(now.width / before.width, now.height / before.height);
  const scale = clamp(view.scale * share, SCALE_MIN, SCALE_MAX);
  const ratio = scale / view.scale;
  return {
    x: now.width / 2 - (before.width / 2 - view.x) * ratio,
    y: now.height / 2 - (before.height / 2 - view.y) * ratio,
    scale,
  };
}

/** @param {Size} drawing @param {Size} frame @param {{x: number, y: number}} [heart] of the drawing: where all of it has no room, what is around this @returns {View} in the middle, as large as can be read */
export function fitted(drawing, frame, heart = { x: 0, y: 0 }) {
  const within = (/** @type {number} */ around) =>
    Math.min(
      (frame.width - 2 * around) / Math.max(drawing.width, 1),
      (frame.height - 2 * around) / Math.max(drawing.height, 1),
    );
  const margin = [MARGIN, MARGIN_LEAST].find((one) => within(one) >= FIT_MIN) ?? MARGIN;
  const scale = Math.max(FIT_MIN, Math.min(1, within(margin)));
  const place = (
    /** @type {number} */ inner,
    /** @type {number} */ outer,
    /** @type {number} */ middle,
  ) => {
    const room = outer - inner * scale;
    if (room >= 2 * margin) return room / 2;
    return clamp(outer / 2 - middle * scale, room - margin, margin);
  };
  return {
    x: place(drawing.width, frame.width, heart.x),
    y: place(drawing.height, frame.height, heart.y),
    scale,
  };
}
