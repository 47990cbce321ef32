/** Which files the robot is made of, who includes whom, and the macros that there are to call. */

/** @import { FileRow } from "../lib/outline.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { Refusal } from "../app/refusal.js";
import { fetchOutline, outline, outlineRefused } from "../app/state/outline.js";
import { t } from "../lib/i18n.js";
import { LongList, siblingPlaces } from "../lib/long-list.js";
import { fileRows, macrosOf, valuesOf } from "../lib/outline.js";
import { baseName, shortPath } from "../lib/paths.js";
import { EmptyState, Icon, SearchBox } from "../lib/ui.js";
import { connection, documentId } from "../model/connection.js";
import { built, documentState } from "../model/document.js";
import { showFile, shownFile } from "../model/source.js";
import { MacroList } from "./outline-macros.js";

const SETTLE_MS = 400;
const VALUES_SHOWN = 300;

export function OutlinePanel() {
  useFresh();
  const filter = useSignal("");
  const known = outline.value;
  if (!known || known.files.length === 0) {
    return html`<section class="panel-body" aria-label=${t("panel.outline")}>
      ${
        known || !outlineRefused.value
          ? html`<${EmptyState} icon="includes" title=${known ? t("outline.none") : t("loading")} />`
          : html`<${Refusal} sentence=${outlineRefused.value} again=${fetchOutline} />`
      }</section>`;
  }
  const rows = { macros: macrosOf(known, filter.value), values: valuesOf(known, filter.value) };
  return html`<section class="panel-body" aria-label=${t("panel.outline")}>
    <div class="panel-bar">
      <${SearchBox} label=${t("outline.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
    </div>
    <div class="outline scroll">
      ${!known.is_current && html`<p class="outline-note"><${Icon} name="info" size=${13} />${t("outline.stale")}</p>`}
      <${Files} filter=${filter.value} />
      <${Part} id="macros" count=${rows.macros.length}><${MacroList} macros=${rows.macros} filter=${filter.value} /><//>
      <${Part} id="values" count=${rows.values.length} closed><${Values} values=${rows.values} filter=${filter.value} /><//>
    </div>
  </section>`;
}

/** Asks again when the texts have rested, not at every step of a drag. */
function useFresh() {
  const run = built.value;
  const there = connection.value === "connected" && documentId.value !== "";
  useEffect(() => {
    if (!there) return undefined;
    const later = setTimeout(fetchOutline, outline.peek() ? SETTLE_MS : 0);
    return () => clearTimeout(later);
  }, [run, there]);
}

/** @param {{id: string, count: number, closed?: boolean, children?: unknown}} props a heading that folds what is below it */
function Part({ id, count, closed = false, children }) {
  const open = useSignal(!closed);
  const toggle = () => {
    open.value = !open.value;
  };
  return html`<section class="outline-part">
    <h3><button type="button" aria-expanded=${open.value} onClick=${toggle}>
      <${Icon} name=${open.value ? "chevronDown" : "chevronRight"} size=${14} />${t(`outline.${id}`)}<span class="muted numbers">${count}</span>
    </button></h3>
    ${open.value && children}
  </section>`;
}

/** @param {{filter: string}} props */
function Files({ filter }) {
  const closed = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const active = useSignal("0");
  const rows = fileRows(outline.value?.files ?? [], closed.value, filter);
  if (rows.length === 0 && filter !== "") return null;
  const places = siblingPlaces(rows.map(({ level }) => level));
  /** @param {FileRow} row @param {boolean} open */
  const setOpen = ({ id }, open) => {
    const now = new Set(closed.value);
    if (open) now.delete(id);
    else now.add(id);
    closed.value = now;
  };
  const focusable = rows.some(({ id }) => id === active.value) ? active.value : rows[0]?.id;
  /** @param {KeyboardEvent} event */
  const onKey = (event) => {
    const at = rows.findIndex(({ id }) => id === focusable);
    const to = moved(event, rows, at, setOpen);
    if (to === null) return;
    event.preventDefault();
    const id = rows[Math.min(Math.max(to, 0), rows.length - 1)]?.id ?? "0";
    active.value = id;
    const focus = () => document.getElementById(rowId(id))?.focus();
    if (document.getElementById(rowId(id))) focus();
    else requestAnimationFrame(focus);
  };
  return html`<${Part} id="files" count=${rows.length}>
    <div class="outline-tree" role="tree" aria-label=${t("outline.files")} onKeyDown=${onKey}>
      <${LongList} items=${rows} keyOf=${(/** @type {FileRow} */ { id }) => id} row="var(--row)"
        isKept=${(/** @type {FileRow} */ { id }) => id === focusable}
        draw=${(/** @type {FileRow} */ row, /** @type {number} */ at) =>
          html`<${FileLine} key=${row.id} row=${row} place=${places[at]} focusable=${row.id === focusable} setOpen=${setOpen} />`} /></div><//>`;
}

