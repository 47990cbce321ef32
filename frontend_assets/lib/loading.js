/**
 * Parts of the page that are loaded later: when they are first shown, or when there is nothing
 * more urgent to do.
 */

import { effect, html, useEffect, useState } from "vendor/preact.js";

const PATIENCE_MS = 1000;
const WITHOUT_IDLE_MS = 200;
const VIEW_CLIENT = "viser/client.zst";
/** A class of thirty that comes over one line of 20 Mbit/s has it within this time. */
const SLOW_LINE_MS = 20_000;
const SLOW_PAGE_MS = 4000;
const COURTESY_MAX_MS = 10_000;

/** @returns {Promise<void>} after what is being drawn now, and at the latest after a second */
export function untilIdle() {
  return new Promise((resolve) => {
    const done = () => resolve();
    if ("requestIdleCallback" in window) requestIdleCallback(done, { timeout: PATIENCE_MS });
    else setTimeout(done, WITHOUT_IDLE_MS);
  });
}

/** @param {() => boolean} holds reads signals @param {number} patience_ms @returns {Promise<void>} once it holds, or after that time */
export function until(holds, patience_ms) {
  return new Promise((resolve) => {
    const late = setTimeout(resolve, patience_ms);
    const stop = effect(() => {
      if (!holds()) return;
      clearTimeout(late);
      resolve();
    });
    setTimeout(stop, patience_ms);
  });
}

/**
 * The client of the 3D view is most of what a page loads: what is not seen at first waits for it.
 *
 * @returns {Promise<void>} once it is here, or after a time; at once if the page does not prefetch it
 */
export function untilViewFetched() {
  const links = [...document.querySelectorAll("link")];
  const link = links.find(({ rel, href }) => rel === "prefetch" && href.endsWith(VIEW_CLIENT));
  if (!link?.relList.supports("prefetch")) return Promise.resolve();
  return new Promise((resolve) => {
    const observer = new PerformanceObserver((list) => {
      if (list.getEntriesByName(link.href).length > 0) done();
    });
    const done = () => {
      observer.disconnect();
      clearTimeout(late);
      resolve();
    };
    const late = setTimeout(done, SLOW_LINE_MS);
    observer.observe({ type: "resource", buffered: true });
  });
}

/**
 * Who comes with others over one line leaves it, once served, to those who still wait.
 *
 * @param {number} waitedMs for what the page needs first
 * @returns {number} for how many milliseconds what it needs last should wait
 */
export const courtesyMs = (waitedMs) =>
  waitedMs < SLOW_PAGE_MS ? 0 : Math.min(waitedMs / 2, COURTESY_MAX_MS);

/** @typedef {(props: any) => import("vendor/preact.js").VNode | null} Component */

/**
 * Parts of the page whose file is loaded when they are first shown.
 *
 * @param {() => Promise<Component>} load
 * @returns {Component} draws nothing until the file is here; where it cannot be had, `onClose` is called
 */
export function later(load) {
  /** @type {Component | null} */
  let loaded = null;
  return function Later(props) {
    const [ready, setReady] = useState(loaded !== null);
    useEffect(() => {
      if (loaded) return;
      const take = (/** @type {Component} */ component) => {
        loaded = component;
        setReady(true);
      };
      load().then(take, () => props.onClose?.());
    }, []);
    return ready && loaded ? html`<${loaded} ...${props} />` : null;
  };
}
