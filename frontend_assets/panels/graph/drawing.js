/** The boxes and arrows of the node graph, which can be moved, scaled and chosen. */

/** @import { TopicRate } from "../../types/wire.d.ts" */
/** @import { Arrow, Box } from "./nodes.js" */
/** @import { Layout, Point } from "./layout.js" */
/** @import { View } from "../../lib/pan-zoom.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { ddsMark } from "../../lib/dds-tag.js";
import { t } from "../../lib/i18n.js";
import { clamp } from "../../lib/numbers.js";
import { fitted, resized, zoomed } from "../../lib/pan-zoom.js";
import { IconButton } from "../../lib/ui.js";
import { BOX_HEIGHT_PX, boxLabel, boxWidth, boxWords, layOut } from "./layout.js";

const STEP = 1.25;
const WHEEL = 0.0016;
/** Of more arrows only those of what is chosen say what they carry. */
const SAID_MAX = 40;
/** Of what stands below a box. */
const MARK_LETTER_PX = 6.4;
/** Of most frames, until it is seen. */
const RATIO = 1.5;

/** @typedef {{boxes: readonly Box[], arrows: readonly Arrow[]}} Drawn */
/** @typedef {{drawn: Drawn, asked: string, rates: ReadonlyMap<string, TopicRate>, chosen: Signal<string>, onFocus: (box: Box) => void}} Props `asked`: what is to be seen, by the person's choice */

/** @param {Props} props */
export function GraphDrawing({ drawn, asked, rates, chosen, onFocus }) {
  const frame = useRef(/** @type {SVGSVGElement | null} */ (null));
  const view = useSignal(/** @type {View} */ ({ x: 0, y: 0, scale: 1 }));
  const shape = `${drawn.boxes.map(({ id }) => id).join(" ")}|${drawn.arrows.map(({ id }) => id).join(" ")}`;
  const ratio = useSignal(RATIO);
  const layout = useMemo(() => layOutDrawn(drawn, ratio.value), [shape, ratio.value]);
  const { fit, move } = useFit(frame, view, ratio, layout, asked);
  useWheel(frame, move);
  const drag = useDrag(move);
  const { x, y, scale } = view.value;
  return html`<div class="graph-place">
    <svg ref=${frame} class="graph-drawing" role="group" aria-label=${t("graph.drawing")} ...${drag}>
      <defs><marker id="graph-tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse"><path d="M0 0.8 L8 4 L0 7.2 z" /></marker></defs>
      <g transform=${`translate(${x} ${y}) scale(${scale})`}>
        ${drawn.arrows.map((arrow) => html`<${ArrowLine} key=${arrow.id} arrow=${arrow} layout=${layout} rates=${rates} chosen=${chosen} crowded=${drawn.arrows.length > SAID_MAX} />`)}
        ${drawn.boxes.map((box) => html`<${BoxShape} key=${box.id} box=${box} at=${layout.boxes.get(box.id)} rates=${rates} chosen=${chosen} onFocus=${onFocus} />`)}
      </g>
    </svg>
    <div class="graph-tools"><${IconButton} icon="plus" label=${t("graph.closer")} onClick=${() => step(move, frame.current, STEP)} />
      <${IconButton} icon="minus" label=${t("graph.farther")} onClick=${() => step(move, frame.current, 1 / STEP)} />
      <${IconButton} icon="fit" label=${t("graph.fit")} onClick=${fit} /></div>
  </div>`;
}

/** @param {Drawn} drawn @param {number} ratio of width and height @returns {Layout} */
function layOutDrawn({ boxes, arrows }, ratio) {
  const sized = boxes.map((box) => ({
    id: box.id,
    width: Math.max(boxWidth(box), [...markOf(box)].length * MARK_LETTER_PX),
    height: BOX_HEIGHT_PX,
  }));
  return layOut(sized, arrows, ratio);
}

/** @param {Box} box @returns {string} what stands below a node on DDS, beside the next one's */
const markOf = ({ bridge }) => (bridge ? ddsMark(bridge) : "");

/** @typedef {(change: (view: View) => View) => void} Move by a hand */

