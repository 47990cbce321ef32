/** Rows of live displays that are dragged to another place, into a group or out of it. */

/** @import { Drop } from "../lib/live-displays.js" */

import { signal } from "vendor/preact.js";
import { endDrag, takesDrop, dragged as topic } from "../app/topic-drag.js";
import { dropOn } from "../lib/live-displays.js";
import { mayEdit } from "../model/connection.js";
import { addDisplay, liveDisplays, placeDisplays } from "../model/live-displays.js";

/** Id of the row that is dragged; empty: none. */
const dragged = signal("");
/** Where it would be dropped now. @type {import("vendor/preact.js").Signal<{row: string, where: Drop["where"]} | null>} */
const goal = signal(null);

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
  ...droppable(row),
});

/** @param {string} row @returns {Record<string, unknown>} */
export const droppable = (row) => ({
  onDragOver: (/** @type {DragEvent} */ event) => {
    const drop = dropAt(event, row);
    const where = drop?.where ?? null;
    if (goal.peek()?.row !== row || goal.peek()?.where !== where)
      goal.value = where && { row, where };
    if (drop) event.preventDefault();
  },
  onDragLeave: () => {
    if (goal.peek()?.row === row) goal.value = null;
  },
  onDrop: (/** @type {DragEvent} */ event) => {
    const drop = dropAt(event, row);
    if (!drop) return;
    event.preventDefault();
    event.stopPropagation();
    end();
    placeDisplays(drop.moves);
  },
});

/** A topic of which there is a display may be dropped on the panel. @param {DragEvent} event */
export function takeTopic(event) {
  if (topic.peek()?.kind && mayEdit.peek()) takesDrop(event);
}

/** @param {DragEvent} event the display that shows the topic listens as the topic is published */
export function dropTopic(event) {
  const what = topic.peek();
  if (!what?.kind || !mayEdit.peek()) return;
  event.preventDefault();
  endDrag();
  addDisplay(what.kind, what.topic);
}

function end() {
  dragged.value = "";
  goal.value = null;
}

/** @param {DragEvent} event @param {string} row @returns {Drop | null} null: nothing of ours is dragged, or it cannot go there */
function dropAt(event, row) {
  if (dragged.peek() === "") return null;
  const { top, height } = /** @type {HTMLElement} */ (event.currentTarget).getBoundingClientRect();
  return dropOn(liveDisplays.peek(), dragged.peek(), row, (event.clientY - top) / height);
}
