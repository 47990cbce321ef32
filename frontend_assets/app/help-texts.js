/** The texts of the help, each fetched when it is first asked for. */

/** @import { Block } from "../lib/help-text.js" */

import { readHelp } from "../lib/help-text.js";

/** @type {Map<string, Promise<readonly Block[]>>} */
const known = new Map();

/**
 * @param {string} language
 * @param {string} page
 * @returns {Promise<readonly Block[]>} empty, when it cannot be had now
 */
export function helpBlocks(language, page) {
  const name = `${language}/${page}`;
  const asked = known.get(name) ?? fetchBlocks(name);
  known.set(name, asked);
  return asked;
}

/** @param {string} name @returns {Promise<readonly Block[]>} */
async function fetchBlocks(name) {
  const text = await fetch(new URL(`../help/${name}.md`, import.meta.url))
    .then((answer) => (answer.ok ? answer.text() : ""))
    .catch(() => "");
  // What failed is asked for anew the next time.
  if (text === "") known.delete(name);
  return readHelp(text);
}

/** @param {string} name @param {string} theme @returns {string} address of a picture */
export const helpPicture = (name, theme) =>
  new URL(`../help/pictures/${name}-${theme}.webp`, import.meta.url).href;
