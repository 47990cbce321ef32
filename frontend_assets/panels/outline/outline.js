/** Which files the robot is made of, who includes whom, and the macros that there are to call. */

/** @import { Outline, OutlineFile, OutlineMacro, OutlineValue, Parameter } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { LongList, siblingPlaces } from "../../lib/long-list.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { EmptyState, Icon, SearchBox } from "../../lib/ui.js";
import { askOrKeepWhy } from "../../model/asking.js";
import { connection, documentId, mayEdit } from "../../model/connection.js";
import { built, documentState } from "../../model/document.js";
import { showFile, shownFile, showSource, writeSnippet } from "../../model/source.js";
import { PlaceLink, Refusal } from "../parts.js";

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

/** @param {{values: import("../../types/wire.d.ts").OutlineValue[], filter: string}} props */
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

/** @typedef {{key: string, macro: OutlineMacro}} Keyed */

/**
 * The macros of a robot's files: what they take, what they say of themselves, where they are
 * called.
 *
 * @param {{macros: OutlineMacro[], filter: string}} props
 */
function MacroList({ macros, filter }) {
  const open = useSignal("");
  if (macros.length === 0)
    return html`<p class="nothing">${filter ? t("filter.nothing", { words: filter }) : t("outline.no_macros")}</p>`;
  const rows = macros.map((macro, at) => ({
    macro,
    key: `${macro.name} ${macro.place.file} ${macro.place.line} ${at}`,
  }));
  /** @param {string} key */
  const toggle = (key) => {
    open.value = open.value === key ? "" : key;
  };
  return html`<div role="list" class="outline-macros"><${LongList} items=${rows} keyOf=${(/** @type {Keyed} */ { key }) => key} row="var(--row)"
    isKept=${(/** @type {Keyed} */ { key }) => key === open.value}
    draw=${(/** @type {Keyed} */ { key, macro }) =>
      html`<${MacroRow} key=${key} macro=${macro} open=${open.value === key} toggle=${() => toggle(key)} />`} /></div>`;
}

/** @param {{macro: OutlineMacro, open: boolean, toggle: () => void}} props */
function MacroRow({ macro, open, toggle }) {
  const { name, calls } = macro;
  return html`<div role="listitem" class=${`outline-macro ${open ? "open" : ""}`}>
    <button type="button" class="row-button outline-name" aria-expanded=${open} onClick=${toggle}>
      <${Icon} name="macro" size=${14} /><span>${name}</span>
      <span class="muted numbers" title=${t("language.calls", { count: calls })}>${calls}×</span>
    </button>
    ${open && html`<${MacroDetails} macro=${macro} />`}
  </div>`;
}

/** @param {{macro: OutlineMacro}} props */
function MacroDetails({ macro }) {
  const { doc, parameters, place, called_at: places, calls } = macro;
  const insert = () => {
    const { text, stops } = callOf(macro);
    writeSnippet(text, stops);
  };
  const hint = shownFile.value === "" ? t("outline.insert_hint") : t("outline.insert");
  return html`<div class="outline-details">
    ${doc && html`<p class="outline-doc">${doc}</p>`}
    ${parameters.length > 0 && html`<ul class="outline-params" aria-label=${t("outline.parameters")}>${parameters.map((one) => html`<${ParameterLine} key=${one.name} parameter=${one} />`)}</ul>`}
    <p class="outline-calls">${calls === 0 ? t("outline.never_called") : t("outline.called_at")} ${places.map((one, at) => html`${at > 0 && " · "}<${PlaceLink} place=${one} />`)}</p>
    <div class="row">
      <button type="button" class="button small" onClick=${() => showSource(place.file, place.line, place.column)}><${Icon} name="definition" size=${14} />${t("outline.definition")}</button>
      ${mayEdit.value && html`<button type="button" class="button small" disabled=${shownFile.value === ""} title=${hint} onClick=${insert}><${Icon} name="plus" size=${14} />${t("outline.insert")}</button>`}
    </div>
  </div>`;
}

/** @param {{parameter: Parameter}} props */
function ParameterLine({ parameter: { name, kind, default: text, forwards } }) {
  const words = kind === "value" ? defaultWords(text, forwards) : t(`outline.${kind}`);
  return html`<li><code>${name}</code> <span class="muted">${words}</span></li>`;
}

