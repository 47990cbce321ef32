/** What is shown: the grid, the robot's layers (shared by all), and its links (each person's own view). */

/** @import { LinkRow } from "../lib/tree.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { setDisplay } from "../app/actions.js";
import { mayEdit } from "../app/state/connection.js";
import { displays, links, robot } from "../app/state/document.js";
import { selection, selectLink } from "../app/state/selection.js";
import { hiddenLinks, hovered, selected, showLink } from "../app/state/view.js";
import { focusLink } from "../app/viewport.js";
import { t } from "../lib/i18n.js";
import { LongList } from "../lib/long-list.js";
import { formatNumber, parseNumber } from "../lib/numbers.js";
import { siblingPlaces } from "../lib/pieces.js";
import { whenPlaced } from "../lib/seen.js";
import { TextBox } from "../lib/slider.js";
import { ancestorsOf, linkRows } from "../lib/tree.js";
import { EmptyState, Icon, LongName, SearchBox } from "../lib/ui.js";
import { LinkDetails } from "./link-details.js";

/**
 * @typedef {object} Row one line of the tree
 * @property {string} id
 * @property {number} level from 1
 * @property {string} label
 * @property {string} icon
 * @property {boolean} [expandable]
 * @property {boolean} [expanded]
 * @property {string} [meta] said small at the right
 * @property {boolean} [warn] what `meta` says is a fault
 * @property {{on: boolean, label: string, set: (on: boolean) => void, shared: boolean}} [eye]
 * @property {{value: number, label: string, set: (value: number) => void}} [slider]
 * @property {{value: number, unit: string, label: string, set: (value: number) => void}} [number]
 * @property {string} [link]
 */

/** Settings from 0 to 1. */
const SHARES = new Set(["opacity"]);

export function DisplaysPanel() {
  const filter = useSignal("");
  const closed = useSignal(/** @type {ReadonlySet<string>} */ (new Set(["grid", "layers"])));
  const active = useSignal("robot");
  const rows = treeRows(filter.value, closed.value);
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  useRevealSelection(closed, panel);
  /** @param {string} id @param {boolean} open */
  const setOpen = (id, open) => {
    const now = new Set(closed.value);
    if (open) now.delete(id);
    else now.add(id);
    closed.value = now;
  };
  return html`<section ref=${panel} class="panel-body" aria-label=${t("panel.displays")}>
    <div class="panel-bar">
      <${SearchBox} label=${t("displays.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
    </div>
    ${rows.length === 0 && filter.value === "" && html`<${EmptyState} icon="robot" title=${t("urdf.none")} />`}
    ${rows.length > 0 && html`<${Tree} rows=${rows} active=${active} setOpen=${setOpen} />`}
    ${rows.length === 0 && filter.value !== "" && html`<p class="nothing">${t("filter.nothing", { words: filter.value })}</p>`}
    <${LinkDetails} />
  </section>`;
}

/** A link selected elsewhere is unfolded and scrolled to; one selected here stays in view above its details. @param {{value: ReadonlySet<string>}} closed @param {{current: HTMLElement | null}} panel */
function useRevealSelection(closed, panel) {
  const link = selected.value;
  useEffect(() => {
    if (!link || !robot.value) return undefined;
    const reveal = () =>
      requestAnimationFrame(() => {
        document.getElementById(rowId(`link:${link}`))?.scrollIntoView({ block: "nearest" });
      });
    if (selection.value?.by === "displays") {
      const asked = reveal();
      return () => cancelAnimationFrame(asked);
    }
    const way = ["robot", "links", ...ancestorsOf(robot.value, link).map((name) => `link:${name}`)];
    closed.value = new Set([...closed.value].filter((id) => !way.includes(id)));
    return whenPlaced(panel.current, reveal);
  }, [link]);
}

