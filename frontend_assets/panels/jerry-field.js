/** Jerry's world from above: x points up, y to the left, as he looks at it. */

/** @import { Place } from "../lib/jerry.js" */
/** @import { Seen } from "../app/jerry.js" */

import { html, useRef } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { gridLines, placeText, viewOf } from "../lib/jerry.js";

/** @type {Record<string, string>} */
const KEYS = {
  ArrowUp: "forward",
  ArrowDown: "backward",
  ArrowLeft: "left",
  ArrowRight: "right",
};
/** Places that were asked for are drawn, so many of them. */
const MARKS_MAX = 8;

/** @param {{known: Seen, go: (direction: string) => void, ask: (place: Place) => void}} props */
export function JerryField({ known, go, ask }) {
  known.turn.value;
  const { walk, runs } = known;
  const drawing = useRef(/** @type {any} */ (null));
  const marks = runs.slice(0, MARKS_MAX);
  const view = viewOf([...walk.way, ...marks.map(({ place }) => place)]);
  const { low, size } = view;
  // On the screen y goes to the left and x up.
  const box = `${-low.y - size} ${-low.x - size} ${size} ${size}`;
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    const direction = KEYS[event.key];
    if (!direction || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) go(direction);
  };
  const onClick = (/** @type {MouseEvent} */ event) => {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(
      drawing.current.getScreenCTM().inverse(),
    );
    ask({ x: halved(-y), y: halved(-x) });
  };
  const where = walk.place ? t("jerry.at", { place: placeText(walk.place) }) : "";
  return html`<div class="field-frame jerry-frame" role="application" tabindex="0" aria-label=${t("jerry.field", { where })} onKeyDown=${onKeyDown}>
    <svg ref=${drawing} viewBox=${box} class="jerry-field" style=${`--pixel:${size / 400}px`} onClick=${onClick}>
      <${Grid} view=${view} />
      <polyline class="jerry-way" points=${walk.way.map(pointText).join(" ")} />
      ${marks.map((run) => html`<${Mark} key=${run.number} run=${run} size=${size} />`)}
      ${walk.place && html`<${Figure} place=${walk.place} size=${size} />`}
    </svg></div>`;
}

/** @param {Place} place @returns {string} */
const pointText = ({ x, y }) => `${-y},${-x}`;

/** @param {number} value m @returns {number} to half a metre, and no -0 */
const halved = (value) => Math.round(value * 2) / 2 + 0;

/** @param {{view: import("../lib/jerry.js").View}} props lines, the axes among them, and their numbers */
function Grid({ view: { low, size, step } }) {
  const letters = size / 32;
  const kind = (/** @type {number} */ at) => (at === 0 ? "jerry-axis" : "jerry-line");
  const ahead = gridLines(low.x, size, step);
  const aside = gridLines(low.y, size, step);
  // The corner where both would stand has none, and no number is cut off by an edge.
  const isRoom = (/** @type {number} */ from, /** @type {number} */ at) =>
    at !== 0 && at - from > 4 * letters && from + size - at > 2 * letters;
  return html`<g>
    ${ahead.map((x) => html`<line key=${`x${x}`} class=${kind(x)} x1=${-low.y - size} x2=${-low.y} y1=${-x} y2=${-x} />`)}
    ${aside.map((y) => html`<line key=${`y${y}`} class=${kind(y)} y1=${-low.x - size} y2=${-low.x} x1=${-y} x2=${-y} />`)}
    ${ahead.filter((x) => isRoom(low.x, x)).map((x) => html`<text key=${`t${x}`} class="jerry-number" font-size=${letters} x=${-low.y - letters / 3} y=${-x - letters / 4} text-anchor="end">x ${x}</text>`)}
    ${aside.filter((y) => isRoom(low.y, y)).map((y) => html`<text key=${`u${y}`} class="jerry-number" font-size=${letters} x=${-y + letters / 4} y=${-low.x - letters / 3}>y ${y}</text>`)}
  </g>`;
}

/** @param {{run: import("../app/jerry.js").Run, size: number}} props a place that was asked for, and the way there */
function Mark({ run: { place, from, isExact }, size }) {
  const radius = size / 70;
  return html`<g class=${`jerry-mark ${isExact ? "" : "ignored"}`}>
    <line x1=${-from.y} y1=${-from.x} x2=${-place.y} y2=${-place.x} />
    <circle cx=${-place.y} cy=${-place.x} r=${radius} />
    <text class="jerry-number" font-size=${size / 30} x=${-place.y + radius * 1.5} y=${-place.x - radius}>${placeText(place)}</text></g>`;
}

/** @param {{place: Place, size: number}} props a round robot with two eyes that look ahead */
function Figure({ place, size }) {
  const scale = size / 24;
  return html`<g class="jerry-figure" transform=${`translate(${-place.y} ${-place.x}) scale(${scale})`}>
    <circle class="jerry-ear" cx="-0.48" cy="-0.5" r="0.26" /><circle class="jerry-ear" cx="0.48" cy="-0.5" r="0.26" />
    <circle class="jerry-body" r="0.62" />
    <circle class="jerry-eye" cx="-0.22" cy="-0.2" r="0.12" /><circle class="jerry-eye" cx="0.22" cy="-0.2" r="0.12" />
    <path class="jerry-mouth" d="M-0.26 0.18 Q0 0.42 0.26 0.18" /></g>`;
}
