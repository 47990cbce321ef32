/** Parts of the page whose file is loaded when they are first shown. */

import { html, useEffect, useState } from "vendor/preact.js";

/** @typedef {(props: any) => import("vendor/preact.js").VNode | null} Component */

/**
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
