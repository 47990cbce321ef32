/** One problem: a click goes to its line and selects its part; below it why it matters and how it came. */

/** @import { MacroCall, Place, Problem, SiteView } from "../types/wire.d.ts" */

import { html, useId, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { baseName, placeText } from "../lib/paths.js";
import { Icon } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { allSites, sitesRevision } from "../model/document.js";
import { mend } from "../model/requests.js";
import { selectPart } from "../model/selection.js";
import { showSource } from "../model/source.js";
import { propertyFilter, soughtSite } from "../model/view.js";

/** @type {Record<Problem["severity"], string>} */
export const SEVERITY_ICONS = { error: "error", warning: "alert", info: "info" };

/** @param {{problem: Problem, id: string, at: number, of: number}} props `at`: its place in its list, from 1 */
export function ProblemRow({ problem, id: key, at, of }) {
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
    ${fix && mayEdit.value && html`<button type="button" class="button small problem-fix" onClick=${() => mend(problem)}>${fix.label}</button>`}
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
export function whyOf(code) {
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