/** @param {string} id */
const rowId = (id) => `outline-file-${id}`;

/**
 * @param {KeyboardEvent} event @param {readonly FileRow[]} rows @param {number} at
 * @param {(row: FileRow, open: boolean) => void} setOpen
 * @returns {number | null} the row to go to; null: the key is none of a tree's
 */
function moved({ key }, rows, at, setOpen) {
  const row = rows[at];
  if (!row) return null;
  /** @type {Record<string, () => number>} */
  const keys = {
    ArrowDown: () => at + 1,
    ArrowUp: () => at - 1,
    Home: () => 0,
    End: () => rows.length - 1,
    ArrowRight: () => {
      if (row.expanded || !row.expandable) return row.expanded ? at + 1 : at;
      setOpen(row, true);
      return at;
    },
    ArrowLeft: () => {
      if (row.expanded) setOpen(row, false);
      return row.expanded ? at : rows.findLastIndex((one, n) => n < at && one.level < row.level);
    },
    Enter: () => {
      showFile(row.file.file);
      return at;
    },
  };
  return keys[key]?.() ?? null;
}

/**
 * @param {{row: FileRow, place: {at: number, of: number} | undefined, focusable: boolean,
 *   setOpen: (row: FileRow, open: boolean) => void}} props
 */
function FileLine({ row, place, focusable, setOpen }) {
  const { file, level, expandable, expanded } = row;
  const root = documentState.value?.root ?? "";
  const icon = expanded ? "chevronDown" : "chevronRight";
  return html`<div id=${rowId(row.id)} class=${`tree-row ${shownFile.value === file.file ? "chosen" : ""}`} role="treeitem"
    aria-level=${level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-expanded=${expandable ? expanded : null} aria-selected=${shownFile.value === file.file}
    tabindex=${focusable ? 0 : -1} style=${`--level:${level}`} title=${shortPath(file.file, root)} onClick=${() => showFile(file.file)}>
    <span class="twisty" onClick=${(/** @type {MouseEvent} */ event) => {
      event.stopPropagation();
      if (expandable) setOpen(row, !expanded);
    }}>${expandable && html`<${Icon} name=${icon} size=${14} />`}</span>
    <${Icon} name=${file.is_yaml ? "fileCode" : "file"} size=${14} />
    <span class="tree-label">${baseName(file.file)}</span>
    ${file.namespace && html`<span class="outline-space" title=${t("outline.namespace")}>${file.namespace}</span>`}
    ${file.place && html`<span class="tree-meta" onClick=${(/** @type {MouseEvent} */ event) => event.stopPropagation()}><${PlaceLink} place=${file.place} words=${t("outline.line", { line: file.place.line })} /></span>`}
  </div>`;
}

/** @param {{values: import("../types/wire.d.ts").OutlineValue[], filter: string}} props */
function Values({ values, filter }) {
  if (values.length === 0)
    return html`<p class="nothing">${filter ? t("filter.nothing", { words: filter }) : t("outline.no_values")}</p>`;
  const more = values.length - VALUES_SHOWN;
  return html`<ul class="outline-values">${values.slice(0, VALUES_SHOWN).map(
    (one, at) => html`<li key=${`${one.name} ${at}`} title=${one.doc || null}>
      <${PlaceLink} place=${one.place} words=${one.name} />
      <code class="muted">${one.values.length > 0 ? one.values.join(" · ") : one.text}</code></li>`,
  )}</ul>${more > 0 && html`<p class="nothing">${t("outline.more", { count: more })}</p>`}`;
}
