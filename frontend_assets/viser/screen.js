/** @import { Door } from "./door.js" */
/** @import { Vector3 } from "./viser.d.ts" */

import { depthOf } from "./orthographic.js";

/** @typedef {[number, number]} Place px from the upper left corner of the picture */

/** Where a point of the scene is seen; null: behind the eye, or there is no picture.
 * @param {Door} door @param {Vector3} point @returns {Place | null} */
export function placeOf(door, point) {
  const { canvas, camera } = door.mutable ?? {};
  if (!canvas || !camera) return null;
  if (depthOf(camera, point) < camera.near) return null;
  const seen = point.clone().project(camera);
  const frame = canvas.getBoundingClientRect();
  return [
    frame.left + ((seen.x + 1) / 2) * frame.width,
    frame.top + ((1 - seen.y) / 2) * frame.height,
  ];
}

/** @param {Place} a @param {Place} b */
export function pixelsBetween(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** @param {Place} place @param {Place} begin @param {Place} end @returns {number} px to the nearest place of the line between them */
export function pixelsToLine(place, begin, end) {
  const [wayX, wayY] = [end[0] - begin[0], end[1] - begin[1]];
  const length2 = wayX * wayX + wayY * wayY;
  const along = (place[0] - begin[0]) * wayX + (place[1] - begin[1]) * wayY;
  const share = length2 > 0 ? Math.min(Math.max(along / length2, 0), 1) : 0;
  return pixelsBetween(place, [begin[0] + share * wayX, begin[1] + share * wayY]);
}

/** About as wide as a character is, with room to both sides. */
const CHARACTER_PX = 8;
const LINE_PX = 24;
const SVG = "http://www.w3.org/2000/svg";
/** Dots of measures; others are larger. */
const SMALL = new Set(["point", "frame", "axis", "tool"]);

/** @typedef {{ places: Place[], kind: "line" | "axis" | "aim" | "chain" | "arrow", colour?: string }} Line */
/** @typedef {{ place: Place, kind: "point" | "frame" | "axis" | "aim" | "centre" | "guide" | "tool" }} Dot */
/** @typedef {{ place: Place, text: string, kind: "measure" | "aim" | "centre" }} Label */

/** Lines, dots and words over the picture; they are in nobody's way. */
export class DrawnLines {
  #svg = document.createElementNS(SVG, "svg");
  #labels = document.createElement("div");
  #drawn = "";

  constructor() {
    this.#svg.classList.add("studio-lines");
    this.#svg.setAttribute("aria-hidden", "true");
    this.#labels.className = "studio-labels";
  }

  /** Draw these and nothing else. @param {{ lines: Line[], dots: Dot[], labels: Label[] }} all */
  draw(all) {
    const wanted = JSON.stringify(all);
    if (wanted === this.#drawn) return;
    this.#drawn = wanted;
    if (!this.#svg.isConnected) document.body.append(this.#svg, this.#labels);
    this.#svg.replaceChildren(
      ...all.lines.flatMap((line) => [lineOf(line, "casing"), lineOf(line, line.kind)]),
      ...all.dots.map(dotOf),
    );
    this.#labels.replaceChildren(...apart(all.labels).map(labelOf));
  }
}

/** @param {Line} line @param {string} look */
function lineOf({ places, colour }, look) {
  const element = document.createElementNS(SVG, "polyline");
  element.setAttribute("points", places.map((place) => place.map(round).join(",")).join(" "));
  element.setAttribute("class", look);
  if (colour && look !== "casing") element.style.stroke = colour;
  return element;
}

/** @param {Dot} dot */
function dotOf({ place, kind }) {
  const element = document.createElementNS(SVG, "circle");
  element.setAttribute("cx", String(round(place[0])));
  element.setAttribute("cy", String(round(place[1])));
  element.setAttribute("r", SMALL.has(kind) ? "4" : "7");
  element.setAttribute("class", kind);
  return element;
}

/** Words that would cover others go below them. @param {Label[]} labels @returns {Label[]} */
function apart(labels) {
  /** @type {Label[]} */
  const placed = [];
  for (const label of labels) {
    const [x, start] = label.place;
    let y = start;
    const covers = (/** @type {Label} */ { place, text }) =>
      Math.abs(place[0] - x) < CHARACTER_PX * Math.max(text.length, label.text.length) &&
      Math.abs(place[1] - y) < LINE_PX;
    while (label.kind !== "aim" && placed.some(covers)) y += LINE_PX;
    placed.push({ ...label, place: [x, y] });
  }
  return placed;
}

/** @param {Label} label */
function labelOf({ place: [x, y], text, kind }) {
  const element = document.createElement("output");
  element.className = `studio-label ${kind}`;
  element.textContent = text;
  const isRight = x > innerWidth * 0.6;
  const isLow = y > innerHeight - 2 * LINE_PX;
  const beside = `translate(${isRight ? "calc(-100% - 14px)" : "14px"}, ${isLow ? "calc(-100% - 14px)" : "14px"})`;
  const away = kind === "aim" ? beside : "translate(-50%, -50%)";
  element.style.transform = `translate(${round(x)}px, ${round(y)}px) ${away}`;
  return element;
}

/** @param {number} value */
const round = (value) => Math.round(value * 10) / 10;
