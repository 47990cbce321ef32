/**
 * Interactive markers in the 3D view: what can be done with them, and doing it. A drag goes out as
 * press, moves and release, in this order; of moves that wait the newest counts.
 */

/** @import { InteractiveMarkers, InteractWithMarker, MarkerView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Asked } from "./wire.js" */
/** @import { Studio3d } from "./viewport.js" */

import { effect, signal } from "vendor/preact.js";
import { createDragSender } from "../lib/drag-sender.js";
import { t } from "../lib/i18n.js";
import { mayAct } from "./connection.js";
import { ask } from "./requests.js";
import { notify } from "./view.js";
import { subscribe } from "./wire.js";

/** @typedef {Omit<Asked<InteractWithMarker>, "type">} Interaction */
/** @typedef {{display: string, marker: number, control: number | null}} Target */
/** Where a menu is wanted, px of the page. @typedef {Target & {mouse_point: [number, number, number] | null, x: number, y: number}} AskedMenu */

/** @type {Signal<InteractiveMarkers>} */
const state = signal({ type: "interactive_markers", displays: [] });
/** What the mouse is over. @type {Signal<{marker: MarkerView, mode: number, description: string} | null>} */
export const pointedMarker = signal(null);
/** The menu that was asked for last. @type {Signal<AskedMenu | null>} */
export const askedMenu = signal(null);

subscribe("interactive_markers", (event) => {
  state.value = event;
});

/** @param {Target} target @returns {MarkerView | undefined} */
const markerOf = ({ display, marker }) =>
  state.value.displays
    .find((one) => one.display === display)
    ?.markers.find((one) => one.number === marker);

/** @param {Studio3d} view @param {AbortSignal} signal ends it @returns {(() => void)[]} the ends of all that keeps it informed */
export function attachMarkers(view, signal) {
  /** @param {string} type @param {(detail: any) => void} take */
  const on = (type, take) =>
    view.events.addEventListener(type, (event) => take(/** @type {CustomEvent} */ (event).detail), {
      signal,
    });
  const sender = createDragSender(
    (/** @type {Interaction} */ command) => ask({ type: "interact_with_marker", ...command }),
    ({ display, marker }) => view.dropMarker(display, marker),
    ({ display, marker }) => view.settleMarker(display, marker),
  );
  on("marker", (command) => sender.push(command));
  on("marker_menu", (asked) => {
    askedMenu.value = asked;
  });
  on("marker_hover", point);
  view.events.addEventListener("key", (event) => takeKey(view, event), { signal });
  on("marker_denied", () => notify(t("markers.denied"), { bad: true }));
  return [
    effect(() => view.setMarkers(state.value.displays)),
    effect(() => view.setMayMoveMarkers(mayAct.value)),
    () => sender.end(),
  ];
}

/** The menu of what the mouse is over, by the keys that open menus. @param {Studio3d} view @param {Event} event */
function takeKey(view, event) {
  const { key, shiftKey } = /** @type {CustomEvent} */ (event).detail;
  const isMenu = key === "ContextMenu" || (key === "F10" && shiftKey);
  if (isMenu && view.openMarkerMenu()) event.preventDefault();
}

/** @param {{display: string, marker: number | null, control: number | null}} over */
function point({ display, marker: number, control }) {
  const marker = number === null ? undefined : markerOf({ display, marker: number, control });
  const found = marker?.controls.find((one) => one.number === control);
  pointedMarker.value = marker
    ? { marker, mode: found?.mode ?? 0, description: found?.description ?? "" }
    : null;
}

/** @param {AskedMenu} asked @returns {MarkerView | undefined} the marker whose menu is meant, if it has one */
export function markerWithMenu(asked) {
  const marker = markerOf(asked);
  return marker && marker.menu.length > 0 ? marker : undefined;
}

/** @param {AskedMenu} asked @param {number} entry */
export function selectEntry({ display, marker, control, mouse_point: point }, entry) {
  const command = { display, marker, control, mouse_point: point, action: "select", entry };
  ask({ type: "interact_with_marker", .../** @type {Interaction} */ (command) });
}
