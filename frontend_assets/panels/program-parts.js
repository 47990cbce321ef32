/** What the panels of launch files and of packages have in common. */

/** @import { ProcessView, RunView } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { CodeLine } from "../app/code-line.js";
import { quoted } from "../lib/course-lines.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Switch } from "../lib/ui.js";
import { documentState } from "../model/document.js";
import { runAgainOnSave } from "../model/programs.js";

/** @param {{icon: string}} props what stands where nothing may be run, and what to do */
export function NoRuns({ icon }) {
  const folder = quoted(documentState.value?.root ?? "FOLDER");
  return html`<${EmptyState} icon=${icon} title=${t("programs.off")}>
    <p>${t("programs.off.hint")}</p>
    <${CodeLine} code=${`studio open ${folder} --allow-run ${folder}`} /><//>`;
}

/** @param {{of: Pick<RunView | ProcessView, "state" | "code"> | undefined}} props a run or a process of one; undefined: it was never started */
export const StateDot = ({ of }) => html`<span class=${`state-dot ${stateOf(of)}`}></span>`;

/** @param {Pick<RunView | ProcessView, "state" | "code"> | undefined} one @returns {string} */
function stateOf(one) {
  if (!one) return "never";
  return hasFailed(one) ? "failed" : one.state;
}

/** @param {Pick<RunView | ProcessView, "state" | "code">} one */
export const hasFailed = ({ state, code }) => state === "ended" && code !== 0;

/** @param {{run: RunView, label?: string}} props `label`: its name where several stand in a list */
export function AgainOnSave({ run, label = t("launching.again") }) {
  const change = (/** @type {boolean} */ on) => runAgainOnSave(run.run, on);
  return html`<label class="again-on-save"><${Switch} label=${label} checked=${run.again_on_save} onChange=${change} /><span aria-hidden="true">${t("launching.again")}</span></label>`;
}
