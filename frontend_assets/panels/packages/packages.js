/** What the opened folders hold: packages with their nodes, interfaces, launch files and robots. */

/** @import { ExecutableView, PackageView, Problem, RunView, WorkspaceView } from "../../types/wire.d.ts" */
/** @import { MenuItem } from "../../lib/ui.js" */
/** @import { ComponentChildren } from "vendor/preact.js" */

import { html, useSignal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { baseName, shortPath } from "../../lib/paths.js";
import {
  badgeTone,
  EmptyState,
  Icon,
  IconButton,
  MenuButton,
  ProgressBar,
  SEVERITY_ICONS,
  SearchBox,
  Segments,
  useBusy,
} from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayManage } from "../../model/connection.js";
import { showInterface } from "../../model/interfaces.js";
import {
  chosenPackage,
  followPrograms,
  isUnderWay,
  lastEdit,
  mayRun,
  mendPackage,
  openLaunch,
  packages,
  runs,
  showRun,
  startNode,
  stopRun,
  undoEdit,
  workspaces,
  workspacesRefused,
} from "../../model/programs.js";
import { openPath } from "../../model/requests.js";
import { openConfigFile } from "../../model/rviz-configs.js";
import { showSource } from "../../model/source.js";
import { dialog } from "../../model/view.js";
import { PlaceLink } from "../parts.js";
import { AgainOnSave, hasFailed, NoRuns, StateDot } from "../program-parts.js";
import { PackageGraph } from "./package-graph.js";

export function PackagesPanel() {
  const { panel } = useLooking(followPrograms);
  return html`<section ref=${panel} class="panel-body packages" aria-label=${t("panel.packages")}>
    ${mayManage.value ? html`<${Content} />` : html`<${EmptyState} icon="package" title=${t("packages.owner")} />`}
  </section>`;
}

function Content() {
  const words = useSignal("");
  const asGraph = useSignal(false);
  const told = workspaces.value;
  if (workspacesRefused.value)
    return html`<p class="note bad padded" role="alert">${workspacesRefused.value}</p>`;
  if (!told) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<${Bar} words=${words} asGraph=${asGraph} />
    ${told.is_reading && html`<${ProgressBar} label=${t("packages.reading")} done=${0} total=${0} />`}
    ${packages.value.length === 0 && !told.is_reading ? html`<${None} />` : html`<${Shown} all=${told.workspaces} words=${words.value} asGraph=${asGraph.value} />`}`;
}

function None() {
  if (!mayRun.value) return html`<${NoRuns} icon="package" />`;
  return html`<${EmptyState} icon="package" title=${t("packages.none")}><p>${t("packages.none.hint")}</p>
    <button type="button" class="button primary" onClick=${newPackage}><${Icon} name="plus" />${t("packages.new")}</button><//>`;
}

function newPackage() {
  dialog.value = { kind: "new_package" };
}

const ADDED = /** @type {const} */ (["node", "launch_file", "message", "service", "action"]);
const ADD_ICONS = {
  node: "node",
  launch_file: "launch",
  message: "shapes",
  service: "link",
  action: "goal",
};

/** @param {PackageView} one @returns {MenuItem[]} what can be added to it */
const addItems = (one) =>
  ADDED.map((what) => ({
    label: `${t(`packages.add.${what}`)}…`,
    icon: ADD_ICONS[what],
    run: () => {
      dialog.value = { kind: "add_to_package", what, folder: one.folder, name: one.name };
    },
  }));

/** @param {{words: {value: string}, asGraph: {value: boolean}}} props */
function Bar({ words, asGraph }) {
  return html`<div class="panel-bar packages-bar">
    <${SearchBox} label=${t("packages.search")} value=${words.value} onInput=${(
      /** @type {string} */ now,
    ) => {
      words.value = now;
    }} />
    <${Segments} label=${t("packages.view")} chosen=${asGraph} of=${[
      [false, t("packages.list")],
      [true, t("packages.graph")],
    ]} />
    ${mayRun.value && html`<button type="button" class="button small" onClick=${newPackage}><${Icon} name="plus" size=${13} />${t("packages.new")}</button>`}
  </div>
  ${
    lastEdit.value &&
    html`<p class="packages-edit" role="status"><span>${t("packages.edited", { label: lastEdit.value.label, count: lastEdit.value.files.length })}</span>
    <button type="button" class="text-button" onClick=${undoEdit}>${t("packages.undo")}</button></p>`
  }`;
}

