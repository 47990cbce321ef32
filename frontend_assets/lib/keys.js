/** Keyboard shortcuts: `Mod+Shift+Z` and the like; Mod is Ctrl, or Command on a Mac. */

/**
 * @typedef {{key: string, ctrlKey: boolean, metaKey: boolean, shiftKey: boolean, altKey: boolean}} Stroke
 */

/** @param {string} shortcut @param {Stroke} stroke @returns {boolean} */
export function matches(shortcut, stroke) {
  const parts = shortcut.split("+");
  const key = parts.at(-1)?.toLowerCase();
  const mod = stroke.ctrlKey || stroke.metaKey;
  // "?" needs Shift on many keyboards, so Shift counts only for letters and named keys.
  const shiftCounts = (key?.length ?? 0) > 1 || /[a-z]/.test(key ?? "");
  return (
    stroke.key.toLowerCase() === key &&
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
