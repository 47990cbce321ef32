/** The page's words as a test reads them. */

import { readFileSync } from "node:fs";

const FOLDER = new URL("../../../frontend_assets/i18n/", import.meta.url);
/** Behind the name of a language: the words of the page itself, and those that panels about ROS 2 bring. */
export const PARTS = ["", ".ros"];

/** @param {string} name of a language, with or without a part @returns {Record<string, string>} */
export const fileOfWords = (name) =>
  JSON.parse(readFileSync(new URL(`${name}.json`, FOLDER), "utf8"));

/** @param {string} language @returns {Record<string, string>} all parts */
export const wordsOf = (language) =>
  Object.assign({}, ...PARTS.map((part) => fileOfWords(language + part)));