/** @param {string | null} text @param {boolean} forwards */
function defaultWords(text, forwards) {
  if (forwards) return text ? t("outline.forwards_or", { text }) : t("outline.forwards");
  return text === null ? t("outline.required") : t("outline.default", { text: text || "''" });
}

/** @type {Signal<Outline | null>} */
export const outline = signal(null);

/** Why the last request for it failed; empty: it did not. */
const outlineRefused = signal("");

/** Ask for it again. */
async function fetchOutline() {
  const answer = await askOrKeepWhy({ type: "get_outline" }, outlineRefused);
  if (answer?.type === "outline") outline.value = answer.outline;
}

/**
 * @typedef {object} FileRow a file where it is included
 * @property {string} id
 * @property {OutlineFile} file
 * @property {number} level from 1
 * @property {boolean} expandable
 * @property {boolean} expanded
 */

/**
 * @param {readonly OutlineFile[]} files each below the one whose number is its `inside`
 * @param {ReadonlySet<string>} closed ids whose files are hidden
 * @param {string} filter empty shows all; else files whose name matches and the way to them
 * @returns {FileRow[]} in the order in which they are shown
 */
export function fileRows(files, closed, filter) {
  const below = /** @type {number[][]} */ (files.map(() => []));
  files.forEach(({ inside }, at) => {
    if (inside >= 0 && inside !== at) below[inside]?.push(at);
  });
  const wanted = filter.trim().toLowerCase();
  const shown = wanted === "" ? null : wayTo(files, wanted);
  /** @type {FileRow[]} */
  const rows = [];
  /** @param {number} at @param {number} level */
  const add = (at, level) => {
    const file = files[at];
    if (!file || (shown && !shown.has(at))) return;
    const id = `${at}`;
    const inside = below[at] ?? [];
    const expanded = inside.length > 0 && (shown !== null || !closed.has(id));
    rows.push({ id, file, level, expandable: inside.length > 0, expanded });
    if (expanded) for (const one of inside) add(one, level + 1);
  };
  files.forEach(({ inside }, at) => {
    if (inside < 0) add(at, 1);
  });
  return rows;
}

/** @param {readonly OutlineFile[]} files @param {string} wanted lower case @returns {Set<number>} those that match, and what includes them */
function wayTo(files, wanted) {
  /** @type {Set<number>} */
  const found = new Set();
  files.forEach(({ file }, start) => {
    const name = file.slice(file.lastIndexOf("/") + 1).toLowerCase();
    if (!name.includes(wanted)) return;
    for (let at = start; at >= 0 && !found.has(at); at = files[at]?.inside ?? -1) found.add(at);
  });
  return found;
}

/** @param {Outline} outline @param {string} filter @returns {OutlineMacro[]} by name; all words of the filter are in name, documentation or parameters */
export function macrosOf({ macros }, filter) {
  const words = wordsOf(filter);
  const found = macros.filter(({ name, doc, parameters }) =>
    holds(`${name} ${doc} ${parameters.map((one) => one.name).join(" ")}`, words),
  );
  return found.sort((a, b) => a.name.localeCompare(b.name));
}

/** @param {Outline} outline @param {string} filter @returns {OutlineValue[]} args first, each by name */
export function valuesOf({ values }, filter) {
  const words = wordsOf(filter);
  const found = values.filter(({ name, doc }) => holds(`${name} ${doc}`, words));
  return found.sort((a, b) => a.kind.localeCompare(b.kind) || a.name.localeCompare(b.name));
}

/** @param {string} filter */
const wordsOf = (filter) => filter.toLowerCase().split(/\s+/).filter(Boolean);

/** @param {string} text @param {readonly string[]} words lower case */
function holds(text, words) {
  const low = text.toLowerCase();
  return words.every((word) => low.includes(word));
}

/**
 * @param {Pick<OutlineMacro, "name" | "parameters">} macro
 * @returns {{text: string, stops: [number, number][]}} a call with what it must give, and where that is typed
 */
export function callOf({ name, parameters }) {
  let text = `<xacro:${name}`;
  /** @type {[number, number][]} */
  const stops = [];
  const stop = () => stops.push([text.length, text.length]);
  for (const one of parameters) {
    if (one.kind !== "value" || one.default !== null || one.forwards) continue;
    text += ` ${one.name}="`;
    stop();
    text += '"';
  }
  if (parameters.every(({ kind }) => kind === "value")) return { text: `${text}/>`, stops };
  text += ">";
  stop();
  return { text: `${text}</xacro:${name}>`, stops };
}
