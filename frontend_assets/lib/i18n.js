/** The page's words: one JSON file per language, English where a language lacks a key. */

import { signal } from "vendor/preact.js";

export const LANGUAGES = /** @type {const} */ ({ en: "English", de: "Deutsch" });

/** @type {import("vendor/preact.js").Signal<Record<string, string>>} */
const words = signal({});
export const language = signal("en");

/**
 * @param {string} key
 * @param {Record<string, string | number>} [values] fill `{name}`; `count` also chooses `key.one`
 * @returns {string}
 */
export function t(key, values = {}) {
  const text =
    (values.count === 1 ? words.value[`${key}.one`] : undefined) ?? words.value[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (_, name) => String(values[name] ?? ""));
}

/** @param {string} wanted @returns {string} the nearest language that we have */
export function nearestLanguage(wanted) {
  const short = wanted.slice(0, 2).toLowerCase();
  return short in LANGUAGES ? short : "en";
}

/** @param {string} name of a language @returns {Promise<void>} */
export async function useLanguage(name) {
  const english = load("en");
  const own = name === "en" ? english : load(name);
  words.value = { ...(await english), ...(await own) };
  language.value = name;
  document.documentElement.lang = name;
}

/** @param {string} name @returns {Promise<Record<string, string>>} */
async function load(name) {
  const answer = await fetch(new URL(`../i18n/${name}.json`, import.meta.url));
  return answer.ok ? answer.json() : {};
}
