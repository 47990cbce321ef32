/** A slider and a number box that share their manners: arrows step, Shift x10, Alt x0.1. */

import { html, useEffect, useId, useRef, useSignal } from "vendor/preact.js";
import { allDigits, clamp, formatNumber, parseNumber, snap, steppedBy } from "./numbers.js";

/**
 * @typedef {object} SliderProps
 * @property {string} label
 * @property {number} min
 * @property {number} max
 * @property {number} step
 * @property {number} value the studio's answer; while the person holds the thumb it follows the pointer
 * @property {string} text what a screen reader says for the value
 * @property {boolean} [disabled]
 * @property {(value: number) => void} onMove
 * @property {(stepped: boolean) => Promise<void>} onEnd fulfilled when the last move was answered;
 *   `stepped`: by a key, more of which may follow
 */

/** @param {SliderProps} props */
export function Slider({ label, min, max, step, value, text, disabled, onMove, onEnd }) {
  const held = useSignal(/** @type {number | null} */ (null));
  const moves = useRef(0);
  const range = useRef({ lower: min, upper: max });
  if (held.value === null)
    range.current = { lower: Math.min(min, value), upper: Math.max(max, value) };
  const { lower, upper } = range.current;
  const shown = clamp(held.value ?? value, lower, upper);
  /** @param {number} wanted */
  const move = (wanted) => {
    moves.current += 1;
    held.value = clamp(wanted, lower, upper);
    onMove(held.value);
  };
  /** @param {boolean} stepped */
  const end = async (stepped) => {
    const last = moves.current;
    await onEnd(stepped);
    if (last === moves.current) held.value = null;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const wanted = afterKey(event, shown, step, lower, upper);
    if (wanted === null) return;
    event.preventDefault();
    move(wanted);
    end(true);
  };
  const share = upper > lower ? ((shown - lower) / (upper - lower)) * 100 : 0;
  return html`<input type="range" class="slider" min=${lower} max=${upper} step="any" value=${shown} disabled=${disabled}
    aria-label=${label} aria-valuetext=${text} style=${`--fill:${share.toFixed(2)}%`} onKeyDown=${onKeyDown}
    onInput=${(/** @type {any} */ event) => move(onGrid(Number(event.currentTarget.value), step, lower, upper))}
    onChange=${() => end(false)} />`;
}

/**
 * @param {number} value
 * @param {number} step
 * @param {number} lower
 * @param {number} upper
 * @returns {number} on the grid of the step, but the ends can always be reached
 */
function onGrid(value, step, lower, upper) {
  const near = (upper - lower) / 1000;
  if (value - lower <= near) return lower;
  if (upper - value <= near) return upper;
  return clamp(snap(value, step), lower, upper);
}

/**
 * @param {KeyboardEvent} event
 * @param {number} value
 * @param {number} step
 * @param {number} lower
 * @param {number} upper
 * @returns {number | null} null: not one of our keys
 */
function afterKey(event, value, step, lower, upper) {
  if (event.ctrlKey || event.metaKey) return null;
  const by = steppedBy(step, event);
  /** @type {Record<string, number>} */
  const targets = {
    ArrowRight: value + by,
    ArrowUp: value + by,
    ArrowLeft: value - by,
    ArrowDown: value - by,
    PageUp: value + step * 10,
    PageDown: value - step * 10,
    Home: lower,
    End: upper,
  };
  const target = targets[event.key];
  return target === undefined ? null : clamp(Number(target.toPrecision(12)), lower, upper);
}

/** Characters that a box of a number shows; one in which more are typed has a line of its own. */
const FITS = 9;

/**
 * A box for one text. Enter and leaving it write; Escape gives back what stood there; arrows step a
 * number. What is typed is the person's until then; else the box shows the studio's answer.
 *
 * @param {{label: string, text: string, class?: string, disabled?: boolean, step?: number | undefined,
 *   invalid?: boolean, number?: number | null, takesEmpty?: boolean, complete?: (typed: string) => readonly string[], onWrite: (typed: string, options: {stepped: boolean}) => void}} props
 */
export function TextBox(props) {
  const { label, text, class: names, disabled, step, invalid, number, onWrite } = props;
  const typed = useSignal(/** @type {string | null} */ (null));
  const id = useId();
  useEffect(() => {
    if (typed.peek() === text) typed.value = null;
  }, [text]);
  const write = () => {
    const now = typed.peek();
    typed.value = null;
    const isWritten = now !== null && (props.takesEmpty || now.trim() !== "");
    if (isWritten && now !== text) onWrite(now, { stepped: false });
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.key === "Enter") write();
    else if (event.key === "Escape" && typed.peek() !== null) {
      typed.value = null;
      event.stopPropagation();
    } else if (
      step &&
      number !== null &&
      number !== undefined &&
      /^Arrow(Up|Down)$/.test(event.key)
    ) {
      event.preventDefault();
      typed.value = null;
      const by = steppedBy(step, event) * (event.key === "ArrowUp" ? 1 : -1);
      onWrite(formatNumber(number + by), { stepped: true });
    }
  };
  const offered = typed.value === null ? [] : (props.complete?.(typed.value) ?? []);
  const isLong = typed.value !== null && typed.value.length > FITS;
  return html`<input type="text" class=${`box ${names ?? ""} ${isLong ? "long" : ""}`} list=${offered.length > 0 ? id : null} aria-label=${label} value=${typed.value ?? text}
    disabled=${disabled} aria-invalid=${invalid ? "true" : null} spellcheck=${false} autocomplete="off" autocapitalize="off"
    inputmode=${names?.includes("number") ? "decimal" : null} title=${titleOf(text, number)}
    onInput=${(/** @type {any} */ event) => {
      typed.value = event.currentTarget.value;
    }} onKeyDown=${onKeyDown} onBlur=${write}
    onFocus=${(/** @type {any} */ event) => event.currentTarget.select()} />
    ${offered.length > 0 && html`<datalist id=${id}>${offered.map((one) => html`<option key=${one} value=${one}></option>`)}</datalist>`}`;
}

/** @param {string} text @param {number | null | undefined} number that it shows @returns {string | null} all digits, or a long text; null: the box shows as much */
function titleOf(text, number) {
  const shown = parseNumber(text);
  if (typeof number === "number" && shown !== null && shown !== number) return allDigits(number);
  return text.length > 12 ? text : null;
}
