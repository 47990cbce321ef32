/** Whether something is in the page where it can be looked at: a panel behind another one is not. */

import { useEffect } from "vendor/preact.js";

/**
 * @param {{current: Element | null}} element
 * @param {(seen: boolean) => void} tell at every change, and false at the end
 */
export function useSeen(element, tell) {
  useEffect(() => {
    const watcher = new IntersectionObserver((entries) => {
      const last = entries.at(-1);
      if (last) tell(last.isIntersecting);
    });
    if (element.current) watcher.observe(element.current);
    return () => {
      watcher.disconnect();
      tell(false);
    };
  }, []);
}

/**
 * Bring something into view without moving the focus: at once, or as soon as its panel is looked at.
 *
 * @param {Element | null | undefined} element
 * @param {ScrollLogicalPosition} [block]
 * @returns {() => void} the end of waiting
 */
export function reveal(element, block = "nearest") {
  const watcher = new IntersectionObserver((entries) => {
    const last = entries.at(-1);
    if (!last || last.rootBounds?.height === 0) return;
    if (element && element.getClientRects().length > 0) {
      watcher.disconnect();
      if (last.intersectionRatio < 1) element.scrollIntoView({ block });
    }
  });
  if (element) watcher.observe(element);
  return () => watcher.disconnect();
}
