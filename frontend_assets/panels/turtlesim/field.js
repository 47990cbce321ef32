/** The field of turtlesim: drawn once for each frame of the screen, clicked, dragged on and driven on. */

/** @import { OnField, Turtle, World } from "./world.js" */
/** @import { Drawn, Point } from "./drawing.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { mayAct } from "../../model/connection.js";
import { halt, useDrivingKeys } from "../../model/driving.js";
import { drawField, FIELD_M, placeAt, turtleAt } from "./drawing.js";
import { spawn, teleport } from "./turtles.js";

/** As fast as turtlesim's own keys have it. */
const LIMITS = { linear: 2, angular: 2, sideways: false, rate: 20 };
/** px: less is a click with a hand that shakes. */
const DRAGGED_PX = 5;
const MIDDLE = { x: FIELD_M / 2, y: FIELD_M / 2 };

/**
 * @typedef {object} FieldProps
 * @property {string} prefix
 * @property {World} world
 * @property {readonly Turtle[]} turtles
 * @property {Turtle | null} chosen
 * @property {(name: string) => void} choose
 * @property {Signal<boolean>} isPlacing the next click puts a turtle there
 */

/** @param {FieldProps} props */
export function TurtleField({ prefix, world, turtles, chosen, choose, isPlacing }) {
  const frame = useRef(/** @type {HTMLElement | null} */ (null));
  const moved = useRef(/** @type {Drawn | null} */ (null));
  const size_px = useSquare(frame);
  const canvas = useDrawing(world, size_px, chosen?.name ?? "", moved);
  const place = async (/** @type {Point} */ at) => {
    isPlacing.value = false;
    const name = await spawn(prefix, at, "");
    if (name) choose(name);
  };
  const dragged = (/** @type {Drawn} */ turtle) => {
    const there = turtles.find(({ name }) => name === turtle.name);
    if (there) teleport(there.path, turtle);
  };
  const hands = useHands({ world, size_px, moved, isPlacing, choose, place, dragged });
  const keys = useDrivingKeys(() => ({
    ...{ name: chosen?.drive?.name ?? `${chosen?.path ?? prefix}/cmd_vel` },
    ...{ stamped: chosen?.drive?.stamped ?? false, limits: () => LIMITS },
  }));
  const field = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => halt, []);
  // With the hint, not after it: a key that comes between would press the button once more.
  useLayoutEffect(() => {
    if (isPlacing.value) field.current?.focus();
  }, [isPlacing.value]);
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (!isPlacing.value) return chosen && keys.onKeyDown(event);
    if (event.key === "Enter") place(MIDDLE);
    else if (event.key === "Escape") isPlacing.value = false;
    return undefined;
  };
  const label = t(mayAct.value && chosen ? "turtlesim.field.drives" : "turtlesim.field", {
    name: chosen?.name ?? "",
  });
  return html`<div ref=${frame} class="field-frame">
    <div ref=${field} class=${`turtle-field ${isPlacing.value ? "placing" : ""}`} role="application" tabindex="0" aria-label=${label} style=${`width:${size_px}px;height:${size_px}px`}
      ...${hands} onKeyDown=${onKeyDown} onKeyUp=${keys.onKeyUp} onFocusOut=${keys.onFocusOut}><canvas ref=${canvas}></canvas>
      ${isPlacing.value && html`<p class="turtle-hint" role="status">${t("turtlesim.place")}</p>`}</div>
  </div>`;
}

/** @param {{current: HTMLElement | null}} frame @returns {number} px, the side of the largest square in it */
function useSquare(frame) {
  const side = useSignal(0);
  useLayoutEffect(() => {
    const watcher = new ResizeObserver(([entry]) => {
      const { width = 0, height = 0 } = entry?.contentRect ?? {};
      side.value = Math.floor(Math.min(width, height));
    });
    if (frame.current) watcher.observe(frame.current);
    return () => watcher.disconnect();
  }, []);
  return side.value;
}

/** @param {World} world @param {number} size_px @param {string} chosen @param {{current: Drawn | null}} moved @returns {{current: HTMLCanvasElement | null}} on which the world is drawn whenever it looks otherwise */
function useDrawing(world, size_px, chosen, moved) {
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  useLayoutEffect(() => {
    const element = canvas.current;
    const context = element?.getContext("2d");
    if (!element || !context || size_px <= 0) return undefined;
    element.width = element.height = Math.round(size_px * devicePixelRatio);
    world.isStale = true;
    let frame = 0;
    const go = () => {
      frame = requestAnimationFrame(go);
      if (!world.settle()) return;
      const turtles = [...world.turtles.values()].filter(({ isHere }) => isHere);
      const { background, paper } = world;
      drawField(context, element.width, {
        background,
        paper,
        turtles,
        chosen,
        moved: moved.current,
      });
    };
    go();
    return () => cancelAnimationFrame(frame);
  }, [world, size_px, chosen]);
  return canvas;
}

/**
 * @typedef {object} Handled
 * @property {World} world
 * @property {number} size_px
 * @property {{current: Drawn | null}} moved where a turtle is dragged to
 * @property {Signal<boolean>} isPlacing
 * @property {(name: string) => void} choose
 * @property {(at: Point) => void} place
 * @property {(turtle: Drawn) => void} dragged
 */

/** @param {Handled} handled what a pointer does: it chooses, drags, or puts a turtle down */
function useHands({ world, size_px, moved, isPlacing, choose, place, dragged }) {
  const held = useRef(/** @type {{turtle: OnField, x: number, y: number} | null} */ (null));
  const at = (/** @type {any} */ event) => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    return placeAt({ x: event.clientX - left, y: event.clientY - top }, size_px);
  };
  const letGo = () => {
    const turtle = moved.current;
    held.current = moved.current = null;
    world.isStale = true;
    return turtle;
  };
  return {
    onPointerDown(/** @type {any} */ event) {
      if (event.button !== 0) return;
      if (isPlacing.peek()) return place(at(event));
      const turtle = turtleAt(
        [...world.turtles.values()].filter(({ isHere }) => isHere),
        at(event),
      );
      if (!turtle) return undefined;
      choose(turtle.name);
      if (!mayAct.peek()) return undefined;
      held.current = { turtle, x: event.clientX, y: event.clientY };
      event.currentTarget.setPointerCapture(event.pointerId);
      return undefined;
    },
    onPointerMove(/** @type {any} */ event) {
      const { current } = held;
      if (!current) return;
      const gone_px = Math.hypot(event.clientX - current.x, event.clientY - current.y);
      if (!moved.current && gone_px < DRAGGED_PX) return;
      moved.current = { ...current.turtle, ...at(event) };
      world.isStale = true;
    },
    onPointerUp() {
      const turtle = letGo();
      if (turtle) dragged(turtle);
    },
    onPointerCancel: letGo,
  };
}
