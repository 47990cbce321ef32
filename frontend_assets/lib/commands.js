/**
 * Everything that has a name and perhaps a key: menus, shortcuts, the list of keys and the
 * palette. A key is written as `Mod+Shift+Z`; Mod is Ctrl, or Command on a Mac.
 */

import { signal } from "vendor/preact.js";
import { t } from "./i18n.js";

/**
 * @typedef {{key: string, ctrlKey: boolean, metaKey: boolean, shiftKey: boolean, altKey: boolean}} Stroke
 */

/** @param {string} shortcut @param {Stroke} stroke @returns {boolean} */
export function matches(shortcut, stroke) {
  const parts = shortcut.split("+");
  const key = parts.at(-1)?.toLowerCase();
  const mod = stroke.ctrlKey || stroke.metaKey;
  const pressed = stroke.key === " " ? "space" : stroke.key.toLowerCase();
  // "?" needs Shift on many keyboards, so Shift counts only for letters and named keys.
  const shiftCounts = (key?.length ?? 0) > 1 || /[a-z]/.test(key ?? "");
  return (
    pressed === key &&
    mod === parts.includes("Mod") &&
    stroke.altKey === parts.includes("Alt") &&
    (!shiftCounts || stroke.shiftKey === parts.includes("Shift"))
  );
}

/** @param {string} shortcut @param {boolean} mac @returns {string} as keyboards are labelled */
export function shortcutText(shortcut, mac) {
  if (!mac) return shortcut.replace("Mod", "Ctrl").replaceAll("+", " ");
  /** @type {Record<string, string>} */
  const signs = { Mod: "⌘", Shift: "⇧", Alt: "⌥" };
  return shortcut
    .split("+")
    .map((part) => signs[part] ?? part)
    .join("");
}

/** @param {EventTarget | null} target @returns {boolean} keys typed there are text */
export function takesText(target) {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement)
    return !["range", "checkbox", "button"].includes(target.type);
  return target.isContentEditable || ["TEXTAREA", "SELECT"].includes(target.tagName);
}

/** @param {EventTarget | null} target @returns {boolean} Space presses it, or scrolls it */
export const takesSpace = (target) =>
  target instanceof HTMLElement &&
  target.matches('button, a, input, summary, [tabindex="0"]:not([role="slider"])');

/**
 * @typedef {object} Command
 * @property {string} id its words are `command.<id>`
 * @property {() => string} [label] other words than these
 * @property {string} icon
 * @property {string[]} [keys] the first is the one that is shown
 * @property {() => void} run
 * @property {() => boolean} [enabled]
 * @property {boolean} [inText] its key works while text is typed, too
 */

/** @type {import("vendor/preact.js").Signal<readonly Command[]>} */
export const commands = signal([]);

/** @param {readonly Command[]} added */
export function addCommands(added) {
  commands.value = [...commands.value, ...added];
}

/** @param {string} start of the ids of those that go @param {readonly Command[]} added in their place */
export function replaceCommands(start, added) {
  commands.value = [...commands.peek().filter(({ id }) => !id.startsWith(start)), ...added];
}

/** @param {Command} command @returns {string} */
export const commandLabel = (command) => command.label?.() ?? t(`command.${command.id}`);

/** @param {string} id */
export const commandById = (id) => commands.value.find((command) => command.id === id);

export const onMac = /Mac|iPhone|iPad/.test(navigator.platform);

/**
 * @param {Stroke} stroke
 * @param {{inText?: boolean}} [where]
 * @returns {boolean} a command took it
 */
export function onKey(stroke, { inText = false } = {}) {
  const meant = commands.value.filter(
    (one) => (one.inText || !inText) && one.keys?.some((key) => matches(key, stroke)),
  );
  // A key may have another meaning where its first one is off.
  meant.find(({ enabled }) => enabled?.() ?? true)?.run();
  return meant.length > 0;
}

/** @param {unknown} detail @returns {detail is Stroke} */
export function isStroke(detail) {
  return typeof detail === "object" && detail !== null && "key" in detail && "ctrlKey" in detail;
}
