/**
 * Rows of displays and groups dragged to another place: by the mouse anywhere, by a finger or a pen
 * at their icon, for elsewhere it scrolls.
 */

/** @import { Drop } from "../../lib/display-groups.js" */

import { signal } from "vendor/preact.js";
import { dropOn } from "../../lib/display-groups.js";
import { liveDisplays, moveLive } from "../../model/live-displays.js";

/** Id of the row that is dragged; empty: none. */
const dragged = signal("");
/** Where it would be dropped now. @type {import("vendor/preact.js").Signal<{row: string, where: Drop["where"]} | null>} */
const goal = signal(null);

/** Of rows on which a display can be dropped. */
const DROP_ROWS = "[data-drop]";
/** So near to an end of the list it scrolls while something is dragged over it. */
const EDGE_PX = 24;

/** @param {string} row @returns {string} a class that marks where it would come to stand */
export function dropMark(row) {
  if (dragged.value === row) return "dragged";
  return goal.value?.row === row ? `drop-${goal.value.where}` : "";
}

/** @param {string} row its id; it can be dragged, and be dropped on @returns {Record<string, unknown>} attributes of its element */
export const draggable = (row) => ({
  draggable: true,
  onDragStart: (/** @type {DragEvent} */ event) => {
    dragged.value = row;
    event.dataTransfer?.setData("text/plain", "");
    if (event.dataTransfer) event.dataTransfer.effectAllowed = "move";
  },
  onDragEnd: end,
  onPointerDown: (/** @type {PointerEvent} */ event) => dragByFinger(event, row),
  ...droppable(row),
});

/** @param {string} row @returns {Record<string, unknown>} */
export const droppable = (row) => ({
  "data-drop": row,
  onDragOver: (/** @type {DragEvent} */ event) => {
    const element = /** @type {HTMLElement} */ (event.currentTarget);
    if (hold(element, row, event.clientY)) event.preventDefault();
  },
  onDragLeave: () => {
    if (goal.peek()?.row === row) goal.value = null;
  },
  onDrop: (/** @type {DragEvent} */ event) => {
    const drop = dropAt(/** @type {HTMLElement} */ (event.currentTarget), row, event.clientY);
    if (!drop) return;
    event.preventDefault();
    event.stopPropagation();
    end();
    moveLive(drop.move);
  },
});

/** @param {HTMLElement} element of a row @param {string} row @param {number} y px @returns {Drop | null} marks where it would be dropped */
function hold(element, row, y) {
  const drop = dropAt(element, row, y);
  const where = drop?.where ?? null;
  if (goal.peek()?.row !== row || goal.peek()?.where !== where)
    goal.value = where && { row, where };
  return drop;
}

/** @param {HTMLElement} element @param {string} row @param {number} y px @returns {Drop | null} null: nothing of ours is dragged, or it cannot go there */
function dropAt(element, row, y) {
  if (dragged.peek() === "") return null;
  const { top, height } = element.getBoundingClientRect();
  return dropOn(liveDisplays.peek(), dragged.peek(), row, (y - top) / height);
}

function end() {
  dragged.value = "";
  goal.value = null;
}

/** @param {PointerEvent} event @param {string} row */
function dragByFinger(event, row) {
  const grip = event.target instanceof Element ? event.target.closest(".icon") : null;
  if (event.pointerType === "mouse" || !event.isPrimary || !grip?.parentElement?.matches(DROP_ROWS))
    return;
  // A long press on what is draggable would begin the browser's own drag, and its menu.
  event.preventDefault();
  const stop = new AbortController();
  const { signal: until } = stop;
  const begun = { x: event.clientX, y: event.clientY };
  const list = grip.closest(".tree");
  addEventListener(
    "pointermove",
    ({ clientX, clientY }) => {
      if (dragged.peek() === "" && Math.hypot(clientX - begun.x, clientY - begun.y) < 4) return;
      dragged.value = row;
      scrollAtEdge(list, clientY);
      holdAt(clientX, clientY);
    },
    { signal: until },
  );
  const finish = (/** @type {PointerEvent} */ { type, clientX, clientY }) => {
    stop.abort();
    const move = type === "pointerup" ? holdAt(clientX, clientY)?.move : null;
    end();
    if (move) moveLive(move);
  };
  addEventListener("pointerup", finish, { signal: until });
  addEventListener("pointercancel", finish, { signal: until });
}

/** @param {number} x px @param {number} y px @returns {Drop | null} */
function holdAt(x, y) {
  const under = document.elementFromPoint(x, y)?.closest(DROP_ROWS);
  const row = under?.getAttribute("data-drop") ?? "";
  if (under instanceof HTMLElement) return hold(under, row, y);
  goal.value = null;
  return null;
}

/** @param {Element | null} list @param {number} y px */
function scrollAtEdge(list, y) {
  if (!list) return;
  const { top, bottom } = list.getBoundingClientRect();
  if (y < top + EDGE_PX) list.scrollTop -= EDGE_PX / 2;
  else if (y > bottom - EDGE_PX) list.scrollTop += EDGE_PX / 2;
}
