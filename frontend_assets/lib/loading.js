/**
 * Parts of the page that are loaded later: when they are first shown, or when there is nothing
 * more urgent to do.
 */

import { effect, html, useEffect, useState } from "vendor/preact.js";

const PATIENCE_MS = 1000;
const WITHOUT_IDLE_MS = 200;

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
