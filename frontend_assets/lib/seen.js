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
 * Do something once, as soon as an element has a place on the page.
 *
 * @param {Element | null | undefined} element
 * @param {() => void} run
 * @returns {() => void} the end of waiting
 */
export function whenPlaced(element, run) {
  // Told of the size that it has now, and of every other one: none while its panel is behind another.
  const watcher = new ResizeObserver(() => {
    if (!element || element.getClientRects().length === 0) return;
    watcher.disconnect();
    run();
  });
  if (element) watcher.observe(element);
  return () => watcher.disconnect();
}

/** Bring something into view without moving the focus, once it can be. @param {Element | null | undefined} element @returns {() => void} the end of waiting */
export function reveal(element) {
  return whenPlaced(element, () => element?.scrollIntoView({ block: "nearest" }));
}
