/** Keys that drive while they are held, for as long as the focus is among the parts they belong to. */

/** @import { DriveTarget } from "./driving.js" */

import { useRef } from "vendor/preact.js";
import { drives, ofKeys } from "../lib/driving.js";
import { halt, hold, release } from "./driving.js";

const HAND = "keys";

/** @param {() => DriveTarget} [target] where speeds go; without one as the Teleop panel says @returns {{onKeyDown: (event: KeyboardEvent) => void, onKeyUp: (event: KeyboardEvent) => void, onFocusOut: (event: any) => void}} for the element around those parts */
export function useDrivingKeys(target) {
  const keys = useRef(/** @type {Set<string>} */ (new Set()));
  const letGo = () => {
    keys.current.clear();
    halt();
  };
  return {
    onKeyDown(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.code === "Space") letGo();
      else if (!drives(event.code)) return;
      else if (!event.repeat) hold(HAND, ofKeys(keys.current.add(event.code)), target?.());
      // Neither the page scrolls nor another part of it takes the key.
      event.preventDefault();
      event.stopPropagation();
    },
    onKeyUp(event) {
      if (!keys.current.delete(event.code)) return;
      if (keys.current.size > 0) hold(HAND, ofKeys(keys.current), target?.());
      else release(HAND);
    },
    onFocusOut(event) {
      if (!event.currentTarget.contains(event.relatedTarget)) letGo();
    },
  };
}
