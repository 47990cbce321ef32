/** A picture that can be moved and looked at closely, down to each pixel; the worker paints it. */

/** @import { Size, View } from "../lib/pan-zoom.js" */
/** @import { PictureAsked } from "../workers/pictures.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { CLOSEST, FARTHEST, filling, pixelUnder, ratioFor } from "../lib/image-view.js";
import { zoomed } from "../lib/pan-zoom.js";
import { IconButton } from "../lib/ui.js";

const STEP = 1.5;
const WHEEL = 0.002;
const MOVE_PX = 40;
/** Where a key looks: the picture moves the other way. @type {Record<string, Point>} */
const MOVES = {
  ArrowLeft: { x: MOVE_PX, y: 0 },
  ArrowRight: { x: -MOVE_PX, y: 0 },
  ArrowUp: { x: 0, y: MOVE_PX },
  ArrowDown: { x: 0, y: -MOVE_PX },
};
/** @type {Record<string, number>} */
const ZOOMS = { "+": STEP, "-": 1 / STEP };

/** @typedef {{x: number, y: number}} Point px, in the frame */
/** @typedef {{canvas: {current: HTMLCanvasElement | null}, size: Size | null, label: string, ask: (asked: PictureAsked) => void}} Props `size` of the picture; null: there is none */

/** @param {Props} props */
export function ImageCanvas({ canvas, size, label, ask }) {
  const frame = useRef(/** @type {HTMLElement | null} */ (null));
  const room = useSize(frame);
  /** As a person moved it; null: all of it is seen. */
  const moved = useSignal(/** @type {View | null} */ (null));
  const pointer = useSignal(/** @type {Point | null} */ (null));
  const shown = size ?? { width: 0, height: 0 };
  const view = moved.value ?? filling(shown, room);
  usePainted(ask, room, moved.value);
  usePointed(ask, view, pointer.value);
  const zoom = (/** @type {number} */ factor, at = { x: room.width / 2, y: room.height / 2 }) => {
    moved.value = zoomed(view, factor, at, CLOSEST, FARTHEST);
  };
  const move = (/** @type {Point} */ by) => {
    moved.value = { ...view, x: view.x + by.x, y: view.y + by.y };
  };
  const latestZoom = useRef(zoom);
  latestZoom.current = zoom;
  useWheel(frame, latestZoom);
  const onPointerMove = (/** @type {PointerEvent} */ event) => {
    pointer.value = pointOf(frame.current, event);
    if ((event.buttons & 1) === 0) return;
    move({ x: event.movementX, y: event.movementY });
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    const [by, factor] = [MOVES[event.key], ZOOMS[event.key]];
    if (event.ctrlKey || event.metaKey || event.altKey || !(by || factor)) return;
    event.preventDefault();
    if (by) move(by);
    else zoom(factor ?? 1);
  };
  return html`<div class="image-place" hidden=${size === null}>
    <div ref=${frame} class="image-frame" onPointerMove=${onPointerMove} onPointerDown=${capture} onPointerLeave=${() => {
      pointer.value = null;
    }}><div class="image-sheet" style=${placeOf(view, shown)}></div><canvas ref=${canvas} role="img" aria-label=${label} tabindex="0" onKeyDown=${onKeyDown}></canvas></div>
    <div class="image-tools"><${IconButton} icon="plus" label=${t("image.closer")} onClick=${() => zoom(STEP)} />
      <${IconButton} icon="minus" label=${t("image.farther")} onClick=${() => zoom(1 / STEP)} />
      <${IconButton} icon="fit" label=${t("image.fit")} pressed=${moved.value === null} onClick=${() => {
        moved.value = null;
      }} /></div>
  </div>`;
}

/** @param {View} view @param {Size} size @returns {string} where the picture lies */
function placeOf({ x, y, scale }, { width, height }) {
  return `translate: ${x}px ${y}px; width: ${width * scale}px; height: ${height * scale}px`;
}

/** Have what is seen painted. @param {Props["ask"]} ask @param {Size} room @param {View | null} view */
function usePainted(ask, { width, height }, view) {
  useEffect(() => {
    const ratio = ratioFor({ width, height }, devicePixelRatio);
    const pixels = { width: Math.round(width * ratio), height: Math.round(height * ratio) };
    ask({ kind: "sight", sight: { ...pixels, ratio, view } });
  }, [width, height, view]);
}

/** Ask for the pixel under the pointer. @param {Props["ask"]} ask @param {View} view @param {Point | null} point */
function usePointed(ask, view, point) {
  const pixel = point && pixelUnder(view, point);
  useEffect(() => ask({ kind: "point", pixel }), [pixel?.x, pixel?.y]);
}

/** @param {{current: Element | null}} element @returns {Size} */
function useSize(element) {
  const size = useSignal(/** @type {Size} */ ({ width: 0, height: 0 }));
  useLayoutEffect(() => {
    const watcher = new ResizeObserver(([entry]) => {
      if (entry) size.value = entry.contentRect;
    });
    if (element.current) watcher.observe(element.current);
    return () => watcher.disconnect();
  }, []);
  return size.value;
}

/** @param {{current: HTMLElement | null}} frame @param {{current: (factor: number, at: Point) => void}} zoom */
function useWheel(frame, zoom) {
  useEffect(() => {
    const onWheel = (/** @type {WheelEvent} */ event) => {
      event.preventDefault();
      zoom.current(Math.exp(-event.deltaY * WHEEL), pointOf(frame.current, event));
    };
    const element = frame.current;
    // One that says beforehand that it stops the page from rolling.
    element?.addEventListener("wheel", onWheel, { passive: false });
    return () => element?.removeEventListener("wheel", onWheel);
  }, []);
}

/** @param {PointerEvent} event */
function capture(event) {
  if (event.button === 0)
    /** @type {Element} */ (event.currentTarget).setPointerCapture(event.pointerId);
}

/** @param {Element | null} element @param {MouseEvent} event @returns {Point} */
function pointOf(element, { clientX, clientY }) {
  const place = element?.getBoundingClientRect();
  return { x: clientX - (place?.left ?? 0), y: clientY - (place?.top ?? 0) };
}