/**
 * Keep all in sight while the drawing or its frame changes, until a hand moves it: then what the hand
 * chose is kept in sight. What is asked for anew is seen whole again.
 *
 * @param {{current: Element | null}} frame @param {Signal<View>} view @param {Signal<number>} ratio of the frame, in steps
 * @param {Layout} layout @param {string} asked
 * @returns {{fit: () => void, move: Move}}
 */
function useFit(frame, view, ratio, layout, asked) {
  const isHeld = useRef(false);
  const size = useRef({ width: 0, height: 0 });
  const fit = () => {
    isHeld.current = false;
    const place = frame.current?.getBoundingClientRect();
    if (place && place.width > 0) view.value = fitted(layout, place, busiest(layout));
  };
  const follow = () => {
    const { width = 0, height = 0 } = frame.current?.getBoundingClientRect() ?? {};
    if (width <= 0 || height <= 0) return;
    const before = size.current;
    size.current = { width, height };
    ratio.value = clamp(Math.round((width / height) * 2) / 2, 0.5, 4);
    if (!isHeld.current) fit();
    else if (before.width > 0) view.value = resized(view.value, before, size.current);
  };
  useEffect(fit, [asked]);
  useEffect(() => {
    follow();
    // Its panel may be behind another one at first, where it has no size.
    const watcher = new ResizeObserver(follow);
    if (frame.current) watcher.observe(frame.current);
    return () => watcher.disconnect();
  }, [layout]);
  return {
    fit,
    move: (change) => {
      isHeld.current = true;
      view.value = change(view.value);
    },
  };
}

/** @param {Layout} layout @returns {Point | undefined} the box at which most arrows meet */
function busiest({ boxes, arrows }) {
  const ends = [...arrows.values()].flatMap((way) => [way[0], way.at(-1)]);
  const count = (/** @type {Point} */ box) =>
    ends.filter((end) => end?.x === box.x && end.y === box.y).length;
  const counted = [...boxes.values()].map((box) => ({ box, count: count(box) }));
  return counted.sort((a, b) => b.count - a.count)[0]?.box;
}

/** @param {Move} move @param {Element | null} frame @param {number} factor about its middle */
function step(move, frame, factor) {
  const place = frame?.getBoundingClientRect();
  if (place) move((view) => zoomed(view, factor, { x: place.width / 2, y: place.height / 2 }));
}

/** @param {{current: Element | null}} frame @param {Move} move */
function useWheel(frame, move) {
  useEffect(() => {
    const element = frame.current;
    if (!element) return undefined;
    const onWheel = (/** @type {Event} */ event) => {
      const { deltaY, clientX, clientY } = /** @type {WheelEvent} */ (event);
      event.preventDefault();
      const { left, top } = element.getBoundingClientRect();
      const at = { x: clientX - left, y: clientY - top };
      move((view) => zoomed(view, Math.exp(-deltaY * WHEEL), at));
    };
    element.addEventListener("wheel", onWheel, { passive: false });
    return () => element.removeEventListener("wheel", onWheel);
  }, []);
}

/** @param {Move} move @returns {Record<string, (event: PointerEvent) => void>} what moves the drawing with the pointer, unless a box is under it */
function useDrag(move) {
  const from = useRef(/** @type {{x: number, y: number} | null} */ (null));
  return {
    onPointerDown: (event) => {
      const element = /** @type {Element} */ (event.target);
      if (event.button !== 0 || element.closest(".graph-box")) return;
      from.current = { x: event.clientX, y: event.clientY };
      /** @type {Element} */ (event.currentTarget).setPointerCapture(event.pointerId);
    },
    onPointerMove: (event) => {
      if (!from.current) return;
      const [right, down] = [event.clientX - from.current.x, event.clientY - from.current.y];
      move(({ x, y, scale }) => ({ x: x + right, y: y + down, scale }));
      from.current = { x: event.clientX, y: event.clientY };
    },
    onPointerUp: () => {
      from.current = null;
    },
    onPointerCancel: () => {
      from.current = null;
    },
  };
}

