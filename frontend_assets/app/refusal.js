/** What stands in a panel that the studio told nothing: its sentence, and another try. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon } from "../lib/ui.js";

/** @param {{sentence: string, again: () => void}} props */
export function Refusal({ sentence, again }) {
  return html`<div class="refusal" role="alert"><${EmptyState} icon="alert" title=${sentence}>
    <button type="button" class="button" onClick=${again}><${Icon} name="reload" />${t("try_again")}</button><//></div>`;
}
