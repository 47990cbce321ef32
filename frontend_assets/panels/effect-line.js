/** One line that says in words what the property under the pointer shapes. */

/** @import { Effects } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { site } from "../app/state/document.js";
import { effects } from "../app/state/origin.js";
import { t } from "../lib/i18n.js";
import { countedAspects } from "../lib/origin.js";
import { shortName } from "../lib/sites.js";

export function EffectLine() {
  const known = effects.value;
  const one = known && site(known.site)?.value;
  const words = known ? effectWords(known) : "";
  return html`<p class="effect-line" role="status" title=${words}>
    <span>${one ? html`<strong>${shortName(one)}</strong> ${words}` : t("effects.hint")}</span></p>`;
}

/** @param {Effects} effects @returns {string} */
function effectWords({ counts, decisions }) {
  const told = countedAspects(counts).map(({ aspect, count }) => t(`effects.${aspect}`, { count }));
  // A condition that is not met has nothing to show for itself, and yet is decided here.
  if (!counts.presence && decisions > 0) told.push(t("effects.decisions", { count: decisions }));
  return told.length > 0 ? told.join(", ") : t("effects.none");
}
