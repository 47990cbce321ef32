/** What the panels of launch files and of packages have in common. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { EmptyState } from "../lib/ui.js";
import { documentState } from "../model/document.js";

/** @param {{icon: string}} props what stands where nothing may be run, and what to do */
export function NoRuns({ icon }) {
  const folder = documentState.value?.root ?? "FOLDER";
  return html`<${EmptyState} icon=${icon} title=${t("programs.off")}>
    <p>${t("programs.off.hint")}</p>
    <p><code>${`studio open ${folder} --allow-run ${folder}`}</code></p><//>`;
}
