/** What a camera sees: the newest image of a topic, its numbers, and a copy of it. */

/** @import { Numbers, Range } from "../../lib/image-encodings.js" */
/** @import { SubscriptionView } from "../../workers/subscriptions.js" */
/** @import { PictureAsked, Pictured } from "../../workers/pictures.js" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Size, View } from "../../lib/pan-zoom.js" */
/** @import { Chosen } from "../topic-panel.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { saveAsFile } from "../../lib/files.js";
import { t } from "../../lib/i18n.js";
import { CLOSEST, FARTHEST, filling, pixelUnder, ratioFor } from "../../lib/image-view.js";
import { allDigits, shownNumber } from "../../lib/numbers.js";
import { zoomed } from "../../lib/pan-zoom.js";
import { useSilence } from "../../lib/times.js";
import { IconButton, Switch } from "../../lib/ui.js";
import { laneOpen, watch } from "../../model/data-lane.js";
import { TopicPanel, whyNothing } from "../topic-panel.js";

const TYPES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"];

export function ImagePanel() {
  return html`<${TopicPanel} title=${t("panel.image")} icon="camera" name="image" types=${TYPES} label=${t("image.topic")}
    none=${t("image.none")} hint=${t("image.none.hint")} shown=${Watched} />`;
}

/** @typedef {(asked: PictureAsked) => void} Ask of the worker, which has the picture */

/** @param {Chosen} props a canvas is given away once: another topic has another one */
function Watched({ topic, type, menu }) {
  const subscription = useSignal(/** @type {SubscriptionView | null} */ (null));
  const pictured = useSignal(/** @type {Pictured | null} */ (null));
  const range = useSignal(/** @type {Range | null} */ (null));
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const watching = useRef(/** @type {ReturnType<typeof watch> | null} */ (null));
  const silence = useSilence();
  const ask = (/** @type {PictureAsked} */ asked) => watching.current?.ask(asked);
  useEffect(() => {
    if (!canvas.current) return;
    const given = canvas.current.transferControlToOffscreen();
    watching.current = watch(topic, { typeName: type }, given, {
      onState: (answer) => {
        subscription.value = answer;
      },
      onPicture: (answer) => {
        if (answer.painted !== pictured.value?.painted) silence.came();
        pictured.value = answer;
      },
      onSaved: (file) => saveAsFile(`${topic.slice(1).replaceAll("/", "_")}.png`, file, file.type),
    });
    return watching.current.leave;
  }, []);
  const size = pictured.value?.size ?? null;
  const isSilent = silence.silent_s > 0 && !subscription.value?.latched;
  const isStill = isSilent || subscription.value?.state !== "receiving" || !laneOpen.value;
  const numbers = pictured.value?.numbers;
  return html`<${Bar} menu=${menu} isThere=${size !== null} ask=${ask} />
    ${numbers && html`<${RangeRow} numbers=${numbers} range=${range} ask=${ask} />`}
    <${ImageCanvas} canvas=${canvas} size=${size} label=${t("image.of", { topic })} ask=${ask} />
    ${
      size && pictured.value
        ? html`<${Facts} pictured=${pictured.value} size=${size} isStill=${isStill} />`
        : html`<p class="image-said" role="status">${stateWords(subscription.value, pictured.value)}</p>`
    }`;
}

/** @param {{menu: Chosen["menu"], isThere: boolean, ask: Ask}} props */
function Bar({ menu, isThere, ask }) {
  return html`<div class="panel-bar image-bar">
    ${menu}
    <span class="push"></span>
    <${IconButton} icon="download" label=${t("image.save")} disabled=${!isThere} onClick=${() => ask({ kind: "save" })} />
  </div>`;
}

/** @param {{numbers: Numbers, range: Signal<Range | null>, ask: Ask}} props from which number on it is black, and from which on white; null: as the picture has it */
function RangeRow({ numbers, range, ask }) {
  const shown = range.value ?? numbers.range;
  const shade = (/** @type {Range | null} */ wished) => {
    range.value = wished;
    ask({ kind: "shade", range: wished });
  };
  const box = (
    /** @type {"low" | "high"} */ end,
  ) => html`<label class="image-end">${t(`image.${end}`)}
    <input type="number" step="any" class="box" value=${shownNumber(shown[end])} title=${allDigits(shown[end])} disabled=${range.value === null}
      onChange=${(/** @type {any} */ event) => shade({ ...shown, [end]: event.currentTarget.valueAsNumber || 0 })} /></label>`;
  return html`<div class="panel-bar image-range" role="group" aria-label=${t("image.range")}>
    <${Switch} label=${t("image.auto")} checked=${range.value === null} onChange=${(/** @type {boolean} */ isAuto) => shade(isAuto ? null : numbers.range)} /><span aria-hidden="true">${t("image.auto_short")}</span>
    ${box("low")}${box("high")}${numbers.unit && html`<span class="muted">${numbers.unit}</span>`}
  </div>`;
}

/** @param {{pictured: Pictured, size: {width: number, height: number}, isStill: boolean}} props */
function Facts({ pictured, size, isStill }) {
  const { encoding, rate_hz, bytes } = pictured;
  const words = [
    t("image.size", size),
    encoding,
    rate_hz === null || isStill ? "" : t("image.rate", { rate: rate_hz.toFixed(1) }),
    t("image.kilobytes", { count: Math.ceil(bytes / 1000) }),
    isStill ? t("image.still") : "",
  ];
  return html`<p class="image-facts"><span class="muted">${words.filter(Boolean).join(" · ")}</span><output>${pointedWords(pictured)}</output></p>`;
}

/** @param {Pictured} pictured @returns {string} empty: no pixel is pointed at */
function pointedWords({ pointed, numbers }) {
  if (!pointed) return "";
  const place = `${pointed.x}, ${pointed.y}`;
  if (pointed.values.some(Number.isNaN)) return t("image.pixel.none", { place });
  const value = pointed.values.map((one) => shownNumber(one)).join(" ");
  return t("image.pixel", { place, value: numbers?.unit ? `${value} ${numbers.unit}` : value });
}

/** @param {SubscriptionView | null} subscription @param {Pictured | null} pictured @returns {string} why there is no picture, and what to do */
function stateWords(subscription, pictured) {
  if (laneOpen.value && pictured?.trouble) return t(pictured.trouble.key, pictured.trouble.words);
  return whyNothing(subscription) || t("image.waiting");
}

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

/**
 * A picture that can be moved and looked at closely, down to each pixel; the worker paints it.
 *
 * @param {Props} props
 */
function ImageCanvas({ canvas, size, label, ask }) {
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
