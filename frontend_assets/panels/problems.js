/** What is wrong: how bad, in one sentence, where, and one click that mends it when there is one. */

/**
 * @import { Problem } from "../types/wire.d.ts"
 * @import { FileProblems, Severity } from "../lib/problem-list.js"
 */

import { html, useSignal } from "vendor/preact.js";
import { mendAll } from "../app/actions.js";
import { mayEdit } from "../app/state/connection.js";
import { documentState, problems } from "../app/state/document.js";
import { notify } from "../app/state/view.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { shortPath } from "../lib/paths.js";
import {
  asText,
  byFile,
  counts,
  filtered,
  keyOf,
  mendable,
  SEVERITIES,
} from "../lib/problem-list.js";
import { EmptyState, Icon, IconButton, SearchBox } from "../lib/ui.js";
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

/** @param {{files: readonly FileProblems[]}} props arrow keys move from row to row */
function List({ files }) {
  const root = documentState.value?.root ?? "";
  return html`<div class="problems scroll" role="region" aria-label=${t("problems.list")} onKeyDown=${onArrow}>
    ${files.map(
      ({ file, problems: those }) => html`<section key=${file} class="problem-file">
      <h3 title=${file}><${Icon} name=${file ? "fileCode" : "robot"} size=${13} />
        <span>${file ? shortPath(file, root) : t("problems.nowhere")}</span>
        <span class="muted numbers">${those.length}</span></h3>
      <ul>${rows(those)}</ul></section>`,
    )}
  </div>`;
}

/** @param {readonly Problem[]} those two that say the same are told apart by their order */
function rows(those) {
  /** @type {Map<string, number>} */
  const seen = new Map();
  return those.map((problem) => {
    const own = keyOf(problem);
    const number = (seen.get(own) ?? 0) + 1;
    seen.set(own, number);
    return html`<${ProblemRow} key=${`${own}#${number}`} problem=${problem} />`;
  });
}

/** @param {KeyboardEvent} event */
function onArrow(event) {
  const list = /** @type {HTMLElement} */ (event.currentTarget);
  const all = /** @type {HTMLElement[]} */ ([...list.querySelectorAll(".problem-main")]);
  const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  /** @type {Record<string, number>} */
  const moves = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: all.length - 1 };
  const to = moves[event.key];
  if (to === undefined || at < 0) return;
  event.preventDefault();
  all[Math.min(Math.max(to, 0), all.length - 1)]?.focus();
}
