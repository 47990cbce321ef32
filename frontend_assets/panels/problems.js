/** What is wrong: how bad, in one sentence, where, and one click that mends it when there is one. */

/** @import { Problem } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { mend } from "../app/actions.js";
import { commandById } from "../app/commands.js";
import { PlaceLink } from "../app/place-link.js";
import { mayEdit } from "../app/state/connection.js";
import { allSites, documentState, problems, sitesRevision } from "../app/state/document.js";
import { propertyFilter, soughtSite } from "../app/state/view.js";
import { t } from "../lib/i18n.js";
import { placeText, shortPath } from "../lib/paths.js";
import { EmptyState, Icon } from "../lib/ui.js";

const ICONS = { error: "error", warning: "alert", info: "info" };
const ORDER = ["error", "warning", "info"];

export function ProblemsPanel() {
  const sorted = [...problems.value].sort(
    (a, b) => ORDER.indexOf(a.severity) - ORDER.indexOf(b.severity),
  );
  if (sorted.length === 0) {
    return html`<section class="panel-body" aria-label=${t("panel.problems")}>
      <${EmptyState} icon="check" title=${t("problems.none")} /></section>`;
  }
  return html`<section class="panel-body" aria-label=${t("panel.problems")}>
    <ul class="problems scroll">${sorted.map((problem, at) => html`<${ProblemRow} key=${`${problem.code}${at}`} problem=${problem} />`)}</ul>
  </section>`;
}

/** @param {{problem: Problem}} props */
function ProblemRow({ problem }) {
  const { severity, sentence, place, fix } = problem;
  const root = documentState.value?.root ?? "";
  return html`<li class=${`problem ${severity}`}>
    <span class="problem-icon" title=${t(`severity.${severity}`)}><${Icon} name=${ICONS[severity]} /><span class="hidden-words">${t(`severity.${severity}`)}</span></span>
    <div class="problem-text">
      <p>${sentence}</p>
      ${place && html`<${PlaceLine} problem=${problem} words=${placeWords(problem, root)} />`}
    </div>
    ${fix && mayEdit.value && html`<button type="button" class="button small" onClick=${() => mend(problem)}>${fix.label}</button>`}
  </li>`;
}

/** Leads to the line; where that is a property's own, to the property as well. @param {{problem: Problem, words: string}} props */
function PlaceLine({ problem: { place }, words }) {
  return html`<p class="place"><${PlaceLink} place=${place} words=${words} />
    ${place?.line ? html`<${PropertyLink} file=${place.file} line=${place.line} />` : null}</p>`;
}

/** @param {{file: string, line: number}} props */
function PropertyLink({ file, line }) {
  sitesRevision.value;
  const there = [...allSites().values()].find((one) => one.file === file && one.line === line);
  if (!there) return null;
  const go = () => {
    commandById("panel.properties")?.run();
    propertyFilter.value = "";
    soughtSite.value = there.id;
  };
  return html` · <button type="button" class="text-button" onClick=${go}>${t("palette.property", { name: there.name })}</button>`;
}

/** @param {Problem} problem @param {string} root @returns {string} the place, and the way that led to it */
function placeWords({ place, macro_stack: calls, include_chain: includes }, root) {
  if (!place) return "";
  const where = shortPath(place.file, root) + (place.line ? `:${place.line}` : "");
  const macros = calls.map(({ macro, called_at: at }) =>
    t("problem.macro", { macro, place: placeText(at) }),
  );
  const via =
    includes.length > 0
      ? [t("problem.included", { place: placeText(includes.at(-1) ?? null) })]
      : [];
  return [where, ...macros.reverse(), ...via].join(" · ");
}