/** @param {string} id */
const rowId = (id) => `row-${id}`;

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeRows(filter, closed) {
  return [...gridRows(filter, closed), ...robotRows(filter, closed)];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function robotRows(filter, closed) {
  const settings = displays.value.robot;
  if (!settings && !robot.value) return [];
  const below = [...layerRows(filter, closed), ...treeOfLinks(filter, closed)];
  if (below.length === 0 && !hit(t("display.robot"), filter)) return [];
  const open = filter !== "" || !closed.has("robot");
  const count = robot.value?.links.length ?? 0;
  /** @type {Row} */
  const head = {
    id: "robot",
    level: 1,
    label: t("display.robot"),
    icon: "robot",
    expandable: true,
    expanded: open,
    meta: count > 0 ? t("links.count", { count }) : "",
    ...eyeOf("robot", settings && "visible" in settings ? "visible" : "visual"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} text @param {string} filter */
const hit = (text, filter) => text.toLowerCase().includes(filter.trim().toLowerCase());

/** @param {"grid" | "robot"} display @param {string} name @returns {Pick<Row, "eye">} its switch, when it has one */
function eyeOf(display, name) {
  const value = displays.value[display]?.[name];
  if (typeof value !== "boolean") return {};
  const label = t("display.show", { name: settingLabel(display, name) });
  const set = (/** @type {boolean} */ on) => void setDisplay(display, name, on);
  return { eye: { on: value, label, set, shared: true } };
}

/** @param {string} display @param {string} name @returns {string} words for a setting, known or not */
function settingLabel(display, name) {
  const key = `display.${display}.${name}`;
  const words = t(key);
  return words === key ? name.replaceAll("_", " ") : words;
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function gridRows(filter, closed) {
  const settings = displays.value.grid;
  if (!settings) return [];
  const below = settingRows("grid", 2, filter);
  if (below.length === 0 && !hit(t("display.grid"), filter)) return [];
  const open = filter !== "" || !closed.has("grid");
  const cell = settings.cell_m;
  /** @type {Row} */
  const head = {
    id: "grid",
    level: 1,
    label: t("display.grid"),
    icon: "grid",
    expandable: below.length > 0,
    expanded: open,
    meta: typeof cell === "number" ? `${formatNumber(cell, 4)} m` : "",
    ...eyeOf("grid", "visible"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function layerRows(filter, closed) {
  const below = settingRows("robot", 3, filter);
  if (below.length === 0) return [];
  const open = filter !== "" || !closed.has("layers");
  const on = below.filter(({ eye }) => eye?.on).map(({ label }) => label);
  /** @type {Row} */
  const head = {
    id: "layers",
    level: 2,
    label: t("display.layers"),
    icon: "layout",
    expandable: true,
    expanded: open,
    meta: open ? "" : on.join(", "),
  };
  return [head, ...(open ? below : [])];
}

/** @param {"grid" | "robot"} display @param {number} level @param {string} filter @returns {Row[]} */
function settingRows(display, level, filter) {
  return Object.entries(displays.value[display] ?? {})
    .filter(([name]) => name !== "visible" && hit(settingLabel(display, name), filter))
    .map(([name, value]) => settingRow(display, name, value, level));
}

/** @param {"grid" | "robot"} display @param {string} name @param {boolean | number | string} value @param {number} level @returns {Row} */
function settingRow(display, name, value, level) {
  const label = settingLabel(display, name);
  const row = { id: `${display}.${name}`, level, label, icon: "" };
  if (typeof value === "boolean") return { ...row, ...eyeOf(display, name) };
  if (typeof value === "string") return { ...row, meta: value };
  const set = (/** @type {number} */ one) => void setDisplay(display, name, one);
  if (SHARES.has(name)) return { ...row, slider: { value, label, set } };
  return { ...row, number: { value, label, set, unit: name.endsWith("_m") ? "m" : "" } };
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeOfLinks(filter, closed) {
  const folded = new Set(
    [...closed].filter((id) => id.startsWith("link:")).map((id) => id.slice(5)),
  );
  return linkRows(links.value, folded, filter, 2).map(linkRow);
}

/** @param {LinkRow} row @returns {Row} */
function linkRow({ node, level, expandable, expanded }) {
  const { name, mass_kg, visuals, collisions } = node.link;
  const visible = !hiddenLinks.value.has(name);
  const massless = mass_kg === null && visuals + collisions > 0;
  return {
    id: `link:${name}`,
    level,
    label: name,
    icon: "box",
    expandable,
    expanded,
    link: name,
    meta: massless ? t("link.no_inertia") : "",
    warn: massless,
    eye: {
      on: visible,
      label: t("display.show", { name }),
      set: (on) => showLink(name, on),
      shared: false,
    },
  };
}

/**
 * @param {{rows: Row[], active: {value: string}, setOpen: (id: string, open: boolean) => void}} props
 */
function Tree({ rows, active, setOpen }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const places = siblingPlaces(rows.map(({ level }) => level));
  const current = rows.some(({ id }) => id === active.value) ? active.value : (rows[0]?.id ?? "");
  /** @param {Row | undefined} row */
  const go = (row) => {
    if (!row) return;
    active.value = row.id;
    requestAnimationFrame(() => document.getElementById(rowId(row.id))?.focus());
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.target instanceof HTMLInputElement || event.ctrlKey || event.metaKey) return;
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
    ArrowRight: () => (row.expandable && !row.expanded ? setOpen(row.id, true) : go(rows[at + 1])),
    ArrowLeft: () =>
      row.expanded && row.expandable ? setOpen(row.id, false) : go(parentRow(rows, at)),
    Enter: () => pick(row),
    " ": () => row.eye && (!row.eye.shared || mayEdit.value) && row.eye.set(!row.eye.on),
  };
  const move = moves[event.key];
  move?.();
  return move !== undefined;
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
    else if (row.expandable) setOpen(row.id, !row.expanded);
  };
  return html`<div id=${rowId(row.id)} role="treeitem" class=${rowClass(row)} style=${`--level:${row.level}`}
    tabindex=${current ? 0 : -1} aria-level=${row.level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-label=${rowLabel(row)}
    aria-expanded=${row.expandable ? row.expanded : null} aria-selected=${isChosen(row)} onClick=${onClick}
    onDblClick=${() => row.link && focusLink(row.link)}
    onPointerEnter=${() => {
      hovered.value = row.link ?? null;
    }}>
    <${Twisty} row=${row} setOpen=${setOpen} />
    ${row.icon && html`<${Icon} name=${row.icon} size=${15} />`}
    <span class="tree-label" title=${row.label}>${row.link ? html`<${LongName} text=${row.label} />` : row.label}</span>
    ${row.meta && html`<span class=${`tree-meta ${row.warn ? "warn" : ""}`} title=${row.meta}>${row.meta}</span>`}
    ${row.slider && html`<${ShareSlider} ...${row.slider} />`}
    ${row.number && html`<${NumberBox} ...${row.number} />`}
    ${row.eye && html`<${Eye} eye=${row.eye} />`}
  </div>`;
}

/** @param {Row} row @returns {boolean} */
const isChosen = ({ link }) => link !== undefined && selected.value === link;

/** @param {Row} row @returns {string} */
function rowClass(row) {
  const { link, eye } = row;
  const states = [
    isChosen(row) && "chosen",
    link && hovered.value === link && "hovered",
    link && !eye?.on && "faded",
  ];
  return ["tree-row", ...states].filter(Boolean).join(" ");
}

/** @param {Row} row @returns {string} what a screen reader says, beside level and state */
function rowLabel({ label, meta, eye }) {
  return [label, meta, eye && !eye.on ? t("hidden") : ""].filter(Boolean).join(", ");
}

/** @param {{row: Row, setOpen: (id: string, open: boolean) => void}} props */
function Twisty({ row, setOpen }) {
  if (!row.expandable) return html`<span class="twisty"></span>`;
  /** @param {MouseEvent} event */
  const onClick = (event) => {
    event.stopPropagation();
    setOpen(row.id, !row.expanded);
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
  return html`<${TextBox} class="number narrow" label=${label} text=${value === 0 ? t("automatic") : formatNumber(value, 5)}
    disabled=${!mayEdit.value} onWrite=${onWrite} /><span class="unit">${unit}</span>`;
}