/** @param {{box: Box, at: Point | undefined, rates: ReadonlyMap<string, TopicRate>, chosen: Signal<string>, onFocus: (box: Box) => void}} props */
function BoxShape({ box, at, rates, chosen, onFocus }) {
  if (!at) return null;
  const width = boxWidth(box);
  const isChosen = chosen.value === box.id;
  const rate = box.kind === "topic" ? rateWords(rates.get(box.name)) : "";
  const below = markOf(box) || rate;
  const behind = box.bridge ? t("ros.behind", { name: box.bridge }) : "";
  const choose = () => {
    chosen.value = isChosen ? "" : box.id;
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    choose();
  };
  const names = [
    box.kind,
    box.kind === "node" && box.count > 1 && "doubled",
    isChosen && "chosen",
  ].filter(Boolean);
  return html`<g class=${`graph-box ${names.join(" ")}`} role="button" tabindex="0" aria-pressed=${isChosen} aria-label=${[t(`graph.kind.${box.kind}`), box.name, below].filter(Boolean).join(" ")}
    transform=${`translate(${at.x - width / 2} ${at.y - BOX_HEIGHT_PX / 2})`} onClick=${choose} onDblClick=${() => onFocus(box)} onKeyDown=${onKeyDown}>
    <title>${[box.name, behind].filter(Boolean).join("\n")}</title>
    <rect width=${width} height=${BOX_HEIGHT_PX} rx=${box.id.startsWith("node:") ? 6 : BOX_HEIGHT_PX / 2} />
    <text x=${width / 2} y=${BOX_HEIGHT_PX / 2} dy="0.35em">${boxLabel(box)}</text>
    ${below && html`${" "}<text class="graph-rate" x=${width / 2 + 6} y=${BOX_HEIGHT_PX + 11}>${below}</text>`}
  </g>`;
}

/** @param {{arrow: Arrow, layout: Layout, rates: ReadonlyMap<string, TopicRate>, chosen: Signal<string>, crowded: boolean}} props */
function ArrowLine({ arrow, layout, rates, chosen, crowded }) {
  const way = layout.arrows.get(arrow.id);
  const [first, last] = [way?.[0], way?.at(-1)];
  if (!way || !first || !last) return null;
  const isNear = chosen.value === arrow.from || chosen.value === arrow.to;
  const middle = way[Math.floor(way.length / 2)] ?? last;
  const before = way[Math.floor(way.length / 2) - 1] ?? first;
  const isSaid = isNear || !crowded;
  const isBetweenNodes = isSaid && arrow.from.startsWith("node:") && arrow.to.startsWith("node:");
  return html`<g class=${`graph-arrow ${isNear ? "chosen" : ""}`}><path d=${pathOf(way)} marker-end="url(#graph-tip)" />
    ${isBetweenNodes && html`<text x=${(before.x + middle.x) / 2 + 6} y=${(before.y + middle.y) / 2} dy="0.35em">${arrowWords(arrow, rates)}</text>`}</g>`;
}

/** @param {Arrow} arrow @param {ReadonlyMap<string, TopicRate>} rates @returns {string} */
function arrowWords({ names }, rates) {
  const [name] = names;
  if (names.length > 1 || name === undefined) return t("graph.topics", { count: names.length });
  return [boxWords(name), rateWords(rates.get(name))].filter(Boolean).join(" · ");
}

/** @param {TopicRate | undefined} rate @returns {string} */
function rateWords(rate) {
  if (!rate || rate.state === "waiting") return "";
  if (rate.state === "silent") return t("graph.silent");
  if (rate.state === "latched") return "";
  return t("graph.rate", {
    rate: rate.rate_hz >= 10 ? Math.round(rate.rate_hz) : rate.rate_hz.toFixed(1),
  });
}

/** @param {readonly Point[]} way from box to box @returns {string} a line that leaves and enters upright */
function pathOf(way) {
  const [first, last] = [/** @type {Point} */ (way[0]), /** @type {Point} */ (way.at(-1))];
  const half = BOX_HEIGHT_PX / 2;
  const points = way.map((point) => ({ ...point }));
  const down = Math.sign((way[1] ?? last).y - first.y) || 1;
  points[0] = { x: first.x, y: first.y + down * half };
  points[points.length - 1] = { x: last.x, y: last.y - down * half };
  return points
    .map(({ x, y }, at) => {
      const before = points[at - 1];
      if (!before) return `M${x} ${y}`;
      const middle = (before.y + y) / 2;
      return `C${before.x} ${middle} ${x} ${middle} ${x} ${y}`;
    })
    .join(" ");
}
