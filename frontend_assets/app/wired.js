/** Styles and words of the panels about ROS 2: they come with the first of these, not with the page. */

import { useWords } from "../lib/i18n.js";

const FILES = [
  "styles/topics.css",
  "vendor/uplot.css",
  "styles/plot.css",
  "styles/image.css",
  "styles/deeds.css",
  "styles/message-form.css",
  "styles/teleop.css",
  "styles/fields.css",
  "styles/log.css",
  "styles/lessons.css",
  "styles/lifecycle.css",
  "styles/interfaces.css",
  "styles/graph.css",
];
const WORDS = ".ros";
/** @type {Promise<unknown> | null} */
let coming = null;

/**
 * @template T
 * @param {() => Promise<T>} load
 * @returns {() => Promise<T>} the same, with styles and words
 */
export const wired = (load) => async () => {
  coming ??= Promise.all(FILES.map(styled));
  const [loaded] = await Promise.all([load(), coming, useWords(WORDS)]);
  return loaded;
};

/** @param {string} file @returns {Promise<unknown>} settles once it holds, or cannot be had */
function styled(file) {
  const link = document.createElement("link");
  link.rel = "stylesheet";
  link.href = new URL(`../${file}`, import.meta.url).href;
  const arrived = new Promise((resolve) => {
    link.onload = resolve;
    link.onerror = resolve;
  });
  // Before those of windows and of other panels, which may say more.
  document.head.insertBefore(link, document.querySelector('link[href*="styles/launch.css"]'));
  return arrived;
}
