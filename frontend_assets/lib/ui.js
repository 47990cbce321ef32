/** Small parts that every panel is made of. */

import { ICONS } from "vendor/icons.js";
import {
  createContext,
  html,
  useContext,
  useEffect,
  useId,
  useLayoutEffect,
  useRef,
  useSignal,
} from "vendor/preact.js";

/** @import { Problem } from "../types/wire.d.ts" */
/** @import { ComponentChildren, Signal } from "vendor/preact.js" */

/** @typedef {[string, Record<string, string>][]} Shapes SVG tag and attributes of each */

/** @type {Record<string, Shapes>} */
const icons = { ...ICONS };

/** @param {Record<string, Shapes>} more by their names */
export const addIcons = (more) => void Object.assign(icons, more);

/** @param {{name: string, size?: number}} props */
export function Icon({ name, size = 16 }) {
  const shapes = icons[name] ?? [];
  return html`<svg class="icon" width=${size} height=${size} viewBox="0 0 24 24" aria-hidden="true">
    ${shapes.map(([tag, attributes]) => html`<${tag} ...${attributes} />`)}
  </svg>`;
}

/** Names of parts differ at both ends: so many characters of the end stay where there is no room for all. */
const TAIL = 6;

/** @param {{text: string}} props a name that is cut in its middle */
export function LongName({ text }) {
  const letters = [...text];
  if (letters.length < 2 * TAIL) return text;
  return html`<span class="long-name"><span>${letters.slice(0, -TAIL).join("")}</span><span>${letters.slice(-TAIL).join("")}</span></span>`;
}

/**
 * @typedef {object} IconButtonProps
 * @property {string} icon
 * @property {string} label its accessible name and tooltip
 * @property {string} [hint] longer tooltip
 * @property {(event: MouseEvent) => void} onClick
 * @property {boolean} [disabled]
 * @property {boolean} [pressed] set on switches only
 * @property {string} [class]
 * @property {number} [size]
 */

/** @param {IconButtonProps} props */
export function IconButton({ icon, label, hint, onClick, disabled, pressed, class: names, size }) {
  return html`<button type="button" class=${`icon-button ${names ?? ""}`} aria-label=${label}
    title=${hint ?? label} disabled=${disabled} aria-pressed=${pressed} onClick=${onClick}>
    <${Icon} name=${icon} size=${size} />
  </button>`;
}

/** @param {{label: string, value: string, first?: boolean, onInput: (value: string) => void}} props `first`: it has the focus when its window opens */
export function SearchBox({ label, value, first, onInput }) {
  /** @param {KeyboardEvent} event */
  const clearOnEscape = (event) => {
    if (event.key !== "Escape" || value === "") return;
    event.stopPropagation();
    event.preventDefault(); // else the window around it closes
    onInput("");
  };
  return html`<label class="search">
    <${Icon} name="search" />
    <input type="search" placeholder=${label} aria-label=${label} value=${value} spellcheck=${false} data-first=${first || null}
      onInput=${(/** @type {any} */ event) => onInput(event.currentTarget.value)} onKeyDown=${clearOnEscape} />
  </label>`;
}

/**
 * For a button that is off while what it began is under way.
 *
 * @returns {{busy: boolean, during: (work: () => Promise<unknown>) => () => Promise<void>}}
 */
export function useBusy() {
  const busy = useSignal(false);
  const during = (/** @type {() => Promise<unknown>} */ work) => async () => {
    busy.value = true;
    await work();
    busy.value = false;
  };
  return { busy: busy.value, during };
}

/** So far from its end a list still counts as scrolled to it. */
const END_PX = 4;

/** @param {HTMLElement} list that scrolls @returns {boolean} */
export const isAtEnd = ({ scrollHeight, scrollTop, clientHeight }) =>
  scrollHeight - scrollTop - clientHeight <= END_PX;

/**
 * For a list of lines that stays at its end while lines come, until somebody scrolls back in it.
 *
 * @param {readonly unknown[]} changes of what is shown
 */