/** @param {{all: readonly WorkspaceView[], words: string, asGraph: boolean}} props */
function Shown({ all, words, asGraph }) {
  if (asGraph) return html`<${PackageGraph} all=${all} />`;
  const isMeant = (/** @type {PackageView} */ one) => isSought(one, words);
  return html`<div class="scroll packages-list" tabindex="0" role="region" aria-label=${t("packages.list")}>
    ${all.map(
      (workspace) => html`<section key=${workspace.root} aria-label=${workspace.root}>
      ${all.length > 1 && html`<h3 title=${workspace.root}>${baseName(workspace.root)}</h3>`}
      ${workspace.packages.filter(isMeant).map((one) => html`<${Package} key=${one.folder} one=${one} workspace=${workspace} />`)}
      ${workspace.left_out.map((sentence) => html`<p key=${sentence} class="note padded">${sentence}</p>`)}</section>`,
    )}
    ${!mayRun.value && html`<${NoRuns} icon="lock" />`}</div>`;
}

/** @param {PackageView} one @param {string} words @returns {boolean} each of the words is somewhere in it */
export function isSought(one, words) {
  const all = [
    one.name,
    one.description,
    ...one.executables.map(({ name }) => name),
    ...one.interfaces.map(({ name }) => name),
    ...one.launch_files.map(({ file }) => baseName(file)),
  ];
  const text = all.join(" ").toLowerCase();
  return words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}

/** @param {readonly Problem[]} problems @param {PackageView} one @returns {Problem[]} those in its files */
export const problemsOf = (problems, one) =>
  problems.filter(({ place }) => place?.file.startsWith(`${one.folder}/`));

