/** Tabs that never end in the middle of a word: where one does not fit, icons take the place of words. */

const HEADERS = ".dv-tabs-and-actions-container";
const TABS = ".dv-tabs-container";
/** From the most words to the least: all, all closer together, all without icons, that of the tab in front, none. */
const STEPS = [
  [],
  ["close-tabs"],
  ["close-tabs", "bare-tabs"],
  ["close-tabs", "tight-tabs"],
  ["close-tabs", "tight-tabs", "icon-tabs"],
];

/**
 * @param {HTMLElement} dock
 * @returns {() => void} to be called when tabs came, went, or moved
 */
export function keepTabsWhole(dock) {
  let asked = 0;
  // Not in the observer itself: what it changes would call it again within the same picture.
  const later = () => {
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(() => {
      for (const header of dock.querySelectorAll(HEADERS)) fit(header);
    });
  };
  const observer = new ResizeObserver(later);
  return () => {
    observer.disconnect();
    for (const one of dock.querySelectorAll(`${HEADERS}, ${HEADERS} .tab`)) observer.observe(one);
    later();
  };
}

/** @param {Element} header */
function fit(header) {
  const tabs = header.querySelector(TABS);
  if (!tabs) return;
  for (const names of STEPS) {
    header.classList.remove(...STEPS.flat());
    header.classList.add(...names);
    if (tabs.scrollWidth <= tabs.clientWidth) return;
  }
}
