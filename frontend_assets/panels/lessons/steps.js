/** The steps of a lesson: checks that turn green, and the table of who has done them. */

/** @import { CheckView, LessonRow, StepView } from "../../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { saveAsFile } from "../../lib/files.js";
import { t } from "../../lib/i18n.js";
import { Icon } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { classState, leads } from "../../model/class.js";
import {
  csvOf,
  doneCount,
  followTable,
  isDone,
  steps,
  table,
  tableRefused,
} from "../../model/lesson-steps.js";
import { chosenLesson } from "../../model/lessons.js";
import { Refusal } from "../parts.js";

/** @param {{lines: readonly string[], view: StepView | undefined}} props `view` lacks until the studio told */
export function Step({ lines, view }) {
  const done = view !== undefined && isDone(view);
  return html`<div class=${`lesson-step ${done ? "done" : ""}`} role="group" aria-label=${t("lessons.step")}>
    <ul>${view ? view.checks.map((check) => html`<${CheckLine} key=${check.line} check=${check} />`) : lines.map((line) => html`<li key=${line}><span class="lesson-mark" aria-hidden="true"></span><span>${line}</span></li>`)}</ul>
    <p class="lesson-done" role="status">${done && html`<${Icon} name="check" size=${14} />${t("lessons.done_at", { time: timeOf(view?.done_s) })}`}</p></div>`;
}

/** @param {{check: CheckView}} props */
function CheckLine({ check: { kind, line, values, ok, code, found } }) {
  const state = t(ok ? "lessons.check.holds" : "lessons.check.open");
  return html`<li class=${ok ? "ok" : ""}><span class="lesson-mark" role="img" aria-label=${state} title=${state}>${ok && html`<${Icon} name="check" size=${12} />`}</span>
    <span><span title=${line}>${kind ? t(`lessons.check.${kind}`, wordsOf(values)) : line}</span>${!ok && code && html`<small>${t(`lessons.missing.${code}`, wordsOf(found))}</small>`}</span></li>`;
}

/** @param {Record<string, string>} values @returns {Record<string, string | number>} with panels by their titles */
const wordsOf = (values) => ({
  ...values,
  ...(values.panel && { panel: t(`panel.${values.panel}`) }),
  ...(values.count && { count: Number(values.count) }),
});

/** @param {number | null | undefined} at_s since the epoch */
const timeOf = (at_s) =>
  new Date((at_s ?? 0) * 1000).toLocaleTimeString([], { timeStyle: "short" });

/** How far one is, and for who leads the class, who else. */
export function Progress() {
  const isShown = useSignal(false);
  const people = classState.value;
  const hasClass = leads.value && people !== null && (people.open || people.members.length > 0);
  if (steps.value.length === 0) return null;
  const toggle = () => {
    isShown.value = !isShown.value;
  };
  return html`<div class="lesson-progress"><span role="status">${t("lessons.progress", { done: doneCount.value, count: steps.value.length })}</span>
    <progress max=${steps.value.length} value=${doneCount.value} aria-label=${t("lessons.progress.bar")}></progress>
    ${hasClass && html`<button type="button" class="button small" aria-expanded=${isShown.value} onClick=${toggle}><${Icon} name="users" size=${13} />${t("lessons.table")}</button>`}</div>
    ${hasClass && isShown.value && html`<${Table} />`}`;
}

/** Names by steps. */
function Table() {
  const { panel } = useLooking(followTable);
  const all = table.value?.lesson === chosenLesson.value ? table.value : null;
  const rows = all?.rows ?? [];
  const heads = (all?.steps ?? []).map(
    (step, at) => `${at + 1}. ${step.heading || t("lessons.step")}`,
  );
  const save = () =>
    all &&
    saveAsFile(`${all.lesson}.csv`, csvOf(all, [t("lessons.table.name"), ...heads]), "text/csv");
  return html`<div ref=${panel} class="lesson-table">
    ${tableRefused.value && html`<${Refusal} sentence=${tableRefused.value} />`}
    ${
      rows.length === 0
        ? html`<p class="note">${t("lessons.table.nobody")}</p>`
        : html`<div class="scroll" tabindex="0" role="region" aria-label=${t("lessons.table")}><table>
          <thead><tr><th scope="col">${t("lessons.table.name")}</th>${heads.map((head, at) => html`<th key=${at} scope="col" title=${head}>${at + 1}</th>`)}</tr></thead>
          <tbody>${rows.map((row) => html`<${Row} key=${row.person} row=${row} heads=${heads} />`)}</tbody>
          <tfoot><tr><th scope="row">${t("lessons.table.sum")}</th>${heads.map((_, at) => html`<td key=${at}>${rows.filter(({ done_s: done }) => done[at] != null).length}/${rows.length}</td>`)}</tr></tfoot></table></div>
          <button type="button" class="button small" onClick=${save}><${Icon} name="download" size=${13} />${t("lessons.table.csv")}</button>`
    }</div>`;
}

/** @param {{row: LessonRow, heads: readonly string[]}} props */
function Row({ row: { name, here, reads, done_s: done }, heads }) {
  const state = t(
    here ? (reads ? "lessons.table.reads" : "lessons.table.here") : "lessons.table.away",
  );
  return html`<tr class=${here ? "" : "away"}><th scope="row"><span class=${`lesson-dot ${reads ? "reads" : ""}`} role="img" aria-label=${state} title=${state}></span>${name}</th>
    ${heads.map((head, at) => html`<td key=${at}>${done[at] != null ? html`<span role="img" aria-label=${`${head}: ${timeOf(done[at])}`} title=${timeOf(done[at])}><${Icon} name="check" size=${13} /></span>` : ""}</td>`)}</tr>`;
}