export function useEnd(changes) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const follows = useSignal(true);
  useLayoutEffect(() => {
    if (follows.value) list.current?.scrollTo({ top: list.current.scrollHeight });
  }, [...changes, follows.value]);
  const onScroll = () => {
    if (list.current) follows.value = isAtEnd(list.current);
  };
  return { list, follows, onScroll };
}

/** @param {{label: string, checked: boolean, disabled?: boolean, onChange: (checked: boolean) => void}} props */
export function Switch({ label, checked, disabled, onChange }) {
  return html`<button type="button" role="switch" class="switch" aria-checked=${checked} aria-label=${label}
    disabled=${disabled} onClick=${() => onChange(!checked)}><span class="knob"></span></button>`;
}

/** @type {Record<Problem["severity"], string>} */
export const SEVERITY_ICONS = { error: "error", warning: "alert", info: "info" };

/** @param {readonly Problem[]} problems @returns {"red" | "amber" | "calm"} of the badge that counts them, by the worst */
export function badgeTone(problems) {
  const weights = new Set(problems.map(({ severity }) => severity));
  return weights.has("error") ? "red" : weights.has("warning") ? "amber" : "calm";
}

/** @param {{label: string, chosen: Signal<any>, of: readonly (readonly [any, ComponentChildren])[]}} props values with their words, of which one is chosen */
export function Segments({ label, chosen, of }) {
  const choose = (/** @type {any} */ value) => () => {
    chosen.value = value;
  };
  return html`<div class="segments words" role="group" aria-label=${label}>${of.map(
    ([value, words]) =>
      html`<button key=${String(value)} type="button" class="segment" aria-pressed=${chosen.value === value} onClick=${choose(value)}>${words}</button>`,
  )}</div>`;
}

/** @param {{icon: string, title: string, children?: ComponentChildren}} props what is missing, and what to do */
export function EmptyState({ icon, title, children }) {
  return html`<div class="empty">
    <${Icon} name=${icon} size=${28} />
    <p>${title}</p>
    ${children}
  </div>`;
}

/** @param {{label: string, done: number, total: number}} props */
export function ProgressBar({ label, done, total }) {
  const share = total > 0 ? Math.min(done / total, 1) : null;
  return html`<div class=${`progress ${share === null ? "unknown" : ""}`} role="progressbar" aria-label=${label}
    aria-valuemin=${0} aria-valuemax=${total > 0 ? total : null} aria-valuenow=${share === null ? null : done}>
    <span style=${share === null ? "" : `width:${(share * 100).toFixed(1)}%`}></span>
  </div>`;
}

/**
 * @typedef {object} MenuItem
 * @property {string} label
 * @property {() => void} [run]
 * @property {() => MenuItem[]} [more] a list of further choices that takes the place of this one
 * @property {string} [icon]
 * @property {string} [hint] shown small at the right
 * @property {boolean} [checked] a tick: one of several choices
 * @property {string} [mark] what a dot at the right says of it, as that it is open
 * @property {boolean} [box] a box of its own, with a tick or without
 * @property {boolean} [disabled]
 * @property {boolean} [heading] a line of text, no choice
 */

/**
 * A button that opens a list of choices: arrow keys, Escape, and a click elsewhere as usual.
 * The text that it shows, if any, is `value`: its name holds it for people who speak to the page.
 *
 * @param {{label: string, value?: string, class?: string, items: () => MenuItem[], disabled?: boolean, hint?: string,
 *   children: ComponentChildren}} props
 */
export function MenuButton({ label, value, class: names, items, disabled, hint, children }) {
  const menu = useRef(/** @type {MenuHandle | null} */ (null));
  useEffect(() => () => menu.current?.close(), []);
  /** @param {MouseEvent} event */
  const toggle = (event) => {
    const button = /** @type {HTMLElement} */ (event.currentTarget);
    if (button.getAttribute("aria-expanded") === "true") menu.current?.close();
    else menu.current = openMenu(button, label, items());
  };
  return html`<button type="button" class=${names ?? "icon-button"} aria-label=${value ? `${label}: ${value}` : label} title=${hint ?? label}
    aria-haspopup="menu" aria-expanded="false" disabled=${disabled} onClick=${toggle}>${children}</button>`;
}

/** @typedef {{close: () => void}} MenuHandle */

