/** A panel that asks for something only while it is to be seen. */

import { useEffect, useRef, useSignal } from "vendor/preact.js";
import { useSeen } from "../lib/seen.js";

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
