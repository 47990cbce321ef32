/** A launch file: its arguments, what it would start, and what it does once it is started. */

/** @import { Plan } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useEffect } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { baseName } from "../../lib/paths.js";
import { EmptyState, Icon, ProgressBar, Segments, useBusy } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayManage } from "../../model/connection.js";
import {
  chosenLaunch,
  followPrograms,
  isUnderWay,
  launchPart,
  launchValues,
  mayRun,
  packages,
  runs,
  startLaunch,
  stopRun,
  workspaces,
  workspacesRefused,
} from "../../model/programs.js";
import { showSource } from "../../model/source.js";
import { RefusedError, send } from "../../model/wire.js";
import { NoRuns } from "../program-parts.js";
import { LaunchGraph } from "./launch-graph.js";
import { LaunchPlan } from "./plan.js";
import { RunsView } from "./runs.js";

const PARTS = /** @type {const} */ (["plan", "graph", "runs"]);
/** @type {Signal<{file: string, plan: Plan} | null>} */
const planned = signal(null);
const trouble = signal("");
/** A plan was asked for and is not here yet. */
const isPlanning = signal(false);
const PLAN_AFTER_MS = 250;

export function LaunchPanel() {
  const { panel, looking } = useLooking(followPrograms);
  return html`<section ref=${panel} class="panel-body launching" aria-label=${t("panel.launch")}>
    ${mayManage.value ? html`<${Content} looking=${looking} />` : html`<${EmptyState} icon="launch" title=${t("launching.owner")} />`}
  </section>`;
}

/** @returns {{file: string, package: string, name: string, may_run: boolean}[]} of all packages */
function launchFiles() {
  return packages.value.flatMap((one) =>
    one.launch_files.map(({ file }) => ({
      file,
      package: one.name,
      name: baseName(file),
      may_run: one.may_run,
    })),
  );
}

