/** How the parts of a robot are, by level and hardware, as they say on /diagnostics. */

/** @import { DiagnosticView, DiagnosticsAnswer } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { secondsSince, shortTime, useNow } from "../../lib/times.js";
import { Icon, ProgressBar, SearchBox } from "../../lib/ui.js";
import { askedWhenChanged, askOrKeepWhy, useLooking } from "../../model/asking.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../parts.js";

const ICONS = { ok: "check", warn: "alert", error: "error", stale: "help" };

export function DiagnosticsPanel() {
  const { panel } = useLooking(followDiagnostics);
  const answer = diagnostics.value?.answer ?? null;
  const isEmpty = (answer?.parts.length ?? 0) === 0;
  return html`<section ref=${panel} class="panel-body diagnostics" aria-label=${t("panel.diagnostics")}>
    <${RouterAway} />
    ${isEmpty && isUnconnected() ? html`<${ConnectFirst} icon="diagnostics" />` : html`<${Content} answer=${answer} />`}
  </section>`;
}

/** @param {{answer: DiagnosticsAnswer | null}} props */
function Content({ answer }) {
  const filter = useSignal(/** @type {Filter} */ ({ least: "ok", words: "" }));
  const open = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const age_s = secondsSince(diagnostics.value?.at_ms ?? 0, useNow());
  if (diagnosticsRefused.value)
    return html`<p class="note bad padded" role="alert">${diagnosticsRefused.value}</p>`;
  if (!answer) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (answer.parts.length === 0)
    return html`<${NothingThere} icon="diagnostics" title=${t("diagnostics.none")}><p>${t("diagnostics.none.hint")}</p><//>`;
  const parts = answer.parts.map((part) => ({ ...part, age_s: part.age_s + age_s }));
  const shown = shownParts(parts, filter.value);
  return html`<${Bar} parts=${parts} filter=${filter} />
    <div class="scroll diagnostics-list">
      ${[...byHardware(shown)].map(
        ([
          hardware,
          parts,
        ]) => html`<section key=${hardware} aria-label=${hardware || t("diagnostics.no_hardware")}>
        <h3>${hardware || t("diagnostics.no_hardware")}</h3>
        ${parts.map((part) => html`<${Part} key=${part.name} part=${part} open=${open} />`)}</section>`,
      )}
      ${shown.length === 0 && html`<p class="nothing">${t("diagnostics.filtered", { count: answer.parts.length })}</p>`}
      ${answer.more > 0 && html`<p class="note padded">${t("diagnostics.more", { count: answer.more })}</p>`}
    </div>`;
}

/** @param {{parts: readonly DiagnosticView[], filter: Signal<Filter>}} props */
function Bar({ parts, filter }) {
  const counts = levelCounts(parts);
  const choose = (/** @type {Level} */ least) => {
    filter.value = { ...filter.value, least: filter.value.least === least ? "ok" : least };
  };
  return html`<div class="panel-bar">
    <${SearchBox} label=${t("diagnostics.search")} value=${filter.value.words} onInput=${(
      /** @type {string} */ words,
    ) => {
      filter.value = { ...filter.value, words };
    }} />
    <div class="chips" role="group" aria-label=${t("diagnostics.least")}>${LEVELS.map(
      (
        level,
      ) => html`<button key=${level} type="button" class=${`chip diagnostics-chip ${level}`} aria-pressed=${filter.value.least === level} title=${t("diagnostics.from", { level: t(`diagnostics.level.${level}`) })}
        onClick=${() => choose(level)}><${Icon} name=${ICONS[level]} size=${12} />${t(`diagnostics.level.${level}`)}<span class="numbers">${counts[level]}</span></button>`,
    )}</div>
  </div>`;
}

/** @param {{part: DiagnosticView, open: Signal<ReadonlySet<string>>}} props */
function Part({ part, open }) {
  const level = levelOf(part);
  const isOpen = open.value.has(part.name);
  const toggle = () => {
    const now = new Set(open.value);
    if (!now.delete(part.name)) now.add(part.name);
    open.value = now;
  };
  return html`<button type="button" class=${`diagnostics-part ${level}`} aria-expanded=${isOpen} onClick=${toggle}>
      <${Icon} name=${ICONS[level]} size=${14} /><span class="hidden-words">${t(`diagnostics.level.${level}`)}</span>
      <span class="diagnostics-name">${part.name}</span><span class="diagnostics-message">${part.message}</span><span class="muted">${shortTime(part.age_s)}</span></button>
    ${isOpen && html`<${Values} part=${part} />`}`;
}

/** @param {{part: DiagnosticView}} props all that it tells of itself */
function Values({ part }) {
  if (part.values.length === 0)
    return html`<p class="note padded">${t("diagnostics.no_values")}</p>`;
  return html`<dl class="diagnostics-values">${part.values.map(({ key, value }, at) => html`<div key=${`${at} ${key}`}><dt>${key}</dt><dd>${value}</dd></div>`)}</dl>`;
}

/** The last answer, and when it came; null: not known yet. @type {Signal<{answer: DiagnosticsAnswer, at_ms: number} | null>} */
export const diagnostics = signal(null);
const diagnosticsRefused = signal("");

/** Keep them true while somebody looks; gives the end of looking. */
const followDiagnostics = askedWhenChanged(async () => {
  const answer = await askOrKeepWhy({ type: "get_diagnostics" }, diagnosticsRefused);
  if (answer?.type === "diagnostics") diagnostics.value = { answer, at_ms: performance.now() };
}, "diagnostics");

/** By their numbers. */
const LEVELS = /** @type {const} */ (["ok", "warn", "error", "stale"]);
/** @typedef {typeof LEVELS[number]} Level */
/** @typedef {{least: Level, words: string}} Filter `stale` is graver than an error: nothing is known */

/** Who speaks of itself does so every second or so. */
const SILENT_S = 10;

/** @param {Pick<DiagnosticView, "level" | "age_s">} part @returns {Level} a part that fell silent is stale, whatever it said */
export const levelOf = ({ level, age_s: age }) =>
  age > SILENT_S ? "stale" : (LEVELS[level] ?? "error");

/** @param {readonly DiagnosticView[]} parts @param {Filter} filter @returns {DiagnosticView[]} the gravest first */
export function shownParts(parts, { least, words }) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const rank = (/** @type {DiagnosticView} */ part) => LEVELS.indexOf(levelOf(part));
  return parts
    .filter((part) => rank(part) >= LEVELS.indexOf(least))
    .filter(({ name, hardware, message }) =>
      wanted.every((one) => `${name} ${hardware} ${message}`.toLowerCase().includes(one)),
    )
    .sort((a, b) => rank(b) - rank(a));
}

/** @param {readonly DiagnosticView[]} parts @returns {Map<string, DiagnosticView[]>} by hardware, that of the gravest first */
export function byHardware(parts) {
  /** @type {Map<string, DiagnosticView[]>} */
  const groups = new Map();
  for (const part of parts) {
    const group = groups.get(part.hardware);
    if (group) group.push(part);
    else groups.set(part.hardware, [part]);
  }
  return groups;
}

/** @param {readonly DiagnosticView[]} parts @returns {Record<Level, number>} */
export function levelCounts(parts) {
  const counts = { ok: 0, warn: 0, error: 0, stale: 0 };
  for (const part of parts) counts[levelOf(part)] += 1;
  return counts;
}
