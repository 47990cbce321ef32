/** Asking the studio again and again, while somebody looks and the page is to be seen. */

import { effect, untracked } from "vendor/preact.js";
import { connection } from "./connection.js";
import { sharedLook } from "./frames.js";

/**
 * @param {() => Promise<boolean | void>} ask gives whether there is more to be asked for at once
 * @param {number} everyMs from an answer to the next question
 * @param {() => boolean} [isOn] whether there is anything to ask; when what it reads changes, it is asked at once
 * @returns {() => () => void} begin to look; gives the end of looking
 */
export const polled = (ask, everyMs, isOn = () => true) =>
  sharedLook(() => {
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    let turn = 0;
    /** @param {number} mine a new connection begins another turn */
    const go = async (mine) => {
      const more = !document.hidden && (await ask());
      if (mine === turn) timer = setTimeout(go, more ? 0 : everyMs, mine);
    };
    const end = effect(() => {
      turn += 1;
      clearTimeout(timer);
      const mine = turn;
      if (isOn() && connection.value === "connected") untracked(() => go(mine));
    });
    return () => {
      turn += 1;
      clearTimeout(timer);
      end();
    };
  });
