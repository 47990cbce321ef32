/** A box for a text that may be typed, or picked from a list that is asked for when it opens. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "./i18n.js";
import { Icon, openMenu } from "./ui.js";

/**
 * Enter and leaving it write, also nothing at all; Escape gives back what stood there.
 *
 * @typedef {object} PickBoxProps
 * @property {string} label
 * @property {string} text
 * @property {string} [placeholder] said where it is empty
 * @property {string} [class]
 * @property {boolean} [disabled]
 * @property {() => Promise<readonly (string | {label: string, value: string})[]>} [choices] without them it is a box and no more
 * @property {string} [none] said where there are no choices
 * @property {(typed: string) => void} onWrite
 */

/** @param {PickBoxProps} props */
export function PickBox(props) {
  const { label, text, placeholder, class: names, disabled, choices, onWrite } = props;
  const typed = useSignal(/** @type {string | null} */ (null));
  const menu = useRef(/** @type {import("./ui.js").MenuHandle | null} */ (null));
  useEffect(() => () => menu.current?.close(), []);
  const write = () => {
    const now = typed.peek();
    typed.value = null;
    if (now !== null && now.trim() !== text) onWrite(now.trim());
  };
  /** @param {HTMLElement} button */
  const open = async (button) => {
    if (button.getAttribute("aria-expanded") === "true") return menu.current?.close();
    const found = (await choices?.()) ?? [];
    if (!button.isConnected) return undefined;
    menu.current = openMenu(button, label, itemsOf(found, props));
    return undefined;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const box = /** @type {HTMLElement} */ (event.currentTarget);
    const button = box.parentElement?.querySelector("button");
    if (event.key === "Enter") write();
    else if (event.key === "Escape" && typed.peek() !== null) {
      typed.value = null;
      event.stopPropagation();
    } else if (event.key === "ArrowDown" && button) {
      event.preventDefault();
      open(button);
    }
  };
  return html`<span class=${`pick-box ${names ?? ""}`}>
    <input type="text" class="box" aria-label=${label} value=${typed.value ?? text} placeholder=${placeholder} title=${text}
      disabled=${disabled} spellcheck=${false} autocomplete="off" autocapitalize="off" maxlength="300"
      onInput=${(/** @type {any} */ event) => {
        typed.value = event.currentTarget.value;
      }} onKeyDown=${onKeyDown} onBlur=${write} />
    ${
      choices &&
      html`<button type="button" class="pick-box-button" aria-label=${t("pick", { label })} title=${t("pick", { label })}
      aria-haspopup="menu" aria-expanded="false" disabled=${disabled}
      onClick=${(/** @type {any} */ event) => open(event.currentTarget)}><${Icon} name="chevronDown" size=${12} /></button>`
    }</span>`;
}

/** @param {readonly (string | {label: string, value: string})[]} found @param {PickBoxProps} props */
function itemsOf(found, { text, none, onWrite }) {
  if (found.length === 0) return [{ label: none ?? "", heading: true }];
  return found
    .map((one) => (typeof one === "string" ? { label: one, value: one } : one))
    .map(({ label, value }) => ({ label, checked: value === text, run: () => onWrite(value) }));
}