/** @param {{one: PackageView, workspace: WorkspaceView}} props */
function Package({ one, workspace }) {
  const isOpen = chosenPackage.value === one.folder || packages.value.length === 1;
  const found = problemsOf(workspace.problems, one);
  const { faults, notes } = byWeight(found);
  const counted = faults.length > 0 ? faults : notes;
  const toggle = () => {
    chosenPackage.value = isOpen ? "" : one.folder;
  };
  return html`<article class=${`packages-package ${isOpen ? "open" : ""}`}>
    <header><button type="button" class="row-button packages-name" aria-expanded=${isOpen} title=${one.folder} onClick=${toggle}>
        <${Icon} name=${isOpen ? "chevronDown" : "chevronRight"} size=${14} /><${Icon} name="package" size=${15} /><strong>${one.name}</strong><span class="muted">${one.build_type}</span>
        ${counted.length > 0 && html`<span class=${`badge ${badgeTone(counted)}`} title=${countWords(counted)}>${counted.length}</span>`}</button>
      ${one.may_run && html`<${MenuButton} label=${t("packages.add", { name: one.name })} items=${() => addItems(one)}><${Icon} name="plus" /><//>`}</header>
    ${isOpen && html`<${Details} one=${one} faults=${faults} notes=${notes} graph=${workspace.graph} />`}
  </article>`;
}

/** @param {{title: string, children: ComponentChildren}} props */
const Section = ({ title, children }) =>
  html`<section class="packages-section" aria-label=${title}><h3>${title}</h3>${children}</section>`;

/** @param {readonly Problem[]} found @returns {{faults: Problem[], notes: Problem[]}} `notes`: nothing fails for them, as in a package that was just made */
function byWeight(found) {
  const isNote = (/** @type {Problem} */ { severity }) => severity === "info";
  return { faults: found.filter((one) => !isNote(one)), notes: found.filter(isNote) };
}

/** @param {readonly Problem[]} found all faults, or all notes */
const countWords = (found) =>
  t(found[0]?.severity === "info" ? "packages.notes" : "packages.findings", {
    count: found.length,
  });

/** @param {{found: readonly Problem[]}} props */
const Findings = ({ found }) =>
  found.length > 0 &&
  html`<${Section} title=${countWords(found)}><ul>${found.map((problem, at) => html`<${Finding} key=${at} problem=${problem} />`)}</ul><//>`;

/** @param {{one: PackageView, faults: readonly Problem[], notes: readonly Problem[], graph: WorkspaceView["graph"]}} props */
function Details({ one, faults, notes, graph }) {
  return html`<div class="packages-details">
    ${one.description && html`<p class="note">${one.description}</p>`}
    ${one.fault && html`<p class="note bad">${one.fault}</p>`}
    ${one.is_nested && html`<p class="note">${t("packages.nested")}</p>`}
    <${Findings} found=${faults} />
    ${one.executables.length > 0 && html`<${Section} title=${t("packages.executables")}><ul>${one.executables.map((each) => html`<${Executable} key=${each.name} one=${one} each=${each} />`)}</ul><//>`}
    <${Files} one=${one} />
    ${one.dependencies.length > 0 && html`<${Dependencies} one=${one} graph=${graph} />`}
    <${Findings} found=${notes} />
  </div>`;
}

/** @param {{problem: Problem}} props */
function Finding({ problem }) {
  return html`<li class=${`packages-finding ${problem.severity}`}><${Icon} name=${SEVERITY_ICONS[problem.severity]} size=${14} />
    <span class="packages-row-name">${problem.sentence}</span><${PlaceLink} place=${problem.place} />
    ${problem.fix && mayRun.value && html`<button type="button" class="button small" onClick=${() => mendPackage(problem)}>${problem.fix.label}</button>`}</li>`;
}

/** @param {PackageView} one @param {ExecutableView} each @returns {RunView | undefined} its newest run */
const runOf = (one, each) =>
  runs.value?.find(
    (run) => run.kind === "node" && run.package === one.name && run.executable === each.name,
  );

/** @param {{one: PackageView, each: ExecutableView}} props */
function Executable({ one, each }) {
  const run = runOf(one, each);
  const { file } = each;
  return html`<li class="packages-executable"><div class="packages-row">
      <${StateDot} of=${run} />
      ${file ? html`<button type="button" class="text-button packages-row-name" title=${file} onClick=${() => showSource(file, 1)}>${each.name}</button>` : html`<span class="packages-row-name">${each.name}</span>`}
      <span class="muted">${each.language}</span>
      ${run && html`<${IconButton} icon="log" size=${14} label=${t("packages.output", { name: each.name })} onClick=${() => showRun(run.run)} />`}
      ${one.may_run && each.language !== "c++" && html`<${RunButton} one=${one} each=${each} run=${run} />`}</div>
    ${each.fault && html`<p class="note bad">${each.fault}</p>`}
    ${run && html`<${HowItRuns} each=${each} run=${run} />`}</li>`;
}

/** @param {{one: PackageView, each: ExecutableView, run: RunView | undefined}} props */
function RunButton({ one, each, run }) {
  const { busy, during } = useBusy();
  if (run && isUnderWay(run))
    return html`<button type="button" class="button small" disabled=${busy} aria-label=${t("packages.stop.of", { name: each.name })} onClick=${during(() => stopRun(run.run))}><${Icon} name="stop" size=${12} />${t("launching.stop")}</button>`;
  return html`<button type="button" class="button small primary" disabled=${busy} aria-label=${t("packages.run.of", { name: each.name })} onClick=${during(() => startNode(one.name, each.name))}><${Icon} name="animate" size=${12} />${t("packages.run")}</button>`;
}

/** @param {{each: ExecutableView, run: RunView}} props */
function HowItRuns({ each, run }) {
  const isOffered = isUnderWay(run) || run.again_on_save;
  return html`${isOffered && html`<${AgainOnSave} run=${run} label=${t("packages.again.of", { name: each.name })} />`}
    ${hasFailed(run) && html`<p class="note bad">${t("packages.failed", { code: run.code, reason: run.trouble })}</p>`}`;
}

/** @param {{one: PackageView}} props what opens in other panels */
function Files({ one }) {
  const texts = ["package.xml", "setup.py", "setup.cfg", "CMakeLists.txt"];
  const has = (/** @type {string} */ name) =>
    name === "package.xml" ||
    (one.build_type === "ament_python" ? name.startsWith("setup") : name === "CMakeLists.txt");
  return html`
    <${Rows} title=${t("packages.launch_files")} icon="launch" files=${one.launch_files.map(({ file }) => file)} folder=${one.folder} open=${(/** @type {string} */ file) => openLaunch(file)} />
    ${one.interfaces.length > 0 && html`<${Interfaces} one=${one} />`}
    <${Rows} title=${t("packages.robots")} icon="robot" files=${one.robots.filter(({ openable }) => openable).map(({ file }) => file)} folder=${one.folder} open=${(/** @type {string} */ file) => openPath(file, {})} />
    <${Rows} title=${t("packages.views")} icon="eye" files=${one.rviz_configs} folder=${one.folder} open=${(/** @type {string} */ file) => openConfigFile(file)} />
    <${Rows} title=${t("packages.parameter_files")} icon="settings" files=${one.parameter_files.map(({ file }) => file)} folder=${one.folder} open=${(/** @type {string} */ file) => showSource(file, 1)} />
    <${Rows} title=${t("packages.files")} icon="file" files=${texts.filter(has).map((name) => `${one.folder}/${name}`)} folder=${one.folder} open=${(/** @type {string} */ file) => showSource(file, 1)} />`;
}

/** @param {{title: string, icon: string, files: readonly string[], folder: string, open: (file: string) => unknown}} props */
function Rows({ title, icon, files, folder, open }) {
  if (files.length === 0) return null;
  return html`<${Section} title=${title}><ul>${files.map(
    (file) =>
      html`<li key=${file} class="packages-row"><${Icon} name=${icon} size=${14} /><button type="button" class="text-button packages-row-name" title=${file} onClick=${() => open(file)}>${shortPath(file, folder)}</button></li>`,
  )}</ul><//>`;
}

/** @param {{one: PackageView}} props */
function Interfaces({ one }) {
  const show = (/** @type {string} */ name) => () => {
    void showInterface(name);
    commandById("panel.interfaces")?.run();
  };
  return html`<${Section} title=${t("packages.interfaces")}><ul>${one.interfaces.map(
    (each) =>
      html`<li key=${each.name} class="packages-row"><${Icon} name="shapes" size=${14} /><button type="button" class="text-button packages-row-name" onClick=${show(each.name)}>${each.name.split("/").slice(1).join("/")}</button>
        <${IconButton} icon="source" size=${13} label=${t("packages.source", { name: each.name })} onClick=${() => showSource(each.file, each.line || 1)} />
        ${each.fault && html`<span class="bad">${each.fault}</span>`}</li>`,
  )}</ul><//>`;
}

/** @param {{one: PackageView, graph: WorkspaceView["graph"]}} props */
function Dependencies({ one, graph }) {
  const inCycle = graph.cycles.find((cycle) => cycle.includes(one.name));
  return html`<${Section} title=${t("packages.dependencies")}>
    ${inCycle && html`<p class="note bad">${t("packages.cycle", { names: inCycle.join(", ") })}</p>`}
    <ul class="packages-needs">${one.dependencies.map(
      (each) =>
        html`<li key=${each.name} class=${`packages-need ${each.presence}`} title=${`${each.kinds.join(", ")} · ${t(`packages.presence.${each.presence}`)}`}>${each.name}${each.presence === "unknown" && html` <span class="hidden-words">(${t("packages.presence.unknown")})</span><${Icon} name="help" size=${12} />`}</li>`,
    )}</ul><//>`;
}
