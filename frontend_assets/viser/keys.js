/** Keys that viser may have for itself: they turn the camera. */
const VISERS = new Set(["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"]);
/** With Ctrl or Cmd: what the browser would do with these is never meant here. */
const OURS = new Set(["s", "z", "y", "k", "o", "m", "f", "enter", ..."123456789"]);

/**
 * Hand every key to the page around us, as if it had been pressed there.
 * @param {(detail: { key: string, [field: string]: unknown }) => boolean} tell Answers whether nobody prevented what we do by default.
 * @param {(event: KeyboardEvent) => void} byDefault
 */
export function forwardKeys(tell, byDefault) {
  const forward = (/** @type {KeyboardEvent} */ event) => {
    if (VISERS.has(event.key) && !withModifier(event)) return;
    event.stopImmediatePropagation();
    if (event.type !== "keydown") return;
    const { key, code, ctrlKey, metaKey, shiftKey, altKey, repeat } = event;
    if (isOurs(event)) event.preventDefault();
    if (tell({ key, code, ctrlKey, metaKey, shiftKey, altKey, repeat })) byDefault(event);
  };
  window.addEventListener("keydown", forward, { capture: true });
  window.addEventListener("keyup", forward, { capture: true });
}

/** @param {KeyboardEvent} event */
function withModifier(event) {
  return event.ctrlKey || event.metaKey || event.altKey;
}

/** @param {KeyboardEvent} event */
function isOurs({ key, ctrlKey, metaKey }) {
  return key === "F6" || key === "F1" || ((ctrlKey || metaKey) && OURS.has(key.toLowerCase()));
}
