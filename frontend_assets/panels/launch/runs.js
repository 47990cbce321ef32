/** What was started: its processes, and what they print. */

/** @import { OutputLine, ProcessView, RunView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { t } from "../../lib/i18n.js";
import { secondsSince, shortTime, useNow } from "../../lib/times.js";
import { EmptyState, Icon, IconButton, SearchBox, useBusy, useEnd } from "../../lib/ui.js";
import {
  chosenRun,
  endProcess,
  forgetRun,
  isShown,
  isUnderWay,
  output,
  restartProcess,
  runs,
  runsToldAt_ms,
  showOutput,
  startRunAgain,
  stopRun,
} from "../../model/programs.js";
import { notify } from "../../model/view.js";
import { AgainOnSave, hasFailed, StateDot } from "../program-parts.js";

/** Of more lines the oldest are not drawn, which is said. */
const DRAWN_MAX = 1000;

export function RunsView() {
  const all = runs.value ?? [];
  const run = all.find((one) => one.run === chosenRun.value) ?? all[0];
  useEffect(() => {
    showOutput(run?.run ?? 0);
    return () => showOutput(0);
  }, [run?.run ?? 0]);
  if (!run)
    return html`<${EmptyState} icon="animate" title=${t("launching.runs.none")}><p>${t("launching.runs.none.hint")}</p><//>`;
  return html`${all.length > 1 && html`<${Choice} all=${all} run=${run} />`}
    <${OneRun} key=${run.run} run=${run} />`;
}

/** @param {RunView} run */
const titleOf = (run) =>
  run.kind === "node" ? `${run.package} ${run.executable}` : (run.file.split("/").at(-1) ?? "");

/** @param {{all: readonly RunView[], run: RunView}} props */
function Choice({ all, run }) {
  return html`<ul class="launching-runs" aria-label=${t("launching.part.runs")}>${all.map(
    (one) =>
      html`<li key=${one.run}><button type="button" class="row-button launching-run" aria-pressed=${one.run === run.run} onClick=${() => {
        chosenRun.value = one.run;
      }}><${StateDot} of=${one} /><span class="launching-run-name">${titleOf(one)}</span><span class="muted">${one.run}</span></button></li>`,
  )}</ul>`;
}

/** @param {{run: RunView}} props */
function OneRun({ run }) {
  const process = useSignal(/** @type {number | null} */ (null));
  return html`<${Head} run=${run} />
    <div class="launching-doing">
      ${(run.kind === "launch" || run.not_started.length > 0) && html`<${Processes} run=${run} process=${process} />`}
      <${Output} run=${run} process=${process} /></div>`;
}

/** @param {{run: RunView}} props */
function Head({ run }) {
  const { busy, during } = useBusy();
  const since_s = secondsSince(runsToldAt_ms.value, useNow());
  const isOver = !isUnderWay(run);
  return html`<header class="launching-head">
    <p><${StateDot} of=${run} /><code title=${run.file}>${run.line}</code></p>
    <p class=${`launching-state ${hasFailed(run) ? "bad" : ""}`} role="status">${stateWords(run, since_s)}${run.again > 0 && ` · ${t("launching.again.count", { count: run.again })}`}</p>
    <div class="launching-buttons">
      ${!isOver && html`<button type="button" class="button small" disabled=${busy || run.state === "stopping"} onClick=${during(() => stopRun(run.run))}><${Icon} name="stop" size=${13} />${t("launching.stop")}</button>`}
      <button type="button" class="button small" disabled=${busy} onClick=${during(() => startRunAgain(run.run))}><${Icon} name="reload" size=${13} />${t("launching.start_again")}</button>
      ${isOver && html`<${IconButton} icon="trash" size=${14} label=${t("launching.forget")} onClick=${() => forgetRun(run.run)} />`}
      <${AgainOnSave} run=${run} />
    </div></header>`;
}

/** @param {RunView} run @param {number} since_s it was told @returns {string} */
function stateWords({ state, for_s: for_, code, trouble }, since_s) {
  if (state !== "ended") return t(`launching.state.${state}`, { time: shortTime(for_ + since_s) });
  if (code === 0) return t("launching.state.ended");
  return t(code < 0 ? "launching.state.killed" : "launching.state.failed", {
    code: Math.abs(code),
    reason: trouble,
  });
}

