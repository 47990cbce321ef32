/** What is wrong: how bad, in one sentence, where, and one click that mends it when there is one. */

/** @import { Problem } from "../types/wire.d.ts" */
/** @import { FileProblems, Severity } from "../lib/problem-list.js" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { LongList } from "../lib/long-list.js";
import { shortPath } from "../lib/paths.js";
import {
  asText,
  byFile,
  counts,
  filtered,
  keyed,
  mendable,
  SEVERITIES,
} from "../lib/problem-list.js";
import { EmptyState, Icon, IconButton, SearchBox } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { documentState, problems } from "../model/document.js";
import { mendAll } from "../model/requests.js";
import { notify } from "../model/view.js";
import { ProblemRow, SEVERITY_ICONS } from "./problem-row.js";

export function ProblemsPanel() {
  const words = useSignal("");
  const hidden = useSignal(/** @type {ReadonlySet<Severity>} */ (new Set()));
  const all = problems.value;
  if (all.length === 0) {
    return html`<section class="panel-body" aria-label=${t("panel.problems")}>
      <${EmptyState} icon="check" title=${t("problems.none")} /></section>`;
  }
  const files = byFile(filtered(all, words.value, hidden.value));
  const clear = () => {
    words.value = "";
    hidden.value = new Set();
  };
  return html`<section class="panel-body problems-panel" aria-label=${t("panel.problems")}>
    <${Bar} all=${all} files=${files} words=${words} hidden=${hidden} />
    ${
      files.length === 0
        ? html`<${EmptyState} icon="filter" title=${t("problems.no_match")}>
          <button type="button" class="button" onClick=${clear}>${t("problems.show_all")}</button><//>`
        : html`<${List} files=${files} />`
    }
  </section>`;
}

/**
 * @param {{all: readonly Problem[], files: readonly FileProblems[], words: {value: string},
 *   hidden: {value: ReadonlySet<Severity>}}} props
 */
function Bar({ all, files, words, hidden }) {
  const count = mendable(all);
  const copy = async () => {
    if (await copyText(asText(files, (one) => t(`severity.${one}`)))) notify(t("copied"));
  };
  return html`<div class="panel-bar row problems-bar">
    <${SearchBox} label=${t("problems.filter")} value=${words.value}
      onInput=${(/** @type {string} */ text) => {
        words.value = text;
      }} />
    ${SEVERITIES.map((one) => html`<${SeverityChip} key=${one} severity=${one} count=${counts(all)[one]} hidden=${hidden} />`)}
    <span class="push"></span>
    ${
      count > 1 &&
      mayEdit.value &&
      html`<button type="button" class="button small primary" title=${t("problems.mend_all_hint")}
      onClick=${() => mendAll()}><${Icon} name="wand" size=${14} />${t("problems.mend_all", { count })}</button>`
    }
    <${IconButton} icon="copy" label=${t("problems.copy")} onClick=${copy} />
  </div>`;
}

/** @param {{severity: Severity, count: number, hidden: {value: ReadonlySet<Severity>}}} props shows or hides its kind */
function SeverityChip({ severity, count, hidden }) {
  if (count === 0) return null;
  const off = hidden.value.has(severity);
  const toggle = () => {
    const now = new Set(hidden.value);
    if (off) now.delete(severity);
    else now.add(severity);
    hidden.value = now;
  };
  const label = `${t(`problems.severity.${severity}`)}: ${count}`;
  return html`<button type="button" class=${`problem-chip ${severity}`} aria-pressed=${!off}
    aria-label=${label} title=${label} onClick=${toggle}>
    <${Icon} name=${SEVERITY_ICONS[severity]} size=${13} />${count}</button>`;
}

/** @typedef {{key: string, problem: Problem}} Keyed */

/** @param {{files: readonly FileProblems[]}} props arrow keys move from row to row */
function List({ files }) {
  const root = documentState.value?.root ?? "";
  /** The row that the keys went to: it is drawn wherever the view is. */
  const active = useSignal("");
  const groups = files.map(({ file, problems: those }) => ({ file, rows: keyed(those) }));
  const keys = groups.flatMap(({ rows }) => rows.map(({ key }) => key));
  return html`<div class="problems scroll" role="region" aria-label=${t("problems.list")}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => onArrow(event, keys, active)}>
    ${groups.map(
      ({ file, rows }) => html`<section key=${file} class="problem-file">
      <h3 title=${file}><${Icon} name=${file ? "fileCode" : "robot"} size=${13} />
        <span>${file ? shortPath(file, root) : t("problems.nowhere")}</span>
        <span class="muted numbers">${rows.length}</span></h3>
      <div role="list"><${LongList} items=${rows} keyOf=${(/** @type {Keyed} */ { key }) => key} row="52px"
        isKept=${(/** @type {Keyed} */ { key }) => key === active.value}
        draw=${(/** @type {Keyed} */ { key, problem }, /** @type {number} */ at) =>
          html`<${ProblemRow} key=${key} id=${key} problem=${problem} at=${at + 1} of=${rows.length} />`} /></div></section>`,
    )}
  </div>`;
}

/** @param {KeyboardEvent} event @param {readonly string[]} keys of all rows @param {{value: string}} active */
function onArrow(event, keys, active) {
  const list = /** @type {HTMLElement} */ (event.currentTarget);
  const own = document.activeElement?.closest(".problem")?.getAttribute("data-key") ?? "";
  const at = keys.indexOf(own);
  /** @type {Record<string, number>} */
  const moves = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: keys.length - 1 };
  const to = moves[event.key];
  if (to === undefined || at < 0 || !document.activeElement?.matches(".problem-main")) return;
  event.preventDefault();
  const next = keys[Math.min(Math.max(to, 0), keys.length - 1)] ?? "";
  const focus = () => rowOf(list, next)?.focus();
  active.value = next;
  if (rowOf(list, next)) focus();
  else requestAnimationFrame(focus);
}

/** @param {HTMLElement} list @param {string} key @returns {HTMLElement | null} */
const rowOf = (list, key) => list.querySelector(`[data-key="${CSS.escape(key)}"] .problem-main`);
