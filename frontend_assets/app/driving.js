/** Sends the speed that hands hold, again and again, and zero at once when they let go. */

/** @import { Deflection, Limits } from "../lib/driving.js" */

import { CENTRE, speedOf, together } from "../lib/driving.js";
import { mayEdit } from "./state/connection.js";
import { driveLimits, driveTarget, drivingRefused, held } from "./state/driving.js";
import { askOrKeepWhy } from "./state/refusals.js";

/** @typedef {{name: string, stamped: boolean, limits: () => Limits & {rate: number}}} DriveTarget a topic, and how fast what hears it may go */

/** @returns {DriveTarget} as the Teleop panel says */
const chosenTarget = () => ({ ...driveTarget.peek(), limits: () => driveLimits.peek() });

/** @type {ReturnType<typeof setTimeout> | undefined} while something is held */
let beat;
/** Where the robot is that moves now: another topic may be chosen meanwhile. */
let moved = chosenTarget();
let waits = false;

/** @param {string} hand @param {Deflection} deflection what this hand holds from now on @param {DriveTarget} [target] of what stood still until now */
export function hold(hand, deflection, target = chosenTarget()) {
  if (!mayEdit.peek()) return;
  held.value = new Map(held.peek()).set(hand, deflection);
  if (beat !== undefined) return;
  moved = target;
  go();
}

/** @param {string} hand that lets go; what others hold counts on */
export function release(hand) {
  const left = new Map(held.peek());
  if (!left.delete(hand)) return;
  held.value = left;
  if (left.size === 0) halt();
}

/** Stand still now, whatever is held. */
export function halt() {
  held.value = new Map();
  if (beat === undefined) return;
  clearTimeout(beat);
  beat = undefined;
  say(CENTRE);
}

function go() {
  beat = setTimeout(go, 1000 / moved.limits().rate);
  // One at a time: on a slow line old speeds would pile up before the newest.
  if (!waits) say(together(held.peek().values()));
}

/** @param {Deflection} deflection */
async function say(deflection) {
  const { name: topic, stamped, limits } = moved;
  waits = true;
  const speed = speedOf(deflection, limits());
  const answer = await askOrKeepWhy({ type: "drive", topic, stamped, ...speed }, drivingRefused);
  waits = false;
  if (answer === null) giveUp();
}

/** It was refused, or the studio is gone, which stops the robot by itself. */
function giveUp() {
  clearTimeout(beat);
  beat = undefined;
  held.value = new Map();
}
