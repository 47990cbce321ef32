/** How a drawing is moved and scaled in its frame: pure steps from one view to the next. */

/** @typedef {{x: number, y: number, scale: number}} View where the drawing's corner is in the frame, px */
/** @typedef {{width: number, height: number}} Size px */

const SCALE_MIN = 0.12;
const SCALE_MAX = 3;
/** Below it no name can be read: a large drawing begins at its corner rather. */
const FIT_MIN = 0.55;
const MARGIN = 34;

/** @param {View} view @param {number} factor @param {{x: number, y: number}} at stays where it is @param {number} [closest] the largest scale @returns {View} */
export function zoomed(view, factor, at, closest = SCALE_MAX) {
  const scale = Math.min(closest, Math.max(SCALE_MIN, view.scale * factor));
  const ratio = scale / view.scale;
  return { x: at.x - (at.x - view.x) * ratio, y: at.y - (at.y - view.y) * ratio, scale };
}

/** @param {Size} drawing @param {Size} frame @returns {View} all of it, in the middle, as far as it can be read then */
export function fitted(drawing, frame) {
  const wide = (frame.width - 2 * MARGIN) / Math.max(drawing.width, 1);
  const high = (frame.height - 2 * MARGIN) / Math.max(drawing.height, 1);
  const scale = Math.max(FIT_MIN, Math.min(1, wide, high));
  const place = (/** @type {number} */ inner, /** @type {number} */ outer) =>
    Math.max(MARGIN, (outer - inner * scale) / 2);
  return {
    x: place(drawing.width, frame.width),
    y: place(drawing.height, frame.height),
    scale,
  };
}