/** @param {{looking: boolean}} props */
function Content({ looking }) {
  const all = launchFiles();
  const chosen =
    all.find(({ file }) => file === chosenLaunch.value) ?? all.find((one) => one.may_run);
  usePlan(looking && chosen?.may_run ? chosen.file : "");
  if (workspacesRefused.value)
    return html`<p class="note bad padded" role="alert">${workspacesRefused.value}</p>`;
  if (!workspaces.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (!mayRun.value) return html`<${NoRuns} icon="launch" />`;
  if (all.length === 0 && !runs.value?.length) return html`<${NoFiles} />`;
  return html`<${Chosen} all=${all} chosen=${chosen} folders=${workspaces.value.run_folders} />`;
}

/** @param {{all: ReturnType<typeof launchFiles>, chosen: ReturnType<typeof launchFiles>[number] | undefined, folders: readonly string[]}} props */
function Chosen({ all, chosen, folders }) {
  const file = chosen?.may_run ? chosen.file : "";
  return html`<${Bar} all=${all} file=${file} />
    ${chosen && !chosen.may_run && html`<p class="note bad padded">${t("launching.not_allowed", { folder: folders.join(", ") })}</p>`}
    <${Parts} />
    ${all.length === 0 && launchPart.value !== "runs" && html`<${NoFiles} />`}
    ${all.length > 0 && launchPart.value === "plan" && html`<${PlanPart} file=${file} />`}
    ${all.length > 0 && launchPart.value === "graph" && html`<${GraphPart} file=${file} />`}
    ${launchPart.value === "runs" && html`<${RunsView} />`}`;
}

function NoFiles() {
  if (workspaces.value?.is_reading)
    return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<${EmptyState} icon="launch" title=${t("launching.none")}><p>${t("launching.none.hint")}</p><//>`;
}

/** @param {{all: ReturnType<typeof launchFiles>, file: string}} props */
function Bar({ all, file }) {
  const { busy, during } = useBusy();
  const running = runs.value?.find(
    (one) => one.kind === "launch" && one.file === file && isUnderWay(one),
  );
  const names = [...new Set(all.map((one) => one.package))];
  const choose = (/** @type {any} */ event) => {
    chosenLaunch.value = event.currentTarget.value;
    launchValues.value = {};
    // What another file does says nothing of this one.
    if (launchPart.value === "runs") launchPart.value = "plan";
  };
  const start = during(async () => {
    launchPart.value = "runs";
    await startLaunch(file, given());
  });
  return html`<div class="panel-bar row launching-bar">
    <select class="box launching-file" aria-label=${t("launching.file")} value=${file} onChange=${choose}>
      ${all.length === 0 && html`<option value="">${t("launching.none")}</option>`}
      ${names.map(
        (name) =>
          html`<optgroup key=${name} label=${name}>${all
            .filter((one) => one.package === name)
            .map(
              (one) => html`<option key=${one.file} value=${one.file}>${one.name}</option>`,
            )}</optgroup>`,
      )}
    </select>
    ${
      running
        ? html`<button type="button" class="button small" disabled=${busy} onClick=${during(() => stopRun(running.run))}>
            <${Icon} name="stop" size=${13} />${t("launching.stop")}</button>`
        : html`<button type="button" class="button small primary" disabled=${busy || file === "" || isLacking()} onClick=${start}>
            ${busy ? html`<span class="spinner"></span>` : html`<${Icon} name="animate" size=${13} />`}${t("launching.start")}</button>`
    }
    ${file && html`<button type="button" class="icon-button" aria-label=${t("launching.source")} title=${t("launching.source")} onClick=${() => showSource(file, 1)}><${Icon} name="source" /></button>`}
  </div>`;
}

/** @returns {boolean} an argument needs a value and has none */
const isLacking = () =>
  planned.value?.plan.arguments.some(
    ({ value, condition }) => value === null && condition?.holds !== false,
  ) ?? true;

/** @returns {Record<string, string>} the values that the launch file declares */
function given() {
  const known = new Set(planned.value?.plan.arguments.map(({ name }) => name));
  return Object.fromEntries(Object.entries(launchValues.value).filter(([name]) => known.has(name)));
}

function Parts() {
  const count = runs.value?.filter(isUnderWay).length ?? 0;
  const badge = count > 0 && html` <span class="badge calm">${count}</span>`;
  const of = PARTS.map((one) => [
    one,
    html`${t(`launching.part.${one}`)}${one === "runs" && badge}`,
  ]);
  return html`<${Segments} label=${t("launching.part")} chosen=${launchPart} of=${of} />`;
}

/** Plan the file whenever it, or what is given, changes. @param {string} file empty: none */
function usePlan(file) {
  const asked = JSON.stringify(launchValues.value);
  const version = packages.value;
  useEffect(() => {
    if (file === "") return undefined;
    let over = false;
    isPlanning.value = true;
    const timer = setTimeout(
      async () => {
        const answer = await plannedOf(file, JSON.parse(asked));
        if (over) return;
        isPlanning.value = false;
        if (answer) planned.value = { file, plan: answer };
      },
      planned.peek()?.file === file ? PLAN_AFTER_MS : 0,
    );
    return () => {
      over = true;
      clearTimeout(timer);
    };
  }, [file, asked, version]);
}

/** @param {string} file @param {Record<string, string>} wanted @returns {Promise<Plan | null>} */
async function plannedOf(file, wanted) {
  try {
    const answer = await send({ type: "plan_launch", file, arguments: wanted });
    trouble.value = "";
    return answer.type === "launch_plan" ? answer.plan : null;
  } catch (error) {
    if (error instanceof RefusedError) trouble.value = error.message;
    return null;
  }
}

/** @param {{file: string}} props */
function Planned({ file }) {
  if (!isPlanning.value) return null;
  return html`<div class="launching-planning"><${ProgressBar} label=${t("launching.planning", { name: baseName(file) })} done=${0} total=${0} />
    <button type="button" class="text-button" onClick=${() => void send({ type: "cancel_plan" }).catch(() => {})}>${t("cancel")}</button></div>`;
}

/** @param {{file: string}} props */
function PlanPart({ file }) {
  const known = planned.value?.file === file ? planned.value.plan : null;
  const write = (/** @type {string} */ name, /** @type {string | null} */ value) => {
    const now = { ...launchValues.value };
    if (value === null) delete now[name];
    else now[name] = value;
    launchValues.value = now;
  };
  return html`<${Planned} file=${file} />
    ${trouble.value && html`<p class="note bad padded" role="alert">${trouble.value}</p>`}
    <div class="scroll launching-plan" tabindex="0" role="region" aria-label=${t("launching.part.plan")}>
      ${known && html`<${LaunchPlan} plan=${known} values=${launchValues.value} write=${write} />`}
    </div>`;
}

/** @param {{file: string}} props */
function GraphPart({ file }) {
  const known = planned.value?.file === file ? planned.value.plan : null;
  if (!known) return html`<${Planned} file=${file} />`;
  return html`<${LaunchGraph} plan=${known} />`;
}
