/** @import { Door } from "./door.js" */
/** @import { Lens } from "./lens.js" */
/** @import { Object3D, Vector3 } from "./viser.d.ts" */

import { isSeen } from "./extent.js";
import { lensOf } from "./lens.js";
import { boxSeen, matrixOf } from "./live-picking.js";
import { groupName, meshName } from "./live-nodes.js";
import { boxCorners, RobotView } from "./robot.js";

/**
 * Where a selected item is.
 *
 * @typedef {object} Outlined
 * @property {string} display id; empty: it is a link of the robot
 * @property {string} path of its group, or the name of the link
 * @property {string} shape its name in the group, where that is drawn by itself; empty: it is not
 * @property {readonly number[] | null} box middle, edges and turn (w, x, y, z, or nothing) in the frame of its
 *   group; null: as large as what is drawn of it
 */

/** Pairs of corners of a box that are an edge; a corner's bits say on which side of each axis it is. */
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
  [1, 2, 4].flatMap((axis) => (corner & axis ? [] : [[corner, corner | axis]])),
);
/** What is seen smaller gets a square of this size, px. */
const LEAST_PX = 7;
/** Many would cover what they are around. */
const MANY = 100;
const LEAST_OF_MANY_PX = 2;
/** @type {[number, number, number]} */
const BELOW = [-0.5, -0.5, -0.5];
/** @type {[number, number, number]} */
const ABOVE = [0.5, 0.5, 0.5];

/** Boxes around what is selected, over the picture of this browser; they go with what moves. */
export class Outlines {
  /** @type {readonly Outlined[]} */
  #items = [];
  #canvas = document.createElement("canvas");
  #door;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    this.#canvas.className = "studio-outlines";
    this.#canvas.setAttribute("aria-hidden", "true");
    door.onPicture(
      () => undefined,
      () => this.#draw(),
    );
  }

  get count() {
    return this.#items.length;
  }

  /** @param {readonly Outlined[]} items */
  set(items) {
    if (items.length + this.#items.length === 0) return;
    this.#items = items;
    this.#canvas.hidden = items.length === 0;
    this.#door.redraw();
  }

  /** Corners of the boxes, in the axes of three.js. @returns {Vector3[]} */
  corners() {
    return this.#items.flatMap((item) => {
      const object = this.#nodeOf(item);
      const box = object && (item.box ?? boxOf(object));
      if (!object || !box) return [];
      return cornersOf(box).map((corner) =>
        object.position
          .clone()
          .set(...corner)
          .applyMatrix4(object.matrixWorld),
      );
    });
  }

  #draw() {
    if (this.#items.length === 0) return;
    const paint = this.#cleared();
    if (!paint) return;
    /** @type {Map<Object3D, Lens | null>} */
    const lenses = new Map();
    const least_px = this.#items.length > MANY ? LEAST_OF_MANY_PX : LEAST_PX;
    paint.beginPath();
    for (const item of this.#items) {
      const object = this.#nodeOf(item);
      if (!object || !isSeen(object)) continue;
      if (!lenses.has(object)) lenses.set(object, lensOf(this.#door, object));
      const lens = lenses.get(object);
      const box = item.box ?? boxOf(object);
      if (lens && box) trace(paint, lens, box, least_px);
    }
    stroke(paint, getComputedStyle(this.#canvas), this.#items.length > MANY);
  }

  /** @returns {CanvasRenderingContext2D | null} */
  #cleared() {
    const canvas = this.#canvas;
    if (!canvas.isConnected) document.body.append(canvas);
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(innerWidth * ratio), Math.round(innerHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    const paint = canvas.getContext("2d");
    paint?.setTransform(1, 0, 0, 1, 0, 0);
    paint?.clearRect(0, 0, width, height);
    paint?.setTransform(ratio, 0, 0, ratio, 0, 0);
    return paint;
  }

  /** @param {Outlined} item */
  #nodeOf({ display, path, shape, box }) {
    if (!display) return this.#door.node(RobotView.nodeName(path));
    const group = groupName(display, path);
    return this.#door.node(shape && !box ? meshName(group, shape) : group);
  }
}

/** Add a box to what is drawn. @param {CanvasRenderingContext2D} paint @param {Lens} lens @param {readonly number[]} box @param {number} least_px */
function trace(paint, lens, box, least_px) {
  const [x = 0, y = 0, z = 0, long = 0, wide = 0, high = 0] = box;
  const seen = boxSeen(lens, [x, y, z], turnOf(box), [long, wide, high], BELOW, ABOVE);
  if (!seen) return;
  const xs = seen.filter((_, at) => at % 2 === 0);
  const ys = seen.filter((_, at) => at % 2 === 1);
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const [across, down] = [Math.max(...xs) - left, Math.max(...ys) - top];
  if (Math.max(across, down) < LEAST_PX) {
    const [x, y] = [left + (across - least_px) / 2, top + (down - least_px) / 2];
    paint.rect(x, y, least_px, least_px);
    return;
  }
  for (const [from = 0, to = 0] of EDGES) {
    paint.moveTo(xs[from] ?? 0, ys[from] ?? 0);
    paint.lineTo(xs[to] ?? 0, ys[to] ?? 0);
  }
}

/** First dark or bright, then the colour: it is seen on anything. @param {CanvasRenderingContext2D} paint
 * @param {CSSStyleDeclaration} style @param {boolean} many thin lines, or there is nothing to see between them */
function stroke(paint, style, many) {
  paint.lineWidth = 3.5;
  paint.strokeStyle = style.getPropertyValue("--measure-edge");
  if (!many) paint.stroke();
  paint.lineWidth = many ? 1 : 1.5;
  paint.strokeStyle = style.getPropertyValue("--selected");
  paint.stroke();
}

/** The matrix of the turn of a box, which may have none. @param {readonly number[]} box */
const turnOf = (box) => matrixOf(box.slice(6), 0);

/** @param {readonly number[]} box @returns {[number, number, number][]} */
function cornersOf(box) {
  const turn = turnOf(box);
  return [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => {
    const own = [0, 1, 2].map((axis) => (((corner >> axis) & 1) - 0.5) * (box[3 + axis] ?? 0));
    const part = (/** @type {number} */ row) =>
      own.reduce((sum, one, axis) => sum + one * (turn[3 * row + axis] ?? 0), box[row] ?? 0);
    return [part(0), part(1), part(2)];
  });
}

/** A box around all meshes below an object, in its own axes; null: there is none. @param {Object3D} object @returns {number[] | null} */
function boxOf(object) {
  const low = [Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY];
  const high = low.map((part) => -part);
  const back = object.matrixWorld.clone().invert();
  object.traverseVisible((one) => {
    if (!one.isMesh || !one.geometry) return;
    for (const corner of boxCorners(one)) {
      const { x, y, z } = corner.applyMatrix4(back);
      [x, y, z].forEach((part, axis) => {
        low[axis] = Math.min(low[axis] ?? part, part);
        high[axis] = Math.max(high[axis] ?? part, part);
      });
    }
  });
  const size = high.map((part, axis) => part - (low[axis] ?? 0));
  if (!size.every((part) => part >= 0 && Number.isFinite(part))) return null;
  return [...low.map((part, axis) => part + (size[axis] ?? 0) / 2), ...size];
}
