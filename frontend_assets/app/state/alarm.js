/** Whether it is time to say that the robot cannot be built: not while somebody is in the midst of a tag. */

import { computed, effect, signal } from "vendor/preact.js";
import { showingLastGood } from "./document.js";

/** A text that rests so long is meant to be complete. */
const REST_MS = 1500;

const typing = signal(false);
/** @type {ReturnType<typeof setTimeout> | undefined} */
let resting;

/** Something was typed into a source text here. */
export function noteTyping() {
  typing.value = true;
  clearTimeout(resting);
  resting = setTimeout(() => {
    typing.value = false;
  }, REST_MS);
}

/** It was said once, and stays said until the robot is whole again. */
const said = signal(false);
effect(() => {
  if (!showingLastGood.value) said.value = false;
  else if (!typing.value) said.value = true;
});

/** Only the editor shows what is wrong so far. */
export const heldBack = computed(() => showingLastGood.value && !said.value);
