/** What is selected in 3D: items of displays and links, each with all that is known of it, live. */

/** @import { DisplayView, FactView, ItemDetails, ItemRef } from "../../types/wire.d.ts" */
/** @import { Selected } from "../../model/selected-items.js" */

import { html, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { language, t } from "../../lib/i18n.js";
import { LongList } from "../../lib/long-list.js";
import { allDigits, shownMeasure, shownNumber } from "../../lib/numbers.js";
import { EmptyState, Icon, IconButton } from "../../lib/ui.js";
import { liveDisplays } from "../../model/live-displays.js";
import {
  adding,
  deselect,
  idOf,
  itemDetails,
  itemsRefused,
  leftOut,
  openItem,
  openItems,
  placesIn,
  selectedItems,
  selectNothing,
} from "../../model/selected-items.js";
import { notify } from "../../model/view.js";
import { viewport } from "../../model/viewport.js";

/** @typedef {readonly [number, number, number]} Place */
/** @typedef {{id: string, display: string, items: Selected[], open: boolean}} GroupRow */
/** @typedef {{id: string, item: Selected}} ItemRow */

export function SelectionPanel() {
  const items = [...selectedItems.value.values()];
  return html`<section class="panel-body selection" aria-label=${t("panel.selection")}>
    ${items.length > 0 && html`<${Bar} items=${items} />`}
    <${Notes} />
    ${items.length > 0 ? html`<${Tree} items=${items} />` : html`<${Nothing} />`}
  </section>`;
}

function Nothing() {
  return html`<${EmptyState} icon="select" title=${t("selection.none")}><p>${t("selection.none.hint")}</p><//>`;
}

/** @param {{items: Selected[]}} props */
function Bar({ items }) {
  const middle = middleOf(items);
  return html`<div class="panel-bar selection-bar">
    <strong role="status">${t("selection.count", { count: shownCount(items.length) })}</strong>
    <span class="selection-tools">
      <${AddSwitch} />
      <${IconButton} icon="target" label=${t("selection.focus")} onClick=${() => viewport.value?.focusOutlines()} />
      <${IconButton} icon="copy" label=${t("selection.copy")} disabled=${middle === null} onClick=${() => middle && copyPlace(middle)} />
      <${IconButton} icon="close" label=${t("selection.clear")} onClick=${selectNothing} />
    </span>
    ${
      middle &&
      items.length > 1 &&
      html`<span class="selection-middle" title=${t("selection.middle.hint", { frame: placesIn.value })}><span class="muted">${t("selection.middle")}</span><${Numbers} values=${middle} unit="m" /></span>`
    }
  </div>`;
}

function AddSwitch() {
  const toggle = () => {
    adding.value = !adding.value;
  };
  return html`<${IconButton} icon="plus" label=${t("selection.add")} pressed=${adding.value} onClick=${toggle} />`;
}

/** @param {number} count @returns {string | number} 1 chooses other words */
const shownCount = (count) => (count < 1000 ? count : count.toLocaleString(language.value));

function Notes() {
  const lost = leftOut.value;
  return html`${lost > 0 && html`<p class="note padded" role="status"><${Icon} name="info" size=${13} />${t("selection.left_out", { count: shownCount(lost) })}</p>`}
    ${itemsRefused.value && html`<p class="note bad padded" role="alert">${itemsRefused.value}</p>`}`;
}

/** @param {{items: Selected[]}} props */
function Tree({ items }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const toggled = useSignal(/** @type {ReadonlyMap<string, boolean>} */ (new Map()));
  const rows = rowsOf(items, toggled.value);
  const toggle = (/** @type {GroupRow} */ { display, open }) => {
    toggled.value = new Map([...toggled.value, [display, !open]]);
  };
  return html`<div class="scroll selection-tree" role="tree" aria-label=${t("selection.tree")} ref=${list}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => onKey(event, list.current)}>
    <${LongList} items=${rows} keyOf=${(/** @type {GroupRow | ItemRow} */ { id }) => id} row="var(--row)"
      isKept=${(/** @type {GroupRow | ItemRow} */ { id }) => openItems.value.has(id)}
      draw=${(/** @type {GroupRow | ItemRow} */ row) =>
        "items" in row
          ? html`<${Group} key=${row.id} row=${row} toggle=${() => toggle(row)} />`
          : html`<${Item} key=${row.id} row=${row} />`} />
  </div>`;
}

/** Of a display with more items only its name is shown at first. */
const FEW = 50;

/**
 * @param {readonly Selected[]} items
 * @param {ReadonlyMap<string, boolean>} toggled displays that were opened or closed by hand
 * @returns {(GroupRow | ItemRow)[]} display by display
 */
export function rowsOf(items, toggled) {
  /** @type {Map<string, Selected[]>} */
  const groups = new Map();
  for (const item of items) {
    const group = groups.get(item.ref.display);
    if (group) group.push(item);
    else groups.set(item.ref.display, [item]);
  }
  return [...groups].flatMap(([display, all]) => {
    const open = toggled.get(display) ?? all.length <= FEW;
    const rows = open ? all.map((item) => ({ id: idOf(item.ref), item })) : [];
    return [{ id: `${display} `, display, items: all, open }, ...rows];
  });
}

/** @param {{row: GroupRow, toggle: () => void}} props */
function Group({ row: { display, items, open }, toggle }) {
  const { name, icon } = groupName(display, liveDisplays.value);
  return html`<div class="selection-row selection-group" role="treeitem" aria-level="1" aria-expanded=${open} aria-label=${name}>
    <button type="button" class="entry-main selection-button" aria-expanded=${open} onClick=${toggle}>
      <${Icon} name=${open ? "chevronDown" : "chevronRight"} size=${13} /><${Icon} name=${icon} size=${14} /><span class="selection-name">${name}</span>
      <span class="muted numbers">${shownCount(items.length)}</span>
    </button>
    <${RemoveButton} name=${name} refs=${items.map(({ ref }) => ref)} />
  </div>`;
}

/** @param {string} id @param {readonly DisplayView[]} displays @returns {{name: string, icon: string}} */
function groupName(id, displays) {
  if (id === "") return { name: t("selection.robot"), icon: "robot" };
  const display = displays.find((one) => one.id === id);
  return display ?? { name: t("selection.removed_display"), icon: "eyeOff" };
}

/** @param {{row: ItemRow}} props */
function Item({ row: { id, item } }) {
  const open = openItems.value.has(id);
  const { view, gone } = item;
  const name = nameOf(item);
  return html`<div class=${`selection-item ${gone ? "gone" : ""}`} role="treeitem" aria-level="2" aria-expanded=${open} aria-label=${name}>
    <div class="selection-row">
      <button type="button" class="entry-main selection-button" data-id=${id} aria-expanded=${open} onClick=${() => openItem(id, !open)}>
        <${Icon} name=${open ? "chevronDown" : "chevronRight"} size=${13} /><span class="selection-name">${name}</span>
        ${gone ? html`<span class="selection-gone">${t("selection.gone")}</span>` : view?.place && html`<span class="selection-place"><${Numbers} values=${view.place} /></span>`}
      </button>
      <${RemoveButton} name=${name} refs=${[item.ref]} />
    </div>
    ${open && html`<${Details} item=${item} details=${itemDetails.value.get(id) ?? null} />`}
  </div>`;
}

/** @param {{name: string, refs: readonly ItemRef[]}} props */
function RemoveButton({ name, refs }) {
  return html`<${IconButton} icon="close" size=${13} class="selection-remove" label=${t("selection.remove", { name })} onClick=${() => deselect(refs)} />`;
}

/** @param {Selected} item @returns {string} */
export function nameOf({ ref, view }) {
  if (!view) return ref.key;
  const kind = t(`selection.kind.${view.kind}`);
  return view.name === "" ? kind : `${kind} ${view.name}`;
}

/** @param {{item: Selected, details: ItemDetails | null}} props */
function Details({ item: { ref, view, gone }, details }) {
  if (!details)
    return html`<p class="note padded">${t(openItems.value.size > 40 ? "selection.details_max" : "loading")}</p>`;
  const place = details.in_fixed.find(({ kind }) => kind === "position")?.value;
  const own = [
    ...(view?.frame && ref.display ? [textFact("frame", view.frame)] : []),
    ...(view?.stamp ? [textFact("stamp", view.stamp, "s")] : []),
    ...details.facts,
  ];
  return html`<div class="selection-details">
    ${gone && html`<p class="note"><${Icon} name="info" size=${13} />${t("selection.gone.hint")}</p>`}
    <${Facts} label=${ref.display ? t("selection.in_message") : ""} facts=${own} />
    ${details.in_fixed.length > 0 && html`<${Facts} label=${t("selection.in_fixed", { frame: placesIn.value })} facts=${details.in_fixed} place=${place} />`}
    ${!gone && details.in_fixed.length === 0 && html`<p class="note"><${Icon} name="alert" size=${13} />${t("selection.unconnected")}</p>`}
  </div>`;
}

/** @param {string} name @param {string} value @param {string} [unit] @returns {FactView} */
const textFact = (name, value, unit = "") => ({ name, value, unit, kind: "" });

/** @param {{label: string, facts: readonly FactView[], place?: unknown}} props */
function Facts({ label, facts, place }) {
  return html`<div class="selection-facts">
    ${
      label &&
      html`<h3><span>${label}</span>${Array.isArray(place) && html`<${IconButton} icon="copy" size=${13} label=${t("selection.copy")} onClick=${() => copyPlace(/** @type {any} */ (place))} />`}</h3>`
    }
    <dl>${facts.map((fact, at) => html`<div key=${`${at} ${fact.name}`}><dt title=${fact.name}>${factName(fact)}</dt><dd><${Value} fact=${fact} /></dd></div>`)}</dl>
  </div>`;
}

/** @param {FactView} fact @returns {string} fields of a message keep their own names */
function factName({ name, kind }) {
  const key = `selection.fact.${name}`;
  const words = kind === "field" ? key : t(key);
  return words === key ? name : words;
}

/** @param {{fact: FactView}} props */
function Value({ fact: { value, unit, kind } }) {
  if (Array.isArray(value)) {
    return html`${kind === "colour" && html`<span class="selection-colour" style=${`background:${cssColour(value)}`}></span>`}<${Numbers} values=${value} unit=${unit} />`;
  }
  const text = typeof value === "number" ? shownNumber(value) : String(value);
  const all = typeof value === "number" ? allDigits(value) : text;
  return html`<span title=${all}>${text}${unit && ` ${unit}`}</span>`;
}

/** @param {readonly number[]} rgba 0 to 1 @returns {string} */
export function cssColour([red = 0, green = 0, blue = 0, alpha = 1]) {
  const byte = (/** @type {number} */ part) => Math.round(255 * Math.min(Math.max(part, 0), 1));
  return `rgb(${byte(red)} ${byte(green)} ${byte(blue)} / ${Math.min(Math.max(alpha, 0), 1)})`;
}

/** @param {{values: readonly number[], unit?: string}} props each by itself, so that a line breaks between them */
function Numbers({ values, unit = "" }) {
  return html`<span class="selection-numbers" title=${values.map(allDigits).join(" ")}>${values.map(
    (value, at) => html`<span key=${at}>${shownMeasure(Number(value.toPrecision(5)))}</span>`,
  )}${unit && html`<span class="muted">${unit}</span>`}</span>`;
}

/** @param {readonly Selected[]} items @returns {[number, number, number] | null} the mean of their places in the fixed frame; null: none is known */
export function middleOf(items) {
  const places = items.flatMap(({ view, gone }) => (gone || !view?.place ? [] : [view.place]));
  if (places.length === 0) return null;
  const mean = (/** @type {0 | 1 | 2} */ axis) =>
    places.reduce((sum, place) => sum + place[axis], 0) / places.length;
  return [mean(0), mean(1), mean(2)];
}

/** @param {Place} place */
async function copyPlace(place) {
  const text = place.map((part) => String(Number(part.toFixed(6)))).join(" ");
  if (await copyText(text)) notify(t("selection.copied", { text }));
}

/** Keys of a tree: up and down go from item to item, right and left open and close, Delete removes.
 * @param {KeyboardEvent} event @param {HTMLElement | null} list */
function onKey(event, list) {
  const buttons = [...(list?.querySelectorAll("button.selection-button") ?? [])];
  const at = buttons.indexOf(/** @type {Element} */ (document.activeElement));
  const id = buttons[at]?.getAttribute("data-id") ?? "";
  /** @type {Record<string, () => void>} */
  const keys = {
    ArrowDown: () => focus(buttons[at + 1]),
    ArrowUp: () => focus(buttons[at - 1]),
    ArrowRight: () => setOpen(buttons[at], id, true),
    ArrowLeft: () => setOpen(buttons[at], id, false),
    Delete: () => {
      focus(buttons[at + 1] ?? buttons[at - 1]);
      const item = selectedItems.value.get(id);
      if (item) deselect([item.ref]);
    },
    Escape: selectNothing,
  };
  const run = keys[event.key];
  if (!run || (at < 0 && event.key !== "Escape")) return;
  event.preventDefault();
  run();
}

/** @param {Element | undefined} button @param {string} id of an item; empty: it is a display's @param {boolean} open */
function setOpen(button, id, open) {
  if (id) openItem(id, open);
  else if (button instanceof HTMLElement && button.ariaExpanded !== String(open)) button.click();
}

/** @param {Element | undefined} element */
function focus(element) {
  if (element instanceof HTMLElement) element.focus();
}
