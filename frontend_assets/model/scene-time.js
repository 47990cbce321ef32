/** Time of the 3D view: ROS time, that of the studio's machine, and how long both have run. */

/** @import { SceneTime } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal } from "vendor/preact.js";
import { polled } from "./asking.js";
import { documentId } from "./connection.js";
import { send } from "./wire.js";

/** As fast as hundredths can be read at all. */
const EVERY_MS = 100;

/** As the studio told it last; null: not yet. @type {Signal<SceneTime | null>} */
export const sceneTime = signal(null);

effect(() => {
  documentId.value;
  sceneTime.value = null;
});

async function askForTime() {
  try {
    const answer = await send({ type: "get_scene_time" });
    if (answer.type === "scene_time") sceneTime.value = answer;
  } catch {
    // The next question comes in a moment; that the studio is away says itself.
  }
}

/** Begin to look at it; gives the end of looking. */
export const followTime = polled(askForTime, EVERY_MS, () => documentId.value !== "");
