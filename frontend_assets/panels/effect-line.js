/** One line that says in words what the property under the pointer shapes. */

/** @import { Effects } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shortName } from "../lib/sites.js";
import { site } from "../model/document.js";
import { countedAspects, effects, pointedWords } from "../model/origin.js";

export function EffectLine() {
  const known = effects.value;
  const one = known && site(known.site)?.value;
  const words = known ? effectWords(known) : "";
  return html`<p class="effect-line" role="status" title=${words}>
    <span>${one ? html`<strong>${shortName(one)}</strong> ${words}` : pointedWords.value || t("effects.hint")}</span></p>`;
}

/** @param {Effects} known @returns {string} */
function effectWords(known) {
  const { counts, decisions } = known;
  const told = countedAspects(counts).map(({ aspect, count }) => t(`effects.${aspect}`, { count }));
  const there = thereWords(known);
  if (there) told.unshift(there);
  // A condition that is not met has nothing to show for itself, and yet is decided here.
  else if (!counts.presence && decisions > 0)
    told.push(t("effects.decisions", { count: decisions }));
  return told.length > 0 ? told.join(", ") : t("effects.none");
}

/** @param {Effects} effects @returns {string} what is there as a whole because of it; empty: nothing */
function thereWords({ links_there: links, joints_there: joints }) {
  const parts = [
    ...(links > 0 ? [t("links.count", { count: links })] : []),
    ...(joints > 0 ? [t("joints.count", { count: joints })] : []),
  ];
  return parts.length > 0 ? t("effects.there", { what: parts.join(` ${t("and")} `) }) : "";
}
