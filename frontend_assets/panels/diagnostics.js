/** How the parts of a robot are, by level and hardware, as they say on /diagnostics. */

/** @import { DiagnosticView, DiagnosticsAnswer } from "../types/wire.d.ts" */
/** @import { Filter, Level } from "../lib/diagnostics.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../app/connect-first.js";
import { diagnostics, diagnosticsRefused, followDiagnostics } from "../app/state/diagnostics.js";
import { byHardware, LEVELS, levelCounts, levelOf, shownParts } from "../lib/diagnostics.js";
import { t } from "../lib/i18n.js";
import { shortTime } from "../lib/times.js";
import { Icon, ProgressBar, SearchBox } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";

const ICONS = { ok: "check", warn: "alert", error: "error", stale: "help" };

export function DiagnosticsPanel() {
  const { panel } = useLooking(followDiagnostics);
  const told = diagnostics.value;
  const isEmpty = (told?.parts.length ?? 0) === 0;
  return html`<section ref=${panel} class="panel-body diagnostics" aria-label=${t("panel.diagnostics")}>
    <${RouterAway} />
    ${isEmpty && isUnconnected() ? html`<${ConnectFirst} icon="diagnostics" />` : html`<${Content} told=${told} />`}
  </section>`;
}

/** @param {{told: DiagnosticsAnswer | null}} props */
function Content({ told }) {
  const filter = useSignal(/** @type {Filter} */ ({ least: "ok", words: "" }));
  const open = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  if (diagnosticsRefused.value)
    return html`<p class="note bad padded" role="alert">${diagnosticsRefused.value}</p>`;
  if (!told) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (told.parts.length === 0)
    return html`<${NothingThere} icon="diagnostics" title=${t("diagnostics.none")}><p>${t("diagnostics.none.hint")}</p><//>`;
  const shown = shownParts(told.parts, filter.value);
  return html`<${Bar} parts=${told.parts} filter=${filter} />
    <div class="scroll diagnostics-list">
      ${[...byHardware(shown)].map(
        ([
          hardware,
          parts,
        ]) => html`<section key=${hardware} aria-label=${hardware || t("diagnostics.no_hardware")}>
        <h3>${hardware || t("diagnostics.no_hardware")}</h3>
        ${parts.map((part) => html`<${Part} key=${part.name} part=${part} open=${open} />`)}</section>`,
      )}
      ${shown.length === 0 && html`<p class="nothing">${t("diagnostics.filtered", { count: told.parts.length })}</p>`}
      ${told.more > 0 && html`<p class="note padded">${t("diagnostics.more", { count: told.more })}</p>`}
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
