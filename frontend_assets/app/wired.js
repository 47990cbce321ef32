/** Words of the panels about ROS 2: they come with the first of these, not with the page. */

import { useWords } from "../lib/i18n.js";

const WORDS = ".ros";

/**
 * @template T
 * @param {() => Promise<T>} load
 * @returns {() => Promise<T>} the same, with the words
 */
export const wired = (load) => async () => {
  const [loaded] = await Promise.all([load(), useWords(WORDS)]);
  return loaded;
};
