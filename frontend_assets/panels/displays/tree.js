/** The tree of what is shown: its rows, their keys, and the small controls in them. */

/** @import { ComponentChildren } from "vendor/preact.js" */

import { html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { LongList, siblingPlaces } from "../../lib/long-list.js";
import { parseNumber, shownNumber } from "../../lib/numbers.js";
import { TextBox } from "../../lib/slider.js";
import { Icon, LongName } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { hovered, selected, selectLink } from "../../model/selection.js";
import { focusLink } from "../../model/viewport.js";

/**
 * @typedef {object} Row one line of the tree
 * @property {string} id
 * @property {number} level from 1
 * @property {string} label
 * @property {string} icon
 * @property {boolean} [expandable]
 * @property {boolean} [expanded]
 * @property {string} [meta] said small at the right
 * @property {string} [value] what its controls show, for screen readers
 * @property {boolean} [warn] what `meta` says is a fault
 * @property {{on: boolean, label: string, set: (on: boolean) => void, shared: boolean}} [eye]
 * @property {{value: number, label: string, set: (value: number) => void}} [slider]
 * @property {{value: number, unit: string, label: string, set: (value: number) => void}} [number]
 * @property {string} [link]
 * @property {"warn" | "error"} [tone] of `meta`
 * @property {boolean} [faded] it is there, but not seen
 * @property {string} [kind] one more class of the row
 * @property {string} [hint] longer tooltip of its label
 * @property {() => ComponentChildren} [name] drawn in the place of the label
 * @property {() => void} [rename] has its name be written, as a double click on it asks
 * @property {{title: string, text: string}} [help] what it is, said below the tree while it is the current row
 * @property {(open: boolean) => void} [setOpen] folds it, where that is not the tree's to keep
 * @property {() => ComponentChildren} [controls] drawn before its eye
 * @property {Readonly<Record<string, unknown>>} [attributes] more of its element, as what makes it be dragged
 * @property {Readonly<Record<string, () => void>>} [keys] what keys do beside those of every row, as `Alt+ArrowUp`
 */

/** Opens the menu of a row, as a click with the other button does. */
const MENU_KEY = "ContextMenu";

/** @param {string} id */
export const rowId = (id) => `row-${id}`;

/**
 * @param {{rows: Row[], active: {value: string}, setOpen: (id: string, open: boolean) => void}} props
 */
export function Tree({ rows, active, setOpen }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const places = siblingPlaces(rows.map(({ level }) => level));
  const current = rows.some(({ id }) => id === active.value) ? active.value : (rows[0]?.id ?? "");
  /** @param {Row | undefined} row */
  const go = (row) => {
    if (!row) return;
    active.value = row.id;
    requestAnimationFrame(() => document.getElementById(rowId(row.id))?.focus());
  };
  useNeighbour(rows, active);
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.target instanceof HTMLElement && event.target.closest(".tree-control")) return;
    if (ownKey(event, rows, current) || event.ctrlKey || event.metaKey) return;
    if (event.target instanceof HTMLInputElement) return;
    if (treeKey(event, rows, current, go, setOpen)) event.preventDefault();
  };
  return html`<div class="tree" role="tree" aria-label=${t("panel.displays")} ref=${element} onKeyDown=${onKeyDown}
    onPointerLeave=${() => {
      hovered.value = null;
    }}>
    <${LongList} items=${rows} keyOf=${(/** @type {Row} */ row) => row.id} row="var(--row)"
      isKept=${(/** @type {Row} */ row) => row.id === current || isChosen(row)}
      draw=${(
        /** @type {Row} */ row,
        /** @type {number} */ at,
      ) => html`<${TreeRow} key=${row.id} row=${row} place=${places[at]} current=${row.id === current} setOpen=${setOpen}
        onPick=${() => {
          active.value = row.id;
        }} />`} />
  </div>`;
}

/**
 * When the current row goes, as by Delete, the one above it takes its place, and the focus if that was on it.
 * @param {Row[]} rows @param {{value: string}} active
 */
