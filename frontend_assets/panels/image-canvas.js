/** A picture that can be moved and looked at closely, down to each pixel. */

/** @import { Picture } from "../lib/image-pixels.js" */
/** @import { Size, View } from "../lib/pan-zoom.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { pixelAt } from "../lib/image-pixels.js";
import { CLOSEST, filling, pixelUnder } from "../lib/image-view.js";
import { formatNumber } from "../lib/numbers.js";
import { zoomed } from "../lib/pan-zoom.js";
import { IconButton } from "../lib/ui.js";

const STEP = 1.5;
const WHEEL = 0.002;

/** @typedef {{x: number, y: number}} Point px, in the frame */

/** @param {{picture: Picture, label: string, pointed: Signal<string>}} props `pointed`: what is said of the pixel under the pointer */
export function ImageCanvas({ picture, label, pointed }) {
  const frame = useRef(/** @type {HTMLElement | null} */ (null));
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const size = useSize(frame);
  /** As a person moved it; null: all of it is seen. */
  const moved = useSignal(/** @type {View | null} */ (null));
  const pointer = useSignal(/** @type {Point | null} */ (null));
  const view = moved.value ?? filling(picture, size);
  useLayoutEffect(() => draw(canvas.current, picture), [picture]);
  useEffect(() => {
    pointed.value = pointer.value ? pixelWords(picture, pixelUnder(view, pointer.value)) : "";
  }, [picture, pointer.value, moved.value]);
  const zoom = (/** @type {number} */ factor, at = { x: size.width / 2, y: size.height / 2 }) => {
    moved.value = zoomed(moved.value ?? filling(picture, size), factor, at, CLOSEST);
  };
  const latestZoom = useRef(zoom);
  latestZoom.current = zoom;
  useWheel(frame, latestZoom);
  const onPointerMove = (/** @type {PointerEvent} */ event) => {
    pointer.value = pointOf(frame.current, event);
    if ((event.buttons & 1) === 0) return;
    moved.value = { ...view, x: view.x + event.movementX, y: view.y + event.movementY };
  };
  const style = `transform: translate(${view.x}px, ${view.y}px) scale(${view.scale})`;
  return html`<div class="image-place">
    <div ref=${frame} class="image-frame" onPointerMove=${onPointerMove} onPointerDown=${capture} onPointerLeave=${() => {
      pointer.value = null;
    }}><canvas ref=${canvas} role="img" aria-label=${label} style=${style}></canvas></div>
    <div class="image-tools"><${IconButton} icon="plus" label=${t("image.closer")} onClick=${() => zoom(STEP)} />
      <${IconButton} icon="minus" label=${t("image.farther")} onClick=${() => zoom(1 / STEP)} />
      <${IconButton} icon="fit" label=${t("image.fit")} pressed=${moved.value === null} onClick=${() => {
        moved.value = null;
      }} /></div>
  </div>`;
}

/** @param {HTMLCanvasElement | null} canvas @param {Picture} picture */
function draw(canvas, { width, height, rgba }) {
  if (!canvas) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  canvas.getContext("2d")?.putImageData(new ImageData(rgba, width, height), 0, 0);
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

/** @param {Picture} picture @param {Point} pixel @returns {string} empty: no pixel is there */
function pixelWords(picture, { x, y }) {
  const numbers = pixelAt(picture, x, y);
  if (numbers.length === 0) return "";
  const place = `${x}, ${y}`;
  if (numbers.some(Number.isNaN)) return t("image.pixel.none", { place });
  const value = numbers.map((one) => formatNumber(one, 6)).join(" ");
  return t("image.pixel", { place, value: picture.unit ? `${value} ${picture.unit}` : value });
}
