/** The page's words as a test reads them. */

import { readFileSync } from "node:fs";
import { PANEL_FILES } from "./panels.js";

const ASSETS = new URL("../../../frontend_assets/", import.meta.url);

export const LANGUAGES = ["en", "de"];

/** @param {string} path @returns {any} */
const read = (path) => JSON.parse(readFileSync(new URL(path, ASSETS), "utf8"));

/** @returns {{file: string, words: Record<string, Record<string, string>>}[]} by language: those of the page, and those of each panel */
export function filesOfWords() {
  const page = Object.fromEntries(LANGUAGES.map((one) => [one, read(`i18n/${one}.json`)]));
  const panels = Object.entries(PANEL_FILES).map(([id, { words }]) => ({
    file: `panels/${id}/panel.json`,
    words,
  }));
  return [{ file: "i18n/", words: page }, ...panels];
}

/** @param {string} language @returns {Record<string, string>} all, as the server puts them together */
export const wordsOf = (language) =>
  Object.assign({}, ...filesOfWords().map(({ words }) => words[language]));
