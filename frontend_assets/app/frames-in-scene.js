/**
 * Frames that are no links: the studio tells the 3D view where they are for as long as somebody asks,
 * which costs one pose a picture for all who look. Links stand there anyway.
 */

import { effect, untracked } from "vendor/preact.js";
import { connection } from "./state/connection.js";
import { robot } from "./state/document.js";
import { send } from "./wire.js";

/** The studio forgets who does not ask again. */
const EVERY_MS = 2000;

/**
 * Keep frames in the scene.
 *
 * @param {() => readonly string[]} wanted is called anew when what it reads changes
 * @param {(frame: string, trouble: string) => void} [said] is told why one is not there; empty: it is
 * @returns {() => void} the end of it
 */
export function keepInScene(wanted, said = () => {}) {
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let timer;
  const end = effect(() => {
    clearInterval(timer);
    const frames = wanted().filter((frame) => !isLink(frame));
    if (frames.length === 0 || connection.value !== "connected") return;
    const ask = () => {
      for (const frame of frames) askFor(frame).then((trouble) => said(frame, trouble));
    };
    untracked(ask);
    timer = setInterval(() => document.hidden || ask(), EVERY_MS);
  });
  return () => {
    clearInterval(timer);
    end();
  };
}

/** @param {string} frame */
const isLink = (frame) => robot.value?.links.some(({ name }) => name === frame) ?? false;

/** @param {string} frame */
function askFor(frame) {
  return send({ type: "follow_frame", frame }).then(
    (answer) => (answer.type === "frame_followed" ? answer.trouble : ""),
    (/** @type {Error} */ error) => error.message,
  );
}
