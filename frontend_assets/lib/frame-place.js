/** Keeps a panel with an iframe over the place that the dock has for it. */

/** @import { IDockviewPanel } from "vendor/dockview.js" */

/**
 * Such a panel lies in a layer above the dock, for an iframe that leaves the document loads anew.
 * The dock measures its place when it arranges panels; what changes later, a style sheet that comes
 * late, say, it does not see.
 *
 * @param {HTMLElement} element the panel's content
 * @param {IDockviewPanel["api"]} api
 * @returns {() => void} the end of it
 */
export function keepInPlace(element, api) {
  const watcher = new ResizeObserver(() => place(element, referenceOf(api)));
  const follow = () => {
    watcher.disconnect();
    const reference = referenceOf(api);
    if (reference) watcher.observe(reference);
  };
  follow();
  const moved = api.onDidGroupChange(follow);
  return () => {
    moved.dispose();
    watcher.disconnect();
  };
}

/** @param {IDockviewPanel["api"]} api @returns {HTMLElement | null} what the panel is to cover */
function referenceOf(api) {
  return api.group.element.querySelector(".dv-content-container");
}

/** @param {HTMLElement} element @param {HTMLElement | null} reference */
function place(element, reference) {
  const layer = element.parentElement;
  const around = layer?.parentElement?.getBoundingClientRect();
  const wanted = reference?.getBoundingClientRect();
  if (!layer || !around || !wanted || wanted.width === 0 || wanted.height === 0) return;
  layer.style.left = `${wanted.left - around.left}px`;
  layer.style.top = `${wanted.top - around.top}px`;
  layer.style.width = `${wanted.width}px`;
  layer.style.height = `${wanted.height}px`;
}
