/** What the nodes of ROS 2 say: by level, node and words, the newest at the bottom. */

/** @import { LogLine } from "../../types/wire.d.ts" */
/** @import { Filter } from "../../model/log.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { t } from "../../lib/i18n.js";
import { Icon, IconButton, isAtEnd, SearchBox } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import {
  clearLog,
  clockTime,
  followLog,
  goneBefore,
  LEVELS,
  levelOf,
  logFilter,
  logLines,
  logRefused,
  logText,
  matchingLines,
  missed,
  nodesOf,
} from "../../model/log.js";
import { notify } from "../../model/view.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../parts.js";

const ICONS = { debug: "info", info: "info", warn: "alert", error: "error", fatal: "error" };

export function LogPanel() {
  const { panel } = useLooking(followLog);
  /** What is shown while the log stands still; null: it goes on. */
  const frozen = useSignal(/** @type {readonly LogLine[] | null} */ (null));
  const lines = frozen.value ?? logLines.value;
  return html`<section ref=${panel} class="panel-body log" aria-label=${t("panel.log")}>
    <${RouterAway} />
    ${lines.length === 0 && isUnconnected() ? html`<${ConnectFirst} icon="log" />` : html`<${Content} lines=${lines} filter=${logFilter} frozen=${frozen} />`}
  </section>`;
}

/** @param {{lines: readonly LogLine[], filter: Signal<Filter>, frozen: Signal<readonly LogLine[] | null>}} props */
function Content({ lines, filter, frozen }) {
  const chosen = useSignal(/** @type {LogLine | null} */ (null));
  const shown = matchingLines(lines, filter.value);
  return html`<${Bar} lines=${lines} shown=${shown} filter=${filter} frozen=${frozen} />
    ${logRefused.value && html`<p class="note bad padded" role="alert">${logRefused.value}</p>`}
    ${missed.value > 0 && html`<p class="note padded">${t("log.missed", { count: missed.value })}</p>`}
    <${Lines} shown=${shown} chosen=${chosen} nothing=${nothingWords(lines.length, shown.length)} />
    ${chosen.value && html`<${Details} line=${chosen.value} chosen=${chosen} />`}`;
}

/** @param {number} all @param {number} shown @returns {string} why the list is empty */
function nothingWords(all, shown) {
  if (shown > 0) return "";
  return all === 0 ? t("log.none") : t("log.filtered", { count: all });
}

/** @param {readonly LogLine[]} lines @param {string} chosen which may have said nothing yet @returns {string[]} */
const named = (lines, chosen) => [...new Set([...nodesOf(lines), ...(chosen ? [chosen] : [])])];

/** @param {{lines: readonly LogLine[], shown: readonly LogLine[], filter: Signal<Filter>, frozen: Signal<readonly LogLine[] | null>}} props */
function Bar({ lines, shown, filter, frozen }) {
  const change = (/** @type {Partial<Filter>} */ news) => {
    filter.value = { ...filter.value, ...news };
  };
  const isPaused = frozen.value !== null;
  const pause = () => {
    frozen.value = isPaused ? null : logLines.value;
  };
  const copy = async () => {
    const done = await copyText(logText(shown));
    notify(done ? t("log.copied", { count: shown.length }) : t("copy.failed"), { bad: !done });
  };
  const clear = () => {
    clearLog();
    frozen.value = null;
  };
  return html`<div class="panel-bar log-bar">
    <${SearchBox} label=${t("log.search")} value=${filter.value.words} onInput=${(/** @type {string} */ words) => change({ words })} />
    <select class="box" aria-label=${t("log.level")} value=${filter.value.level} onChange=${(/** @type {any} */ event) => change({ level: event.currentTarget.value })}>
      ${Object.keys(LEVELS).map((one) => html`<option key=${one} value=${one}>${t(`log.level.${one}`)}</option>`)}</select>
    <select class="box" aria-label=${t("log.node")} value=${filter.value.node} onChange=${(/** @type {any} */ event) => change({ node: event.currentTarget.value })}>
      <option value="">${t("log.all_nodes")}</option>
      ${named(lines, filter.value.node).map((one) => html`<option key=${one} value=${one}>${one}</option>`)}</select>
    <${IconButton} icon=${isPaused ? "animate" : "pause"} label=${t(isPaused ? "log.go_on" : "log.pause")} pressed=${isPaused} onClick=${pause} />
    <${IconButton} icon="copy" label=${t("log.copy")} disabled=${shown.length === 0} onClick=${copy} />
    <${IconButton} icon="trash" label=${t("log.clear")} disabled=${lines.length === 0} onClick=${clear} />
  </div>`;
}

