/** What is wrong: how bad, in one sentence, where, and one click that mends it when there is one. */

/** @import { MacroCall, Place, Problem, SiteView } from "../../types/wire.d.ts" */

import { html, useId, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { LongList } from "../../lib/long-list.js";
import { baseName, placeText, shortPath } from "../../lib/paths.js";
import { EmptyState, Icon, IconButton, SEVERITY_ICONS, SearchBox } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayEdit } from "../../model/connection.js";
import {
  allSites,
  documentState,
  packageProblems,
  problems,
  sitesRevision,
} from "../../model/document.js";
import { followWorkspaces } from "../../model/programs.js";
import { canMend, mend, mendAll } from "../../model/requests.js";
import { selectPart } from "../../model/selection.js";
import { showSource } from "../../model/source.js";
import { notify, propertyFilter, soughtSite } from "../../model/view.js";
import { PlaceLink } from "../parts.js";

export function ProblemsPanel() {
  const words = useSignal("");
  const hidden = useSignal(/** @type {ReadonlySet<Severity>} */ (new Set()));
  const { panel } = useLooking(followWorkspaces);
  const all = problems.value;
  if (all.length === 0) {
    return html`<section ref=${panel} class="panel-body" aria-label=${t("panel.problems")}>
      <${EmptyState} icon="check" title=${t("problems.none")} /></section>`;
  }
  const files = byFile(filtered(all, words.value, hidden.value));
  const clear = () => {
    words.value = "";
    hidden.value = new Set();
  };
  return html`<section ref=${panel} class="panel-body problems-panel" aria-label=${t("panel.problems")}>
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
  const count = mendable(all.filter((one) => !packageProblems.value.includes(one)));
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

/** @param {{problem: Problem, id: string, at: number, of: number}} props `at`: its place in its list, from 1 */
function ProblemRow({ problem, id: key, at, of }) {
  const { severity, sentence, fix } = problem;
  const open = useSignal(false);
  const id = useId();
  return html`<div role="listitem" class=${`problem ${severity}`} data-key=${key} aria-posinset=${at} aria-setsize=${of}>
    <span class="problem-icon"><${Icon} name=${SEVERITY_ICONS[severity]} /></span>
    <div class="problem-text">
      <button type="button" class="problem-main" onClick=${() => goTo(problem)}>
        <span class="problem-word">${t(`severity.${severity}`)}</span> ${sentence}</button>
      <p class="place">
        <${Where} place=${problem.place} />
        <${MoreButton} problem=${problem} open=${open} id=${id} />
      </p>
      ${open.value && html`<div class="problem-more" id=${id}><${Why} code=${problem.code} /><${Trail} problem=${problem} /></div>`}
    </div>
    ${fix && canMend(problem) && html`<button type="button" class="button small problem-fix" onClick=${() => mend(problem)}>${fix.label}</button>`}
  </div>`;
}

/** The part first: what shows the line may take the focus. @param {Problem} problem */
function goTo({ place, parts }) {
  const [part] = parts;
  if (part) selectPart(part, "", "", "problems");
  if (place?.line) showSource(place.file, place.line, place.column || 1);
}

/** @param {{place: Place | null}} props the line, and the property that is written there */
function Where({ place }) {
  if (!place) return null;
  const column = place.line && place.column ? `:${place.column}` : "";
  return html`<${PlaceLink} place=${place} words=${`${placeText(place)}${column}`} />
    ${place.line > 0 && html`<${PropertyLink} file=${place.file} line=${place.line} />`}`;
}

/** @type {{revision: number, sites: Map<string, SiteView>}} by file and line; kept for all rows until a site changes */
let placed = { revision: -1, sites: new Map() };

/** @param {string} file @param {number} line @returns {SiteView | undefined} the first that is written there */
function siteAt(file, line) {
  const revision = sitesRevision.value;
  if (placed.revision !== revision) {
    placed = { revision, sites: new Map() };
    for (const one of allSites().values()) {
      const key = `${one.line} ${one.file}`;
      if (!placed.sites.has(key)) placed.sites.set(key, one);
    }
  }
  return placed.sites.get(`${line} ${file}`);
}

/** @param {{file: string, line: number}} props */
function PropertyLink({ file, line }) {
  const there = siteAt(file, line);
  if (!there) return null;
  const go = () => {
    commandById("panel.properties")?.run();
    propertyFilter.value = "";
    soughtSite.value = there.id;
  };
  return html` <button type="button" class="text-button" onClick=${go}>${t("palette.property", { name: there.name })}</button>`;
}

/** @param {string} code @returns {string} why it matters; empty when nothing is written about it */
function whyOf(code) {
  const key = `why.${code}`;
  const text = t(key);
  return text === key ? "" : text;
}

/** @param {{problem: Problem, open: {value: boolean}, id: string}} props */
function MoreButton({ problem, open, id }) {
  const steps = problem.include_chain.length + problem.macro_stack.length;
  const why = whyOf(problem.code) !== "";
  if (!why && steps === 0) return null;
  const toggle = () => {
    open.value = !open.value;
  };
  return html`<button type="button" class="text-button problem-why" aria-expanded=${open.value}
    aria-controls=${id} onClick=${toggle}><${Icon} name=${open.value ? "chevronDown" : "chevronRight"} size=${12} />${t(why ? "problems.why" : "problems.trail")}</button>`;
}

/** @param {{code: string}} props */
function Why({ code }) {
  const text = whyOf(code);
  return text ? html`<p>${text}</p>` : null;
}

/** @param {{problem: Problem}} props the includes and macro calls that lead there, the outermost first */
function Trail({ problem: { include_chain: includes, macro_stack: calls } }) {
  if (includes.length + calls.length === 0) return null;
  return html`<ol class="problem-trail" aria-label=${t("problems.trail")}>
    ${includes.map((place) => html`<li><${Step} text="problems.trail_includes" place=${place} /></li>`)}
    ${calls.map((call) => html`<li><${Call} call=${call} /></li>`)}
  </ol>`;
}

/** @param {{call: MacroCall}} props */
function Call({ call: { macro, called_at: place } }) {
  return html`<${Step} text="problems.trail_macro" place=${place} macro=${macro} />`;
}

/** @param {{text: string, place: Place, macro?: string}} props a step as a link to its line */
function Step({ text, place, macro = "" }) {
  const words = t(text, { place: place.line ? placeText(place) : baseName(place.file), macro });
  return html`<${PlaceLink} place=${place} words=${words} />`;
}

/** @typedef {Problem["severity"]} Severity */
/** @typedef {{file: string, problems: readonly Problem[]}} FileProblems `file` empty: of the robot as a whole */

/** @type {readonly Severity[]} */
const SEVERITIES = ["error", "warning", "info"];

/** @param {readonly Problem[]} problems @returns {Record<Severity, number>} */
export function counts(problems) {
  const found = { error: 0, warning: 0, info: 0 };
  for (const { severity } of problems) found[severity] += 1;
  return found;
}

/**
 * @param {readonly Problem[]} problems
 * @param {string} words each of which must occur somewhere in a problem
 * @param {ReadonlySet<Severity>} hidden
 */
export function filtered(problems, words, hidden) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return problems.filter((one) => {
    if (hidden.has(one.severity)) return false;
    const text = `${one.sentence} ${one.code} ${one.place?.file ?? ""}:${one.place?.line ?? ""}`;
    return wanted.every((word) => text.toLowerCase().includes(word));
  });
}

/** @param {readonly Problem[]} problems @returns {FileProblems[]} the file with the worst first; in one by weight, then line */
export function byFile(problems) {
  /** @type {Map<string, Problem[]>} */
  const files = new Map();
  for (const one of [...problems].sort(byWeight)) {
    const file = one.place?.file ?? "";
    const those = files.get(file);
    if (those) those.push(one);
    else files.set(file, [one]);
  }
  return [...files].map(([file, those]) => ({ file, problems: those }));
}

/** @param {Problem} a @param {Problem} b */
function byWeight(a, b) {
  const weight = SEVERITIES.indexOf(a.severity) - SEVERITIES.indexOf(b.severity);
  if (weight !== 0) return weight;
  const line = (a.place?.line ?? 0) - (b.place?.line ?? 0);
  return line || (a.place?.column ?? 0) - (b.place?.column ?? 0);
}

/** @param {readonly Problem[]} problems @returns {number} how many hinder and have an edit that mends them */
export function mendable(problems) {
  return problems.filter(({ severity, fix }) => severity !== "info" && fix?.action === "edit")
    .length;
}

/** @param {readonly FileProblems[]} files @param {(severity: Severity) => string} word @returns {string} a line for each, `file:line:column: error: sentence` */
export function asText(files, word) {
  return files
    .flatMap(({ problems }) => problems)
    .map(({ severity, sentence, place, code }) => {
      const where = place ? [place.file, place.line, place.column].filter(Boolean).join(":") : "";
      return `${where ? `${where}: ` : ""}${word(severity)}: ${sentence} [${code}]\n`;
    })
    .join("");
}

/** @param {readonly Problem[]} those @returns {{key: string, problem: Problem}[]} two that say the same are told apart by their order */
export function keyed(those) {
  /** @type {Map<string, number>} */
  const seen = new Map();
  return those.map((problem) => {
    const own = keyOf(problem);
    const number = (seen.get(own) ?? 0) + 1;
    seen.set(own, number);
    return { key: `${own}#${number}`, problem };
  });
}

/** @param {Problem} problem @returns {string} the same for the same problem, also when others come and go */
export function keyOf({ code, sentence, place }) {
  return `${code} ${place?.file ?? ""}:${place?.line ?? ""}:${place?.column ?? ""} ${sentence}`;
}
