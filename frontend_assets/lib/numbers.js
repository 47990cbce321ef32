/** Numbers as they are written into files and shown in boxes: no float noise, no lost digits. */

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/;
const DEGREES_PER_RADIAN = 180 / Math.PI;

/**
 * @param {string} text
 * @returns {number | null} the number that the text is, null when it is anything else
 */
export function parseNumber(text) {
  const trimmed = text.trim();
  const number = NUMBER.test(trimmed) ? Number(trimmed) : Number.NaN;
  return Number.isFinite(number) ? number : null;
}

/**
 * @param {number} value
 * @param {number} [digits] significant digits that are kept
 * @returns {string} the shortest text of the value, never `1e-7` for what reads better as 0
 */
export function formatNumber(value, digits = 10) {
  if (!Number.isFinite(value)) return String(value);
  const rounded = Number(value.toPrecision(digits));
  if (rounded === 0) return "0";
  const size = Math.abs(rounded);
  return size < 1e-6 || size >= 1e15 ? String(rounded) : plain(rounded);
}

/** Significant digits of a number in a panel; its title has all of them. */
const SHOWN_DIGITS = 6;
/** A number with a long fraction that is no part of a name, a path or a version. */
const LONG_NUMBER = /(?<![\w./-])[+-]?\d+\.\d{5,}(e[+-]?\d+)?(?![\w./])/gi;

/** Below it, in m, rad, mm or degrees, there is only noise of the arithmetic. */
const NOISE = 1e-9;

/** @param {number} value @returns {string} with as many digits as are read in a panel */
export const shownNumber = (value) => formatNumber(value, SHOWN_DIGITS);

/** @param {number} value a length or an angle that was computed @returns {string} as it is shown */
export const shownMeasure = (value) => shownNumber(Math.abs(value) < NOISE ? 0 : value);

/** @param {number} value @returns {string} with all digits that it has, for a title */
export const allDigits = (value) => formatNumber(value, 15);

/** @param {string} text @returns {string} its numbers as they are shown, all else as it is */
export const shownNumbers = (text) => text.replace(LONG_NUMBER, (one) => shownNumber(Number(one)));

/** @param {number} value @returns {string} without an exponent */
function plain(value) {
  const text = String(value);
  return text.includes("e") ? value.toFixed(12).replace(/\.?0+$/, "") : text;
}

/** @param {number} step @returns {number} digits behind the point that the step needs */
export function decimalsOf(step) {
  const text = plain(Number(step.toPrecision(10)));
  const point = text.indexOf(".");
  return point < 0 ? 0 : text.length - point - 1;
}

/**
 * @param {number} value
 * @param {number} step grid of the values, counted from zero as people write them
 * @returns {number} the nearest value on the grid
 */
export function snap(value, step) {
  if (!(step > 0)) return value;
  return Number((Math.round(value / step) * step).toFixed(Math.min(decimalsOf(step), 12)));
}

/** @param {number} value @param {number} lower @param {number} upper */
export function clamp(value, lower, upper) {
  return Math.min(Math.max(value, lower), upper);
}

/**
 * @param {number} lower
 * @param {number} upper
 * @returns {number} a step of 1, 2 or 5 times a power of ten: about 200 of them in the range
 */
export function niceStep(lower, upper) {
  const raw = (upper - lower) / 200;
  if (!(raw > 0) || !Number.isFinite(raw)) return 0.01;
  const power = 10 ** Math.floor(Math.log10(raw));
  const factor = [1, 2, 5, 10].find((one) => raw <= one * power * 1.000001) ?? 10;
  return Number((factor * power).toPrecision(6));
}

/** @param {number} rad @returns {number} degrees, without float noise */
export function toDegrees(rad) {
  return Number((rad * DEGREES_PER_RADIAN).toPrecision(12));
}

/** @param {number} deg @returns {number} radians, to 9 significant digits */
export function toRadians(deg) {
  return Number((deg / DEGREES_PER_RADIAN).toPrecision(9));
}

/**
 * @param {number} step what one arrow key press is worth
 * @param {{shiftKey: boolean, altKey: boolean}} keys
 * @returns {number} Shift makes it ten times larger, Alt ten times smaller
 */
export function steppedBy(step, { shiftKey, altKey }) {
  if (shiftKey) return step * 10;
  return altKey ? step / 10 : step;
}
