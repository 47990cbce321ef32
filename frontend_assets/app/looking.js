/** A panel that asks for something only while it is to be seen. */

/** @import { Signal } from "vendor/preact.js" */

import { useEffect, useRef, useSignal } from "vendor/preact.js";
import { useSeen } from "../lib/seen.js";
import { polled } from "./state/polling.js";

/**
 * @param {() => () => void} follow begin to ask; gives the end of asking
 * @returns {{panel: {current: HTMLElement | null}, looking: boolean}} `panel` is to be set as its `ref`
 */
export function useLooking(follow) {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (is) => {
    seen.value = is;
  });
  const looking = seen.value;
  useEffect(() => (looking ? follow() : undefined), [looking]);
  return { panel, looking };
}

/**
 * What the studio tells, asked for again and again while the component stands.
 *
 * @template T
 * @param {T} first until it is told, and anew when what it is asked of changes
 * @param {() => Promise<T | null>} ask null: the studio does not answer
 * @param {number} everyMs from an answer to the next question
 * @param {readonly unknown[]} [of] what it is asked of
 * @returns {Signal<T>}
 */
export function useTold(first, ask, everyMs, of = []) {
  const told = useSignal(first);
  useEffect(() => {
    told.value = first;
    let over = false;
    const end = polled(async () => {
      const answer = await ask();
      if (answer !== null && !over) told.value = answer;
    }, everyMs)();
    return () => {
      over = true;
      end();
    };
  }, of);
  return told;
}
