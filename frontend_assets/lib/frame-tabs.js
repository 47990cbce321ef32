/**
 * The Tab key along the page: a panel that lies in a layer above the dock comes last in the document,
 * and yet is reached right behind its own tab, and left for what stands there next.
 */

const STOPS =
  'a[href], button:not(:disabled), input:not(:disabled), select:not(:disabled), textarea:not(:disabled), [contenteditable="true"], [tabindex]';

/** @typedef {{header: Element, content: Element}} Layered a panel's row of tabs, and what lies in the layer */

/**
 * @param {HTMLElement} dock
 * @param {() => Layered[]} layered
 */
export function keepTabOrder(dock, layered) {
  dock.addEventListener("keydown", (event) => {
    const { key, ctrlKey, altKey, metaKey, defaultPrevented } = event;
    if (key !== "Tab" || ctrlKey || altKey || metaKey || defaultPrevented) return;
    for (const part of layered()) {
      const next = nextStop(dock, part, event.shiftKey);
      if (!next) continue;
      event.preventDefault();
      next.focus();
      return;
    }
  });
}

/** @param {HTMLElement} dock @param {Layered} part @param {boolean} back @returns {HTMLElement | undefined} where the browser would go elsewhere */
function nextStop(dock, { header, content }, back) {
  const inside = stopsIn(content);
  const outside = stopsIn(dock).filter((one) => !content.contains(one));
  const at = outside.findLastIndex((one) => header.contains(one));
  const [before, after] = [outside[at], outside[at + 1]];
  const [first, last] = [inside[0], inside.at(-1)];
  const now = document.activeElement;
  if (!first || !before) return undefined;
  if (back) return now === first ? before : now === after ? last : undefined;
  return now === before ? first : now === last ? after : undefined;
}

/** @param {Element} element @returns {HTMLElement[]} where Tab stops in it; a frame has stops of its own */
function stopsIn(element) {
  const all = /** @type {NodeListOf<HTMLElement>} */ (element.querySelectorAll(STOPS));
  return [...all].filter((one) => one.tabIndex >= 0 && one.checkVisibility());
}