function useNeighbour(rows, active) {
  const before = useRef(/** @type {string[]} */ ([]));
  useEffect(() => {
    const ids = before.current;
    before.current = rows.map(({ id }) => id);
    const at = ids.indexOf(active.value);
    if (at < 0 || before.current.includes(active.value)) return;
    const left = ids.slice(0, at).findLast((id) => before.current.includes(id));
    const row = rows.find(({ id }) => id === left) ?? rows[0];
    if (!row) return;
    active.value = row.id;
    requestAnimationFrame(() => {
      // Unless somebody went elsewhere meanwhile.
      if (document.activeElement === document.body) document.getElementById(rowId(row.id))?.focus();
    });
  }, [rows]);
}

/** @param {KeyboardEvent} event @param {Row[]} rows @param {string} current @returns {boolean} the key was one of the row's own */
function ownKey(event, rows, current) {
  const { key, altKey, ctrlKey, metaKey, shiftKey } = event;
  const held = [(ctrlKey || metaKey) && "Ctrl+", altKey && "Alt+", shiftKey && "Shift+"];
  const stroke = [...held.filter(Boolean), key].join("");
  const run = rows.find(({ id }) => id === current)?.keys?.[stroke];
  if (!run) return false;
  event.preventDefault();
  event.stopPropagation();
  run();
  return true;
}

/**
 * @param {KeyboardEvent} event
 * @param {Row[]} rows
 * @param {string} current
 * @param {(row: Row | undefined) => void} go
 * @param {(id: string, open: boolean) => void} setOpen
 * @returns {boolean} the key was one of the tree's
 */
function treeKey(event, rows, current, go, setOpen) {
  const at = rows.findIndex(({ id }) => id === current);
  const row = rows[at];
  if (!row) return false;
  /** @type {Record<string, () => void>} */
  const moves = {
    ArrowDown: () => go(rows[at + 1]),
    ArrowUp: () => go(rows[at - 1]),
    Home: () => go(rows[0]),
    End: () => go(rows.at(-1)),
    ArrowRight: () =>
      row.expandable && !row.expanded ? fold(row, true, setOpen) : go(rows[at + 1]),
    ArrowLeft: () =>
      row.expanded && row.expandable ? fold(row, false, setOpen) : go(parentRow(rows, at)),
    Enter: () => pick(row),
    " ": () => row.eye && (!row.eye.shared || mayEdit.value) && row.eye.set(!row.eye.on),
  };
  const move = moves[event.key];
  move?.();
  return move !== undefined;
}

/** @param {Row} row @param {boolean} open @param {(id: string, open: boolean) => void} setOpen of the tree */
function fold(row, open, setOpen) {
  if (row.setOpen) row.setOpen(open);
  else setOpen(row.id, open);
}

/** @param {Row[]} rows @param {number} at @returns {Row | undefined} */
function parentRow(rows, at) {
  const level = rows[at]?.level ?? 1;
  return rows.slice(0, at).findLast((row) => row.level < level);
}

/** @param {Row} row */
function pick(row) {
  if (row.link) selectLink(selected.value === row.link ? null : row.link, "displays");
}

/**
 * @param {{row: Row, place: {at: number, of: number} | undefined, current: boolean,
 *   setOpen: (id: string, open: boolean) => void, onPick: () => void}} props
 */
function TreeRow({ row, place, current, setOpen, onPick }) {
  const onClick = () => {
    onPick();
    if (row.link) pick(row);
    else if (row.expandable) fold(row, !row.expanded, setOpen);
  };
  return html`<div id=${rowId(row.id)} role="treeitem" class=${rowClass(row)} style=${`--level:${row.level}`}
    tabindex=${current ? 0 : -1} aria-level=${row.level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-label=${rowLabel(row)}
    aria-expanded=${row.expandable ? row.expanded : null} aria-selected=${isChosen(row)} onClick=${onClick} onFocusIn=${onPick}
    onDblClick=${(/** @type {MouseEvent} */ event) => onDoubleClick(event, row)}
    onContextMenu=${(/** @type {Event} */ event) => openRowMenu(event, row)}
    onPointerEnter=${() => {
      hovered.value = row.link ?? null;
    }} ...${row.attributes}>
    <${Twisty} row=${row} setOpen=${setOpen} />
    ${row.icon && html`<${Icon} name=${row.icon} size=${15} />`}
    ${row.name ? row.name() : html`<span class="tree-label" title=${row.hint ?? row.label}>${row.link ? html`<${LongName} text=${row.label} />` : row.label}</span>`}
    <${RowTail} row=${row} />
    ${row.eye && html`<${Eye} eye=${row.eye} />`}
  </div>`;
}

