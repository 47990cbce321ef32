/**
 * Boxes for a text that may be typed, or picked from a list: of any texts, or of the links of the
 * robot.
 */

import { html, useEffect, useId, useRef, useSignal } from "vendor/preact.js";
import { t } from "./i18n.js";
import { ranked } from "./ranking.js";
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

const SHOWN = 60;

/**
 * @param {{label: string, value: string | null, links: readonly string[], placeholder?: string,
 *   onPick: (link: string) => void}} props
 */
export function LinkPicker({ label, value, links, placeholder = "", onPick }) {
  const id = useId();
  /** What is typed; null: the list is closed. */
  const typed = useSignal(/** @type {string | null} */ (null));
  const at = useSignal(0);
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  const found = typed.value === null ? [] : fitting(links, typed.value);
  const shown = found.slice(0, SHOWN);
  const active = Math.min(at.value, shown.length - 1);
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }, [active, typed.value === null]);
  const open = () => {
    typed.value = "";
    at.value = Math.max(0, links.slice(0, SHOWN).indexOf(value ?? ""));
    box.current?.select();
  };
  const close = () => {
    typed.value = null;
  };
  /** @param {string | undefined} link */
  const pick = (link) => {
    if (link === undefined) return;
    close();
    onPick(link);
  };
  /** @param {KeyboardEvent} event @returns {boolean} it was one of ours */
  const keyOfList = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) at.value = (active + step + shown.length) % Math.max(shown.length, 1);
    else if (event.key === "Enter") pick(shown[active]);
    else if (event.key === "Escape") {
      close();
      event.stopPropagation();
    } else return false;
    return true;
  };
  /** @param {KeyboardEvent} event @returns {boolean} it was one of ours */
  const keyOfBox = ({ key }) => {
    const opens = ["ArrowDown", "ArrowUp", "Enter"].includes(key);
    if (opens) open();
    return opens;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (typed.value === null ? keyOfBox(event) : keyOfList(event)) event.preventDefault();
  };
  return html`<div class="picker">
    <input ref=${box} type="text" class="box picker-box" role="combobox" aria-label=${label} aria-autocomplete="list"
      aria-expanded=${typed.value !== null} aria-controls=${id} spellcheck=${false} autocomplete="off"
      aria-activedescendant=${shown[active] === undefined ? null : `${id}-${active}`} title=${value ?? label}
      value=${typed.value || (value ?? "")} placeholder=${placeholder} onClick=${() => typed.value === null && open()}
      onKeyDown=${onKeyDown} onBlur=${close} onInput=${(/** @type {any} */ event) => {
        typed.value = event.currentTarget.value;
        at.value = 0;
      }} />
    ${
      typed.value !== null &&
      html`<div id=${id} class="picker-list" role="listbox" aria-label=${label} ref=${list}
        onPointerDown=${(/** @type {Event} */ event) => event.preventDefault()}>
      ${shown.map(
        (
          name,
          n,
        ) => html`<div key=${name} id=${`${id}-${n}`} role="option" class=${`picker-item ${name === value ? "present" : ""}`}
          aria-selected=${n === active} title=${name} onClick=${() => pick(name)}>${name}</div>`,
      )}
      ${found.length > shown.length && html`<p class="nothing">${t("outline.more", { count: found.length - shown.length })}</p>`}
      ${found.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: typed.value })}</p>`}
    </div>`
    }
  </div>`;
}

/** @param {readonly string[]} links @param {string} text @returns {readonly string[]} those that fit */
function fitting(links, text) {
  if (text.trim() === "") return links;
  const all = links.map((label) => ({ rank: /** @type {const} */ ("link"), label }));
  return ranked(all, text).map(({ label }) => label);
}
