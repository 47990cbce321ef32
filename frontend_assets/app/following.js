/**
 * The frame that this person's camera goes with. Links stand in the 3D view anyway; where another
 * frame is, the studio is asked to tell there, which costs one pose a picture for all who look.
 */

import { effect, signal, untracked } from "vendor/preact.js";
import { connection } from "./state/connection.js";
import { documentId, robot } from "./state/document.js";
import { viewport } from "./viewport.js";
import { send } from "./wire.js";

/** The studio forgets who does not ask again. */
const EVERY_MS = 2000;

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
    keepAsking(),
  ];
  return () => {
    for (const end of ends) end();
  };
}

function keepAsking() {
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let timer;
  const end = effect(() => {
    clearInterval(timer);
    targetTrouble.value = "";
    const frame = targetFrame.value;
    if (frame === "" || isLink(frame) || connection.value !== "connected") return;
    untracked(() => askFor(frame));
    timer = setInterval(() => document.hidden || askFor(frame), EVERY_MS);
  });
  return () => {
    clearInterval(timer);
    end();
  };
}

/** @param {string} frame */
const isLink = (frame) => robot.value?.links.some(({ name }) => name === frame) ?? false;

/** @param {string} frame */
async function askFor(frame) {
  const said = await send({ type: "follow_frame", frame }).then(
    (answer) => (answer.type === "frame_followed" ? answer.trouble : ""),
    (/** @type {Error} */ error) => error.message,
  );
  if (frame === targetFrame.peek()) targetTrouble.value = said;
}
