/** One line that says in words what the property under the pointer shapes. */

import { html } from "vendor/preact.js";
import { site } from "../app/state/document.js";
import { effects } from "../app/state/origin.js";
import { t } from "../lib/i18n.js";
import { countedAspects } from "../lib/origin.js";
import { shortName } from "../lib/sites.js";

export function EffectLine() {
  const known = effects.value;
  const one = known && site(known.site)?.value;
  const words = known ? effectWords(known.counts) : "";
  return html`<p class="effect-line" role="status" title=${words}>
    <span>${one ? html`<strong>${shortName(one)}</strong> ${words}` : t("effects.hint")}</span></p>`;
}

/** @param {Readonly<Record<string, number>>} counts parts by aspect @returns {string} */
export function effectWords(counts) {
  const told = countedAspects(counts);
  if (told.length === 0) return t("effects.none");
  return told.map(({ aspect, count }) => t(`effects.${aspect}`, { count })).join(", ");
}
