/** The texts of the help, each fetched when it is first asked for. */

/** @import { Block } from "../lib/help-text.js" */

import { readHelp, textFiles } from "../lib/help-text.js";

const FOLDER = new URL("../help/", import.meta.url).href;
const known = textFiles(FOLDER, readHelp);

/**
 * @param {string} language
 * @param {string} page
 * @returns {Promise<readonly Block[]>} empty, when it cannot be had now
 */
export const helpBlocks = (language, page) => known(`${language}/${page}.md`);

/** @param {string} name @param {string} theme @returns {string} address of a picture */
export const helpPicture = (name, theme) => `${FOLDER}pictures/${name}-${theme}.webp`;