/**
 * Open a menu under a button, in the top layer: no panel cuts it off.
 *
 * @param {HTMLElement} button
 * @param {string} label
 * @param {MenuItem[]} items
 * @returns {MenuHandle}
 */
export function openMenu(button, label, items) {
  const element = document.createElement("div");
  element.className = "menu";
  element.setAttribute("role", "menu");
  element.setAttribute("aria-label", label);
  element.setAttribute("popover", "manual");
  const stop = new AbortController();
  let open = true;
  const close = () => {
    if (!open) return;
    open = false;
    stop.abort();
    const hadFocus = element.contains(document.activeElement);
    element.remove();
    button.setAttribute("aria-expanded", "false");
    if (hadFocus && button.isConnected) button.focus();
  };
  /** @type {MenuHandle | null} */
  let next = null;
  const choose = (/** @type {MenuItem} */ item) => {
    close();
    if (item.more) next = openMenu(button, item.label, item.more());
    else item.run?.();
  };
  element.append(...items.map((item) => menuEntry(item, choose)));
  // Inside a modal dialog everything outside of it is inert, top layer or not.
  (button.closest("dialog") ?? document.body).append(element);
  element.showPopover();
  place(element, button.getBoundingClientRect());
  button.setAttribute("aria-expanded", "true");
  listenForEnd(element, button, close, stop.signal);
  entries(element)[0]?.focus();
  return {
    close: () => {
      close();
      next?.close();
    },
  };
}

/** @param {MenuItem} item @param {(item: MenuItem) => void} choose @returns {HTMLElement} */
function menuEntry(item, choose) {
  const entry = document.createElement(item.heading ? "div" : "button");
  entry.className = item.heading ? "menu-heading" : "menu-item";
  const text = document.createElement("span");
  text.textContent = item.label;
  entry.append(tick(item), text);
  if (item.hint) {
    const hint = document.createElement("kbd");
    hint.textContent = item.hint;
    entry.append(hint);
  }
  if (item.mark) {
    const mark = document.createElement("span");
    mark.className = "menu-mark";
    mark.title = item.mark;
    entry.append(mark);
    entry.setAttribute("aria-description", item.mark);
  }
  if (entry instanceof HTMLButtonElement) makeChoice(entry, item, choose);
  return entry;
}

/** @param {HTMLButtonElement} entry @param {MenuItem} item @param {(item: MenuItem) => void} choose */
function makeChoice(entry, item, choose) {
  entry.type = "button";
  entry.disabled = item.disabled ?? false;
  const state = item.box ?? item.checked;
  const role = item.box === undefined ? "menuitemradio" : "menuitemcheckbox";
  entry.setAttribute("role", state === undefined ? "menuitem" : role);
  if (state !== undefined) entry.setAttribute("aria-checked", String(state));
  entry.addEventListener("click", () => choose(item));
}

/** @param {MenuItem} item @returns {HTMLElement | string} its icon, or the tick of a choice */
function tick(item) {
  if (item.heading) return "";
  const name = item.checked === undefined ? item.icon : item.checked ? "check" : undefined;
  const slot = document.createElement("span");
  slot.className = item.box === undefined ? "menu-icon" : "menu-icon menu-box";
  if (item.box) slot.append(iconElement("check"));
  if (name) slot.append(iconElement(name));
  return slot;
}

/** @param {string} name @returns {SVGElement} the icon for places that Preact does not draw */
export function iconElement(name) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  for (const [key, value] of Object.entries({
    class: "icon",
    width: "16",
    height: "16",
    viewBox: "0 0 24 24",
    "aria-hidden": "true",
  })) {
    svg.setAttribute(key, value);
  }
  for (const [tag, attributes] of icons[name] ?? []) {
    const shape = document.createElementNS(space, tag);
    for (const [key, value] of Object.entries(attributes)) shape.setAttribute(key, value);
    svg.append(shape);
  }
  return svg;
}

