/** Asking the studio again and again, while somebody looks and the page is to be seen. */

import { effect, untracked } from "vendor/preact.js";
import { keepAsking } from "../../lib/asking.js";
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
    let end = () => {};
    const forget = effect(() => {
      end();
      end = () => {};
      if (!isOn() || connection.value !== "connected") return;
      untracked(() => {
        end = keepAsking(async () => !document.hidden && (await ask()), everyMs);
      });
    });
    return () => {
      forget();
      end();
    };
  });