/** @param {{shown: readonly LogLine[], chosen: Signal<LogLine | null>, nothing: string}} props */
function Lines({ shown, chosen, nothing }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const follows = useSignal(true);
  const view = useSignal({ row_px: 0, top_px: 0, view_px: 0 });
  const measure = () => {
    const element = list.current;
    const row_px = element?.querySelector(".log-measure")?.getBoundingClientRect().height ?? 0;
    if (!element || row_px === 0) return;
    view.value = { row_px, top_px: element.scrollTop, view_px: element.clientHeight };
  };
  const onScroll = () => {
    const element = list.current;
    if (!element) return;
    follows.value = isAtEnd(element);
    measure();
  };
  const toEnd = () => list.current?.scrollTo({ top: list.current.scrollHeight });
  useEffect(() => {
    const watcher = new ResizeObserver(() => {
      measure();
      if (follows.peek()) toEnd();
    });
    if (list.current) watcher.observe(list.current);
    return () => watcher.disconnect();
  }, []);
  const before = useRef(shown);
  useLayoutEffect(() => {
    const gone = goneBefore(before.current, shown);
    before.current = shown;
    if (follows.peek()) toEnd();
    // What is read stays where it is when the oldest lines go.
    else list.current?.scrollBy({ top: -gone * view.peek().row_px });
  }, [shown]);
  const { row_px } = view.value;
  const { from, to } = rowsNear({ count: shown.length, ...view.value });
  const above = html`<div style=${`height:${from * row_px}px`}></div>`;
  return html`<div class="log-place">
    <div class="scroll log-list" role="log" aria-live="off" aria-label=${t("panel.log")} tabindex="0" ref=${list} onScroll=${onScroll}>
      <div class="log-line log-measure" aria-hidden="true">0</div>
      ${above}
      ${shown.slice(from, to).map((line) => html`<${Line} key=${line.number} line=${line} chosen=${chosen} />`)}
      <div style=${`height:${(shown.length - to) * row_px}px`}></div>
      ${nothing && html`<${NothingThere} icon="log" title=${nothing} />`}
    </div>
    ${!follows.value && html`<button type="button" class="button small log-follow" onClick=${toEnd}><${Icon} name="chevronDown" size=${13} />${t("log.follow")}</button>`}
  </div>`;
}

/** @param {{line: LogLine, chosen: Signal<LogLine | null>}} props */
function Line({ line, chosen }) {
  const level = levelOf(line.level);
  const isChosen = chosen.value?.number === line.number;
  const choose = () => {
    chosen.value = isChosen ? null : line;
  };
  return html`<button type="button" class=${`log-line ${level}`} aria-pressed=${isChosen} onClick=${choose}>
    <span class="log-time">${clockTime(line.stamp_s)}</span>
    <span class="log-level"><${Icon} name=${ICONS[level]} size=${12} />${t(`log.level.${level}`)}</span>
    <span class="log-node">${line.node}</span>
    <span class="log-text">${line.text}</span></button>`;
}

/** @param {{line: LogLine, chosen: Signal<LogLine | null>}} props the whole of a line, and where in the code it was said */
function Details({ line, chosen }) {
  const place = [line.file && `${line.file}:${line.line}`, line.function]
    .filter(Boolean)
    .join(" · ");
  const copy = async () => {
    const done = await copyText(logText([line]));
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  const close = () => {
    chosen.value = null;
  };
  return html`<section class="log-details" aria-label=${t("log.details")}>
    <header><strong>${line.node}</strong><span class="muted">${place}</span><span class="push"></span>
      <${IconButton} icon="copy" label=${t("log.copy_line")} size=${14} onClick=${copy} />
      <${IconButton} icon="close" label=${t("close")} size=${14} onClick=${close} /></header>
    <pre>${line.text}</pre>
  </section>`;
}

/** Rows beyond the view, so that a turn of the wheel finds them drawn. */
const BEYOND = 12;

/**
 * Which rows of a long list of equal heights are near the view: only these are drawn.
 *
 * @param {{count: number, row_px: number, top_px: number, view_px: number}} list how far it is scrolled, and how high its view is
 * @returns {{from: number, to: number}} rows, the last one not among them
 */
export function rowsNear({ count, row_px, top_px, view_px }) {
  if (row_px <= 0) return { from: 0, to: 0 };
  const first = Math.floor(top_px / row_px) - BEYOND;
  const last = Math.ceil((top_px + view_px) / row_px) + BEYOND;
  const from = Math.max(0, Math.min(first, count));
  return { from, to: Math.max(from, Math.min(last, count)) };
}
