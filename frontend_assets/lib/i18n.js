/** The page's words: one JSON file per language, which the server fills with those of the panels. */

import { signal } from "vendor/preact.js";

export const LANGUAGES = /** @type {const} */ ({ en: "English", de: "Deutsch" });

/** @type {import("vendor/preact.js").Signal<Record<string, string>>} */
const words = signal({});
/** By language: those that came. @type {Map<string, Promise<Record<string, string>>>} */
const files = new Map();
export const language = signal("en");

/** Whether the page is used with fingers: nothing can be pointed at, and keys are far away. */
const coarse = globalThis.matchMedia?.("(pointer: coarse)");
const fingers = signal(coarse?.matches ?? false);
coarse?.addEventListener("change", () => {
  fingers.value = coarse.matches;
});

/**
 * @param {string} key
 * @param {Record<string, string | number>} [values] fill `{name}`; `count` also chooses `key.one`
 * @returns {string} on a touch screen `key.touch`, where there is one
 */
export function t(key, values = {}) {
  const text =
    (values.count === 1 ? words.value[`${key}.one`] : undefined) ??
    (fingers.value ? words.value[`${key}.touch`] : undefined) ??
    words.value[key] ??
    key;
  return text.replace(/\{(\w+)\}/g, (_, name) => String(values[name] ?? ""));
}

/** @param {string} wanted @returns {string} the nearest language that we have */
export function nearestLanguage(wanted) {
  const short = wanted.slice(0, 2).toLowerCase();
  return short in LANGUAGES ? short : "en";
}

/** @param {string} name of a language @returns {Promise<void>} */
export async function useLanguage(name) {
  const coming = files.get(name) ?? load(name);
  files.set(name, coming);
  words.value = await coming;
  language.value = name;
  document.documentElement.lang = name;
}

/** @param {string} name @returns {Promise<Record<string, string>>} */
async function load(name) {
  const answer = await fetch(new URL(`../i18n/${name}.json`, import.meta.url)).catch(() => null);
  if (answer?.ok) return answer.json();
  files.delete(name); // asked for anew the next time
  return {};
}