/** @param {{run: RunView, process: Signal<number | null>}} props */
function Processes({ run, process }) {
  return html`<ul class="launching-processes" aria-label=${t("launching.processes")}>
    ${run.processes.map((one) => html`<${ProcessRow} key=${one.id} run=${run} one=${one} process=${process} />`)}
    ${run.shown.map(
      ({ what, config }, at) =>
        html`<li key=${`shown ${at}`} class="launching-process"><span class="launching-process-name still" title=${config}>${what}<small>${t("launching.shown")}</small></span></li>`,
    )}
    ${run.not_started.map(
      (one) =>
        html`<li key=${`not ${one.id}`} class="launching-process off"><${StateDot} /><span class="launching-process-name">${one.name || one.executable}<small>${t("launching.not_started", { reason: one.reason })}</small></span></li>`,
    )}</ul>`;
}

/** @param {{run: RunView, one: ProcessView, process: Signal<number | null>}} props */
function ProcessRow({ run, one, process }) {
  const isChosen = process.value === one.id;
  const choose = () => {
    process.value = isChosen ? null : one.id;
  };
  const words = [
    t(`launching.process.${one.state}`, { code: one.code }),
    one.starts > 1 && t("launching.process.starts", { count: one.starts }),
  ].filter(Boolean);
  const isDone = !isUnderWay(run);
  return html`<li class="launching-process"><button type="button" class="row-button launching-process-button" aria-pressed=${isChosen} title=${one.command} onClick=${choose}>
      <${StateDot} of=${one} />
      <span class="launching-process-name">${one.node || one.name}<small>${words.join(" · ")}</small></span></button>
    <${IconButton} icon="reload" size=${13} label=${t("launching.restart", { name: one.name })} disabled=${isDone} onClick=${() => restartProcess(run.run, one.id)} />
    <${IconButton} icon="stop" size=${13} label=${t("launching.end", { name: one.name })} disabled=${isDone || one.state === "ended"} onClick=${() => endProcess(run.run, one.id)} /></li>`;
}

/** @param {{run: RunView, process: Signal<number | null>}} props */
function Output({ run, process }) {
  const words = useSignal("");
  const errors = useSignal(false);
  const { lines, dropped } = output.value;
  const filter = { words: words.value, process: process.value, errors: errors.value };
  const found = lines.filter((line) => isShown(line, filter));
  const shown = found.slice(-DRAWN_MAX);
  const { list, follows, onScroll } = useEnd([lines, words.value, process.value, errors.value]);
  const names = new Map(run.processes.map((one) => [one.id, one.name]));
  const copy = async () => {
    const done = await copyText(found.map(({ text }) => text).join("\n"));
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  return html`<section class="launching-output" aria-label=${t("launching.output")}>
    <div class="panel-bar row"><${SearchBox} label=${t("launching.filter")} value=${words.value} onInput=${(
      /** @type {string} */ now,
    ) => {
      words.value = now;
    }} />
      <button type="button" class="chip" aria-pressed=${errors.value} onClick=${() => {
        errors.value = !errors.value;
      }}>${t("launching.stderr")}</button>
      <${IconButton} icon="listening" label=${t("launching.follow")} pressed=${follows.value} onClick=${() => {
        follows.value = !follows.value;
      }} />
      <${IconButton} icon="copy" label=${t("launching.copy")} disabled=${shown.length === 0} onClick=${copy} /></div>
    <div ref=${list} class="scroll launching-lines" tabindex="0" role="log" aria-live="off" aria-label=${t("launching.output")} onScroll=${onScroll}>
      ${dropped > 0 && html`<p class="note">${t("launching.dropped", { count: dropped })}</p>`}
      ${found.length > shown.length && html`<p class="note">${t("launching.older", { count: found.length - shown.length })}</p>`}
      ${shown.length === 0 && html`<p class="note">${t(lines.length > 0 ? "launching.filtered" : "launching.output.none")}</p>`}
      ${shown.map((line) => html`<${Line} key=${line.number} line=${line} name=${names.get(line.process) ?? ""} isNamed=${run.processes.length > 1 && process.value === null} />`)}
    </div></section>`;
}

/** @param {{line: OutputLine, name: string, isNamed: boolean}} props */
function Line({ line, name, isNamed }) {
  const said = line.process < 0 || !["stdout", "stderr"].includes(line.stream);
  return html`<p class=${`launching-text ${line.stream} ${said ? "said" : ""}`}>${isNamed && html`<span class="launching-who">${name || (said ? "launch" : line.process)}</span>`}<span>${line.text}</span></p>`;
}
