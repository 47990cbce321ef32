/** Topics and numbers of messages on their way by the mouse: into the 3D view, or into a plot. */

import { signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { mayEdit } from "../model/connection.js";
import { addDisplay } from "../model/live-displays.js";

/**
 * @typedef {object} Dragged
 * @property {string} topic
 * @property {string} type
 * @property {string} kind of the display that shows the topic; empty: none does
 * @property {string} path of a number in its messages; empty: the topic as a whole
 */

/** What is dragged now. @type {import("vendor/preact.js").Signal<Dragged | null>} */
export const dragged = signal(null);

/** @param {DragEvent} event @param {Dragged} what */
export function beginDrag(event, what) {
  event.dataTransfer?.setData("text/plain", what.topic + what.path);
  if (event.dataTransfer) event.dataTransfer.effectAllowed = "copy";
  dragged.value = what;
  // Not before the browser has its picture of what is dragged.
  if (what.kind && mayEdit.value) requestAnimationFrame(coverScene);
}

/** The 3D view is a document of its own, which takes no drops: what lies over it does. */
/** @type {HTMLElement | null} */
let cover = null;

function coverScene() {
  const view = document.querySelector("iframe");
  if (!view || !dragged.value) return;
  const { left, top, width, height } = view.getBoundingClientRect();
  const made = document.createElement("div");
  made.className = "drop-cover";
  made.textContent = t("topics.drop.scene", { kind: dragged.value.kind });
  Object.assign(made.style, {
    left: `${left}px`,
    top: `${top}px`,
    width: `${width}px`,
    height: `${height}px`,
  });
  made.addEventListener("dragover", takesDrop);
  made.addEventListener("drop", (event) => {
    event.preventDefault();
    const what = dragged.value;
    endDrag();
    if (what) addDisplay(what.kind, what.topic);
  });
  document.body.append(made);
  cover = made;
}

/** @param {DragEvent} event */
export function takesDrop(event) {
  if (!dragged.value) return;
  event.preventDefault();
  if (event.dataTransfer) event.dataTransfer.dropEffect = "copy";
}

export function endDrag() {
  dragged.value = null;
  cover?.remove();
  cover = null;
}