/** @param {HTMLElement} element @param {DOMRect} anchor below it, above when there is no room */
function place(element, anchor) {
  const { width, height } = element.getBoundingClientRect();
  const left = Math.max(8, Math.min(anchor.left, innerWidth - width - 8));
  const below = anchor.bottom + 4;
  const top = below + height > innerHeight - 8 ? Math.max(8, anchor.top - height - 4) : below;
  element.style.left = `${left}px`;
  element.style.top = `${top}px`;
}

/** @param {HTMLElement} menu @returns {HTMLButtonElement[]} */
function entries(menu) {
  return [...menu.querySelectorAll("button")].filter((entry) => !entry.disabled);
}

/** @param {HTMLElement} menu @param {HTMLElement} button @param {() => void} close @param {AbortSignal} signal */
function listenForEnd(menu, button, close, signal) {
  menu.addEventListener("keydown", (event) => onMenuKey(menu, event, close), { signal });
  document.addEventListener(
    "pointerdown",
    (event) => {
      const at = /** @type {Node} */ (event.target);
      if (!menu.contains(at) && !button.contains(at)) close();
    },
    { signal, capture: true },
  );
  // A click into the 3D view's frame reaches this document only as a loss of focus.
  addEventListener("blur", close, { signal });
  addEventListener("resize", close, { signal });
}

/** @param {HTMLElement} menu @param {KeyboardEvent} event @param {() => void} close */
function onMenuKey(menu, event, close) {
  const all = entries(menu);
  const at = all.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
  /** @type {Record<string, number>} */
  const moves = { ArrowDown: at + 1, ArrowUp: at - 1 + all.length, Home: 0, End: all.length - 1 };
  const to = moves[event.key];
  if (to !== undefined) all[to % all.length]?.focus();
  else if (event.key === "Escape" || event.key === "Tab") close();
  else return;
  event.preventDefault();
  event.stopPropagation();
}

/** What every window has: in its head beside the way out, and over it what the page tells meanwhile. @typedef {{help: () => ComponentChildren, notices: () => ComponentChildren}} Parts */
export const DialogParts = createContext(/** @type {Parts | null} */ (null));

/**
 * A modal window. Escape and a click beside it close it.
 *
 * @param {{title: string, closeLabel: string, class?: string, onClose: () => void, children: ComponentChildren}} props
 */
export function Dialog({ title, closeLabel, class: names, onClose, children }) {
  const element = useRef(/** @type {HTMLDialogElement | null} */ (null));
  const heading = useId();
  const parts = useContext(DialogParts);
  // Before the next key press: what is typed right after a shortcut belongs to the dialog.
  useLayoutEffect(() => {
    const before = document.activeElement;
    element.current?.showModal();
    /** @type {HTMLElement | null | undefined} */ (
      element.current?.querySelector("[data-first]") ??
        element.current?.querySelector(".dialog-close")
    )?.focus();
    return () => giveFocusBack(before);
  }, []);
  /** @param {MouseEvent} event */
  const closeBeside = (event) => {
    if (event.target === element.current) onClose();
  };
  return html`<dialog ref=${element} class=${`dialog ${names ?? ""}`} aria-labelledby=${heading}
    onCancel=${onClose} onClick=${closeBeside}>
    <section class="dialog-body">
      <header><h2 id=${heading}>${title}</h2>
        ${parts && html`<${parts.help} />`}<${IconButton} icon="close" label=${closeLabel} class="dialog-close" onClick=${onClose} /></header>
      ${children}
    </section>
    ${parts && html`<${parts.notices} />`}
  </dialog>`;
}

/** @param {Element | null} before had the focus; what a closing window began may have taken it since */
function giveFocusBack(before) {
  queueMicrotask(() => {
    const nobody = document.activeElement === document.body || document.activeElement === null;
    if (nobody && before instanceof HTMLElement && before.isConnected) before.focus();
  });
}

/** @param {HTMLElement | null} list @param {number} step @returns {boolean} */
export function moveFocus(list, step) {
  /** @type {HTMLElement[]} */
  const all = [...(list?.querySelectorAll("button.entry-main:not(:disabled)") ?? [])].filter(
    (one) => one instanceof HTMLElement,
  );
  const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  const next = all[Math.max(0, Math.min(at + step, all.length - 1))];
  next?.focus();
  return next !== undefined;
}
