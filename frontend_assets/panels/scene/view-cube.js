/** The cube in the corner of the 3D view: it shows from where we look, and goes there. */

/** @import { Turn, Triple } from "../../lib/view-poses.js" */

import { html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { cellsOf, cubeTransform, FACES, nearestSide, stepped } from "../../lib/view-cube.js";
import { viewport } from "../../model/viewport.js";
import { seeFrom, showsCube, turnBy } from "../../model/views.js";

/** A press that moves less is a click, px. */
const STILL_PX = 3;
/** The cube is small: a drag across it turns by more than one across the picture. */
const GAIN = 2;

export function ViewCube() {
  const view = viewport.value;
  const group = useRef(/** @type {HTMLElement | null} */ (null));
  const box = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => (view ? keepTurned(view, box, group) : undefined), [view, showsCube.value]);
  if (!view || !showsCube.value) return null;
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const to = stepped(view.getTurn(), event.key);
    if (!to) return;
    event.preventDefault();
    event.stopPropagation();
    seeFrom(to);
  };
  return html`<div class="view-cube" ref=${group} role="group" tabindex="0" aria-label=${t("cube")} title=${t("cube.hint")}
    onKeyDown=${onKeyDown} onPointerDown=${startDrag}>
    <div class="view-cube-box" ref=${box}>${FACES.map((face) => html`<${Face} key=${face.name} face=${face} />`)}</div>
  </div>`;
}

/** @param {{face: import("../../lib/view-cube.js").Face}} props */
function Face({ face }) {
  return html`<div class=${`view-cube-face ${face.name}`} style=${`transform:${face.transform}`}>
    ${cellsOf(face).map(
      ({
        direction,
        isMiddle,
      }) => html`<button key=${direction.join()} type="button" tabindex="-1" data-to=${direction.join()}
        aria-label=${isMiddle ? t(`view.${face.name}`) : null} aria-hidden=${isMiddle ? null : "true"}
        onPointerEnter=${mark} onPointerLeave=${unmark} onClick=${go}>${isMiddle ? t(`view.${face.name}`) : ""}</button>`,
    )}</div>`;
}

/** @param {import("../../model/viewport.js").Studio3d} view @param {{current: HTMLElement | null}} box
 * @param {{current: HTMLElement | null}} group @returns {() => void} */
function keepTurned(view, box, group) {
  const show = (/** @type {Turn} */ now) => {
    if (box.current) box.current.style.transform = cubeTransform(now);
    const side = nearestSide(now);
    const words = t("cube.from", { side: t(`view.${side}`) });
    if (group.current && group.current.getAttribute("aria-label") !== words)
      group.current.setAttribute("aria-label", words);
  };
  const onTurned = (/** @type {Event} */ event) =>
    show(/** @type {CustomEvent} */ (event).detail.turn);
  view.events.addEventListener("turned", onTurned);
  show(view.getTurn());
  return () => view.events.removeEventListener("turned", onTurned);
}

/** An edge or a corner is marked on all faces that it belongs to. @param {PointerEvent} event @param {boolean} [on] */
function mark({ currentTarget }, on = true) {
  const cell = /** @type {HTMLElement} */ (currentTarget);
  const same = cell.closest(".view-cube")?.querySelectorAll(`[data-to="${cell.dataset.to}"]`);
  for (const one of same ?? []) one.classList.toggle("marked", on);
}

/** @param {PointerEvent} event */
const unmark = (event) => mark(event, false);

/** @param {MouseEvent} event */
function go({ currentTarget }) {
  const to = /** @type {HTMLElement} */ (currentTarget).dataset.to?.split(",").map(Number);
  if (to) seeFrom(/** @type {Triple} */ (/** @type {unknown} */ (to)));
}

/** A drag turns the view; what was a drag is no click. @param {PointerEvent} event */
function startDrag(event) {
  if (event.button !== 0) return;
  const cube = /** @type {HTMLElement} */ (event.currentTarget);
  const stop = new AbortController();
  let [x, y] = [event.clientX, event.clientY];
  let isDrag = false;
  const move = (/** @type {PointerEvent} */ now) => {
    if (now.pointerId !== event.pointerId) return;
    if (!isDrag && Math.hypot(now.clientX - x, now.clientY - y) < STILL_PX) return;
    isDrag = true;
    cube.setPointerCapture(now.pointerId);
    turnBy(GAIN * (now.clientX - x), GAIN * (now.clientY - y));
    [x, y] = [now.clientX, now.clientY];
  };
  const end = () => {
    stop.abort();
    if (isDrag) swallowClick(cube);
  };
  cube.addEventListener("pointermove", move, { signal: stop.signal });
  for (const type of ["pointerup", "pointercancel"])
    addEventListener(type, end, { signal: stop.signal });
}

/** @param {HTMLElement} cube */
function swallowClick(cube) {
  const stop = new AbortController();
  cube.addEventListener("click", (click) => click.stopPropagation(), {
    capture: true,
    signal: stop.signal,
  });
  setTimeout(() => stop.abort());
}
