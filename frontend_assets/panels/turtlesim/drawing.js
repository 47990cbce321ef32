/** The field of turtlesim: its size, its pixels, and the turtles as they are drawn on it. */

import { clamp } from "../../lib/numbers.js";

/** Width and height, metres: 500 pixels of 45 to the metre, of which the last is left out. */
export const FIELD_M = 11.088889;
/** A turtle is so long, from head to tail. */
const TURTLE_M = 1;
const PIXELS_PER_M = 45;
/** What is drawn on is as fine as any screen shows it. */
const PAPER_PX = 1000;
const SHELLS = ["#3f9b4f", "#c8772d", "#8f5fc0", "#2f8fa8", "#b84a62", "#7d8a2e"];
const SKIN = "#d9c48a";

/** @typedef {{x: number, y: number}} Point */
/** @typedef {{from: Point, to: Point, color: number}} Stroke */
/** @typedef {{name: string, x: number, y: number, theta: number, shell: number}} Drawn metres and radians */

/** @param {number} color 0xrrggbb @returns {string} as a page writes it */
export const hexOf = (color) => `#${color.toString(16).padStart(6, "0")}`;

/** @param {Point} place m, y upwards @param {number} size_px of the field @returns {Point} px, y downwards */
export function pixelOf({ x, y }, size_px) {
  return { x: (x / FIELD_M) * size_px, y: (1 - y / FIELD_M) * size_px };
}

/** @param {Point} pixel @param {number} size_px @returns {Point} m, on the field */
export function placeAt({ x, y }, size_px) {
  const metres = (/** @type {number} */ share) => clamp(share * FIELD_M, 0, FIELD_M);
  return { x: metres(x / size_px), y: metres(1 - y / size_px) };
}

/**
 * @template {Point} T
 * @param {Iterable<T>} turtles
 * @param {Point} place m
 * @returns {T | null} the one at that place, the nearest of several
 */
export function turtleAt(turtles, place) {
  let nearest = null;
  let least_m = TURTLE_M / 2;
  for (const one of turtles) {
    const distance_m = Math.hypot(one.x - place.x, one.y - place.y);
    if (distance_m <= least_m) [nearest, least_m] = [one, distance_m];
  }
  return nearest;
}

/** What has been drawn on the field; its background shines through. */
export class Paper {
  constructor() {
    this.canvas = new OffscreenCanvas(PAPER_PX, PAPER_PX);
    this.context = this.canvas.getContext("2d");
    if (this.context) this.context.lineCap = "round";
  }

  /** @param {readonly Stroke[]} strokes @param {number} width px of turtlesim's own window */
  draw(strokes, width) {
    const { context } = this;
    if (!context || width <= 0) return;
    context.lineWidth = (width / PIXELS_PER_M / FIELD_M) * PAPER_PX;
    for (const { from, to, color } of strokes) {
      const [begin, end] = [pixelOf(from, PAPER_PX), pixelOf(to, PAPER_PX)];
      context.strokeStyle = hexOf(color);
      context.beginPath();
      context.moveTo(begin.x, begin.y);
      context.lineTo(end.x, end.y);
      context.stroke();
    }
  }

  wipe() {
    this.context?.clearRect(0, 0, PAPER_PX, PAPER_PX);
  }
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} size_px of the square
 * @param {{background: number, paper: Paper, turtles: Iterable<Drawn>, chosen: string, moved: Drawn | null}} field
 *   `moved`: where one is dragged to
 */
export function drawField(context, size_px, { background, paper, turtles, chosen, moved }) {
  context.globalAlpha = 1;
  context.fillStyle = hexOf(background);
  context.fillRect(0, 0, size_px, size_px);
  context.drawImage(paper.canvas, 0, 0, size_px, size_px);
  for (const one of turtles) {
    drawTurtle(context, size_px, one);
    drawName(context, size_px, one, one.name === chosen);
  }
  if (!moved) return;
  context.globalAlpha = 0.6;
  drawTurtle(context, size_px, moved);
}

/** @param {CanvasRenderingContext2D} context @param {number} size_px @param {Drawn} turtle */
function drawTurtle(context, size_px, turtle) {
  const { x, y } = pixelOf(turtle, size_px);
  const scale = (size_px / FIELD_M) * TURTLE_M;
  context.save();
  context.translate(x, y);
  context.rotate(-turtle.theta);
  context.scale(scale, scale);
  context.lineWidth = 0.025;
  context.strokeStyle = "rgb(0 0 0 / 55%)";
  drawLimbs(context);
  drawShell(context, SHELLS[turtle.shell % SHELLS.length] ?? SKIN);
  context.restore();
}

/** Head, feet and tail, looking along x; a turtle is 1 long. @type {readonly (readonly [number, number, number, number, number])[]} */
const LIMBS = [
  [0.4, 0, 0.13, 0.1, 0],
  [0.22, 0.25, 0.13, 0.065, 0.7],
  [0.22, -0.25, 0.13, 0.065, -0.7],
  [-0.22, 0.24, 0.11, 0.06, -0.8],
  [-0.22, -0.24, 0.11, 0.06, 0.8],
  [-0.39, 0, 0.09, 0.03, 0],
];

/** @param {CanvasRenderingContext2D} context */
function drawLimbs(context) {
  context.fillStyle = SKIN;
  for (const [x, y, length, width, angle] of LIMBS)
    drawOval(context, x, y, length, width, angle, true);
  context.fillStyle = "#1b1b1b";
  for (const side of [-1, 1]) drawOval(context, 0.45, side * 0.05, 0.018, 0.018, 0, false);
}

/** @param {CanvasRenderingContext2D} context @param {string} color */
function drawShell(context, color) {
  context.fillStyle = color;
  drawOval(context, -0.02, 0, 0.33, 0.27, 0, true);
  context.fillStyle = "rgb(255 255 255 / 28%)";
  drawOval(context, -0.02, 0, 0.17, 0.13, 0, true);
  context.beginPath();
  for (const [x, y] of /** @type {const} */ ([
    [1, 0.55],
    [1, -0.55],
    [-1, 0.55],
    [-1, -0.55],
  ])) {
    context.moveTo(-0.02 + 0.12 * x, 0.16 * y);
    context.lineTo(-0.02 + 0.25 * x, 0.32 * y);
  }
  context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {number} x @param {number} y @param {number} long @param {number} wide @param {number} angle @param {boolean} lined */
function drawOval(context, x, y, long, wide, angle, lined) {
  context.beginPath();
  context.ellipse(x, y, long, wide, angle, 0, 2 * Math.PI);
  context.fill();
  if (lined) context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {number} size_px @param {Drawn} turtle @param {boolean} isChosen */
function drawName(context, size_px, turtle, isChosen) {
  const { x, y } = pixelOf(turtle, size_px);
  const below = (size_px / FIELD_M) * TURTLE_M * 0.62;
  const letters_px = Math.max(10, size_px / 46);
  context.font = `${isChosen ? 700 : 500} ${letters_px}px system-ui, sans-serif`;
  context.textAlign = "center";
  // Below it, and above it where the field ends.
  const at =
    y + below + letters_px > size_px ? y - below + letters_px / 2 : y + below + letters_px / 2;
  context.lineWidth = letters_px / 4;
  context.lineJoin = "round";
  context.strokeStyle = "rgb(0 0 0 / 65%)";
  context.strokeText(turtle.name, x, at);
  context.fillStyle = isChosen ? "#ffe9a8" : "#ffffff";
  context.fillText(turtle.name, x, at);
}
