/** A message as a tree: rows to unfold, paths and values to copy, numbers to drag into a plot. */

/** @import { EchoRow } from "../lib/echo-rows.js" */

import { html, useSignal } from "vendor/preact.js";
import { beginDrag, endDrag } from "../app/topic-drag.js";
import { copyText } from "../lib/clipboard.js";
import { echoRows } from "../lib/echo-rows.js";
import { t } from "../lib/i18n.js";
import { LongList, siblingPlaces } from "../lib/long-list.js";
import { Icon, IconButton } from "../lib/ui.js";
import { plot } from "../model/plotting.js";
import { notify } from "../model/view.js";

const MORE = 500;

/** @param {string} path */
const rowId = (path) => `echo-${path}`;

/**
 * @param {{topic: string, type: string, value: any, onMore: (path: string, count: number) => void,
 *   onCopy: (path: string) => void}} props
 */
export function EchoTree({ topic, type, value, onMore, onCopy }) {
  const toggled = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const active = useSignal("");
  const rows = echoRows(value, toggled.value);
  const places = siblingPlaces(rows.map(({ level }) => level));
  const current = rows.some(({ path }) => path === active.value)
    ? active.value
    : (rows[0]?.path ?? "");
  const toggle = (/** @type {string} */ path) => {
    const now = new Set(toggled.value);
    if (!now.delete(path)) now.add(path);
    toggled.value = now;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const to = moved(
      event,
      rows,
      rows.findIndex(({ path }) => path === current),
      toggle,
    );
    if (to === null) return;
    event.preventDefault();
    active.value = rows[to]?.path ?? current;
    requestAnimationFrame(() => document.getElementById(rowId(active.value))?.focus());
  };
  if (rows.length === 0) return html`<p class="note padded">${t("topics.empty")}</p>`;
  return html`<div class="tree echo-tree" role="tree" aria-label=${t("topics.echo.of", { topic })} onKeyDown=${onKeyDown}>
    <${LongList} items=${rows} keyOf=${(/** @type {EchoRow} */ { path }) => path} row="var(--row)"
      isKept=${(/** @type {EchoRow} */ { path }) => path === current}
      draw=${(/** @type {EchoRow} */ row, /** @type {number} */ at) =>
        html`<${Row} key=${row.path} topic=${topic} type=${type} row=${row} place=${places[at]} focusable=${row.path === current}
          onToggle=${() => toggle(row.path)} onMore=${onMore} onCopy=${onCopy} onFocus=${() => {
            active.value = row.path;
          }} />`} />
  </div>`;
}

/**
 * @param {KeyboardEvent} event @param {readonly EchoRow[]} rows @param {number} at
 * @param {(path: string) => void} toggle
 * @returns {number | null} the row to go to; null: the key is none of a tree's
 */
function moved({ key, ctrlKey, metaKey }, rows, at, toggle) {
  const row = rows[at];
  if (!row || ctrlKey || metaKey) return null;
  const fold = () => {
    toggle(row.path);
    return at;
  };
  const above = rows.findLastIndex((one, n) => n < at && one.level < row.level);
  /** @type {Record<string, () => number>} */
  const keys = {
    ArrowDown: () => Math.min(at + 1, rows.length - 1),
    ArrowUp: () => Math.max(at - 1, 0),
    Home: () => 0,
    End: () => rows.length - 1,
    ArrowRight: () =>
      row.expandable && !row.expanded ? fold() : Math.min(at + 1, rows.length - 1),
    ArrowLeft: () => (row.expanded ? fold() : Math.max(above, 0)),
  };
  return keys[key]?.() ?? null;
}

/**
 * @param {{topic: string, type: string, row: EchoRow, place: {at: number, of: number} | undefined, focusable: boolean, onToggle: () => void,
 *   onMore: (path: string, count: number) => void, onCopy: (path: string) => void, onFocus: () => void}} props
 */
function Row({ topic, type, row, place, focusable, onToggle, onMore, onCopy, onFocus }) {
  const { path, name, level, text, whole, expandable, expanded, numeric, shown, more } = row;
  const moreWords = more > 0 && expanded ? t("topics.more", { count: more }) : "";
  const what = { topic, type, kind: "", path };
  const scalar = numeric && !expandable;
  return html`<div id=${rowId(path)} role="treeitem" class="tree-row echo-row" style=${`--level:${level}`} tabindex=${focusable ? 0 : -1}
    aria-level=${level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-expanded=${expandable ? expanded : null} aria-label=${[name, moreWords, text].filter(Boolean).join(" ")}
    title=${path} draggable=${numeric} onFocus=${onFocus} onClick=${() => expandable && onToggle()}
    onDragStart=${(/** @type {DragEvent} */ event) => beginDrag(event, what)} onDragEnd=${endDrag}>
    <span class="twisty" aria-hidden="true">${expandable && html`<${Icon} name=${expanded ? "chevronDown" : "chevronRight"} size=${14} />`}</span>
    <span class="echo-name">${name}</span>${" "}
    <span class=${`echo-value numbers ${scalar ? "scalar" : ""}`} title=${expanded ? null : whole}>${expanded ? "" : text}</span>
    <span class="echo-tools" onClick=${(/** @type {Event} */ event) => event.stopPropagation()}>
      ${moreWords && html`<button type="button" class="echo-more" onClick=${() => onMore(path, shown + MORE)}>${moreWords}</button>`}
      ${numeric && html`<${IconButton} icon="plot" label=${t("topics.plot", { path })} size=${14} onClick=${() => plot(topic, path)} />`}
      <${IconButton} icon="link" label=${t("topics.copy_path", { path })} size=${14} onClick=${() => copyPath(path)} />
      <${IconButton} icon="copy" label=${t("topics.copy_value", { path })} size=${14} onClick=${() => onCopy(path)} />
    </span>
  </div>`;
}

/** @param {string} path */
async function copyPath(path) {
  const done = await copyText(path);
  notify(done ? t("topics.copied_path", { path }) : t("copy.failed"), { bad: !done });
}
