/** Where things are scrolled to, kept while their panel is out of the page, for the browser forgets it. */

/**
 * @param {HTMLElement} element that leaves the document and comes back
 * @returns {() => void} to be called when it is back: all in it is scrolled as it was left
 */
export function keepScrolled(element) {
  /** @type {Map<Element, {top: number, left: number}>} */
  const places = new Map();
  const note = (/** @type {Event} */ { target }) => {
    if (!(target instanceof Element) || !element.isConnected) return;
    places.set(target, { top: target.scrollTop, left: target.scrollLeft });
  };
  // Scrolling does not bubble, but it can be seen on its way down.
  element.addEventListener("scroll", note, { capture: true, passive: true });
  return () => {
    for (const [one, place] of places) {
      if (element.contains(one)) one.scrollTo({ ...place, behavior: "instant" });
      else places.delete(one);
    }
  };
}
