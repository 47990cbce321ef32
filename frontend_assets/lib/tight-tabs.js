/** Tabs that never end in the middle of a word: what does not fit is reached by a menu at their end. */

const HEADERS = ".dv-tabs-and-actions-container";
const TABS = ".dv-tabs-container";
/** A word says more than its icon: tabs come closer together first, then lose their icons. */
const STEPS = [[], ["close-tabs"], ["close-tabs", "bare-tabs"]];

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
  // It is scrolled to a tab that is brought to the front; scrolling does not bubble.
  const scrolled = (/** @type {Event} */ { target }) => {
    if (target instanceof Element && target.matches(TABS)) hideCut(target);
  };
  dock.addEventListener("scroll", scrolled, { capture: true, passive: true });
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
    header.classList.remove(...STEPS.flat(), "has-more-tabs");
    header.classList.add(...names);
    if (tabs.scrollWidth <= tabs.clientWidth) break;
  }
  header.classList.toggle("has-more-tabs", tabs.scrollWidth > tabs.clientWidth);
  showActive(tabs);
  hideCut(tabs);
}

/** The tab of the panel that is seen stays in view when the row becomes narrower. @param {Element} tabs */
function showActive(tabs) {
  const active = tabs.querySelector(":scope > .dv-active-tab");
  if (!active) return;
  const [room, { left, right }] = [tabs.getBoundingClientRect(), active.getBoundingClientRect()];
  if (right > room.right) tabs.scrollLeft += Math.ceil(right - room.right);
  else if (left < room.left) tabs.scrollLeft -= Math.ceil(room.left - left);
}

/** A tab of which only a part is in view is not shown, but for the one in front: the menu has it. @param {Element} tabs */
function hideCut(tabs) {
  const room = tabs.getBoundingClientRect();
  for (const tab of tabs.children) {
    const { left, right } = tab.getBoundingClientRect();
    const isCut = left < room.left - 1 || right > room.right + 1;
    tab.classList.toggle("cut-tab", isCut && !tab.matches(".dv-active-tab"));
  }
}
