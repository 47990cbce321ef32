/** The frame that this person's camera goes with. */

import { effect, signal } from "vendor/preact.js";
import { keepInScene } from "./frames-in-scene.js";
import { connection } from "./state/connection.js";
import { documentId, robot } from "./state/document.js";
import { viewport } from "./viewport.js";

/** Empty: the camera goes with none. */
export const targetFrame = signal("");
/** Why it does not go, in a sentence; empty: it does, or it is not known yet. */
export const targetTrouble = signal("");

/** Keep the camera going with its frame. @returns {() => void} the end of that */
export function keepTargetFrame() {
  const ends = [
    effect(() => {
      documentId.value;
      targetFrame.value = "";
    }),
    effect(() => viewport.value?.setTarget(targetFrame.value)),
    effect(() => {
      // Of another frame, robot or connection it is not known yet.
      [targetFrame.value, robot.value, connection.value];
      targetTrouble.value = "";
    }),
    keepInScene(() => (targetFrame.value === "" ? [] : [targetFrame.value]), takeTrouble),
  ];
  return () => {
    for (const end of ends) end();
  };
}

/** @param {string} frame @param {string} trouble */
function takeTrouble(frame, trouble) {
  if (frame === targetFrame.peek()) targetTrouble.value = trouble;
}