/** @param {MouseEvent} event @param {Row} row the name of a display is written, a link comes into view */
function onDoubleClick({ target }, row) {
  if (row.link) focusLink(row.link);
  else if (target instanceof Element && target.closest(".tree-label")) row.rename?.();
}

/** @param {Event} event @param {Row} row */
function openRowMenu(event, row) {
  const open = row.keys?.[MENU_KEY];
  if (!open) return;
  event.preventDefault();
  open();
}

/** What stands between the name of a row and its eye. @param {{row: Row}} props */
function RowTail({ row }) {
  return html`${row.meta && html`${" "}<span class=${`tree-meta ${row.warn ? "warn" : ""} ${row.tone ?? ""}`} title=${row.meta}>${row.meta}</span>`}
    ${row.controls && html`${" "}<span class="tree-control" onClick=${stop} onDblClick=${stop}>${row.controls()}</span>`}
    ${row.slider && html`<${ShareSlider} ...${row.slider} />`}
    ${row.number && html`<${NumberBox} ...${row.number} />`}`;
}

/** @param {Row} row @returns {boolean} */
const isChosen = ({ link }) => link !== undefined && selected.value === link;

/** @param {Row} row @returns {string} */
function rowClass(row) {
  const { link, eye } = row;
  const states = [
    isChosen(row) && "chosen",
    link && hovered.value === link && "hovered",
    (row.faded || (link && !eye?.on)) && "faded",
    row.kind,
  ];
  return ["tree-row", ...states].filter(Boolean).join(" ");
}

/** @param {Row} row @returns {string} what a screen reader says, beside level and state */
function rowLabel({ label, meta, value, eye }) {
  return [label, meta, value, eye && !eye.on ? t("hidden") : ""].filter(Boolean).join(", ");
}

/** @param {{row: Row, setOpen: (id: string, open: boolean) => void}} props */
function Twisty({ row, setOpen }) {
  if (!row.expandable) return html`<span class="twisty"></span>`;
  /** @param {MouseEvent} event */
  const onClick = (event) => {
    event.stopPropagation();
    fold(row, !row.expanded, setOpen);
  };
  // Arrow keys do the same for the row, so this is not one more stop for the Tab key.
  return html`<span class="twisty" aria-hidden="true" onClick=${onClick}>
    <${Icon} name=${row.expanded ? "chevronDown" : "chevronRight"} size=${14} /></span>`;
}

/** @param {{eye: NonNullable<Row["eye"]>}} props */
function Eye({ eye }) {
  const locked = eye.shared && !mayEdit.value;
  const hint = locked ? `${eye.label}\n${t("display.shared")}` : eye.label;
  return html`<button type="button" class="eye" aria-label=${eye.label} title=${hint} aria-pressed=${eye.on}
    tabindex=${-1} disabled=${locked} onDblClick=${stop}
    onClick=${(/** @type {MouseEvent} */ event) => {
      event.stopPropagation();
      eye.set(!eye.on);
    }}><${Icon} name=${eye.on ? "eye" : "eyeOff"} size=${15} /></button>`;
}

/** @param {Event} event */
const stop = (event) => event.stopPropagation();

/** @param {{value: number, label: string, set: (value: number) => void}} props */
function ShareSlider({ value, label, set }) {
  return html`<input type="range" class="slider short" min="0" max="1" step="0.05" value=${value} aria-label=${label}
    disabled=${!mayEdit.value} style=${`--fill:${value * 100}%`} onClick=${stop}
    onInput=${(/** @type {any} */ event) => set(Number(event.currentTarget.value))} />`;
}

/** @param {{value: number, unit: string, label: string, set: (value: number) => void}} props */
function NumberBox({ value, unit, label, set }) {
  /** @param {string} typed */
  const onWrite = (typed) => {
    const number = parseNumber(typed);
    if (number !== null) set(number);
  };
  return html`<${TextBox} class="number narrow" label=${label} text=${value === 0 ? t("automatic") : shownNumber(value)} number=${value}
    disabled=${!mayEdit.value} onWrite=${onWrite} /><span class="unit">${unit}</span>`;
}
