/** What the owner runs out of the page: the packages of the opened folders, plans, and what runs. */

/** @import { OutputLine, PackageView, Plan, RunOutput, RunView, Workspaces } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { askedWhenChanged, askOrKeepWhy } from "./asking.js";
import { mayManage, session } from "./connection.js";
import { packageProblems } from "./document.js";
import { ask, packageMender } from "./requests.js";
import { connectRos, ros } from "./ros.js";
import { openConfigFile } from "./rviz-configs.js";
import { notify } from "./view.js";

/** As many lines as are kept of one run here. */
const LINES_MAX = 5000;

/** Null: not known yet. @type {Signal<Workspaces | null>} */
export const workspaces = signal(null);
export const workspacesRefused = signal("");
/** The newest first; null: not known yet. @type {Signal<readonly RunView[] | null>} */
export const runs = signal(null);
/** When that was told, ms as `performance.now` has it. */
export const runsToldAt_ms = signal(0);
export const runsRefused = signal("");
/** The launch file that is looked at; empty: none was chosen. */
export const chosenLaunch = remembered("launch.file", "");
/** The package that is looked at, by its folder. */
export const chosenPackage = remembered("packages.folder", "");
/** What was given to the arguments of that file. @type {Signal<Record<string, string>>} */
export const launchValues = signal({});
/** The part of the Launch panel that is shown. @type {Signal<"plan" | "graph" | "runs">} */
export const launchPart = signal("plan");
/** The run whose output is shown; 0: the newest. */
export const chosenRun = signal(0);

/** Whether anything may be run. */
export const mayRun = computed(
  () => mayManage.value && (workspaces.value?.run_folders.length ?? 0) > 0,
);

/** @type {Signal<readonly PackageView[]>} */
export const packages = computed(
  () => workspaces.value?.workspaces.flatMap(({ packages: inside }) => inside) ?? [],
);

effect(() => {
  packageProblems.value = workspaces.value?.workspaces.flatMap((one) => one.problems) ?? [];
});

/** @typedef {Pick<RunOutput, "run" | "lines" | "last" | "dropped">} Output */
/** @type {Output} */
const NOTHING_PRINTED = { run: 0, lines: [], last: 0, dropped: 0 };
/** What the run that is looked at printed. @type {Signal<Output>} */
export const output = signal(NOTHING_PRINTED);
/** The run whose output is asked for; 0: none is. */
let heard = 0;

/** @param {Output} known @param {Output} answer since then @returns {Output} */
export function withPrinted(known, answer) {
  if (answer.run !== known.run || answer.last < known.last) return answer;
  if (answer.lines.length === 0) return { ...known, last: answer.last, dropped: answer.dropped };
  return { ...answer, lines: [...known.lines, ...answer.lines].slice(-LINES_MAX) };
}

/** Ask for the packages. */
export async function askWorkspaces() {
  if (!mayManage.peek()) return;
  const answer = await askOrKeepWhy({ type: "get_workspaces" }, workspacesRefused);
  if (answer?.type === "workspaces") workspaces.value = answer;
}

/** Keep them true while somebody looks; gives the end of looking. */
export const followWorkspaces = askedWhenChanged(askWorkspaces, "workspaces");

/** Keep what runs true while somebody looks; gives the end of looking. */
const followRuns = askedWhenChanged(async () => {
  if (!mayManage.peek()) return false;
  const answer = await askOrKeepWhy({ type: "get_runs" }, runsRefused);
  if (answer?.type === "runs") {
    runsToldAt_ms.value = performance.now();
    runs.value = answer.runs;
    showWhatIsMeant(answer.runs);
  }
  return askOutput();
}, "runs");

/** Keep both true while somebody looks; gives the end of looking. */
export function followPrograms() {
  const ends = [followWorkspaces(), followRuns()];
  return () => {
    for (const end of ends) end();
  };
}

/** @returns {Promise<boolean>} there is more to be asked for at once */
async function askOutput() {
  const [run, known] = [heard, output.peek()];
  if (run === 0 || !runs.peek()?.some((one) => one.run === run)) return false;
  const after = known.run === run ? known.last : 0;
  const answer = await askOrKeepWhy({ type: "get_run_output", run, after }, runsRefused);
  if (answer?.type !== "run_output" || heard !== run || output.peek() !== known) return false;
  const newest = answer.lines.at(-1)?.number ?? answer.last;
  output.value = withPrinted(known, { ...answer, last: newest });
  return newest < answer.last;
}

/** Have what a run prints be told. @param {number} run 0: of none */
export function showOutput(run) {
  if (heard === run) return;
  heard = run;
  output.value = { ...NOTHING_PRINTED, run };
  void askOutput().then((more) => more && askOutput());
}

// A studio that was started anew has other runs.
effect(() => {
  session.value;
  runs.value = null;
  workspaces.value = null;
  output.value = NOTHING_PRINTED;
});

/** Runs of this page whose `rviz2` was not shown yet. @type {Set<number>} */
const expected = new Set();

/** @param {readonly RunView[]} all the config of an rviz2 that this page launched is opened once */
function showWhatIsMeant(all) {
  for (const { run, shown } of all) {
    const view = shown.find(({ what }) => what === "rviz2");
    if (!view || !expected.delete(run)) continue;
    commandById("panel.scene")?.run();
    if (view.config) void openConfigFile(view.config, { briefly: true });
  }
}

/** @returns {Promise<boolean>} the studio is in a ROS 2 system: it joins the usual one if it is in none */
async function joined() {
  if (ros.value.state !== "connected" && ros.value.state !== "lost") await connectRos();
  return ros.value.state === "connected" || ros.value.state === "connecting";
}

/** @param {string} file @param {Record<string, string>} values */
export async function startLaunch(file, values) {
  if (!(await joined())) return;
  const answer = await ask({ type: "start_launch", file, arguments: values });
  if (answer?.type !== "run_started") return;
  expected.add(answer.run);
  chosenRun.value = answer.run;
}

/** @param {string} name of a package @param {string} executable @param {readonly string[]} [words] behind it @returns {Promise<number>} its run; 0: it was refused */
export async function startNode(name, executable, words = []) {
  if (!(await joined())) return 0;
  const answer = await ask({
    type: "start_node",
    package: name,
    executable,
    arguments: [...words],
  });
  if (answer?.type !== "run_started") return 0;
  chosenRun.value = answer.run;
  return answer.run;
}

/** @param {number} run */
export const stopRun = (run) => ask({ type: "stop_run", run });
/** @param {number} run */
export async function startRunAgain(run) {
  if (await joined()) await ask({ type: "start_run_again", run });
}
/** @param {number} run @param {number} process */
export const restartProcess = (run, process) => ask({ type: "restart_process", run, process });
/** @param {number} run @param {number} process */
export const endProcess = (run, process) => ask({ type: "end_process", run, process });
/** @param {number} run @param {boolean} on */
export const runAgainOnSave = (run, on) => ask({ type: "run_again_on_save", run, on });
/** @param {number} run */
export const forgetRun = (run) => ask({ type: "forget_run", run });

/** @param {RunView} run @returns {boolean} it goes on */
export const isUnderWay = ({ state }) => state !== "ended";

/** A launch file in its panel. @param {string} file @param {Record<string, string>} [values] of its arguments */
export function openLaunch(file, values = {}) {
  chosenLaunch.value = file;
  launchValues.value = values;
  launchPart.value = "plan";
  commandById("panel.launch")?.run();
}

/** What a run prints, in the panel of launch files. @param {number} run */
export function showRun(run) {
  chosenRun.value = run;
  launchPart.value = "runs";
  commandById("panel.launch")?.run();
}

/** A package edit was made: say so, with what is left to a person. @param {import("../types/wire.d.ts").PackageEdited} edited */
export function tellEdited(edited) {
  lastEdit.value = edited;
  const action = { label: t("packages.undo"), run: () => void undoEdit() };
  notify(t("packages.edited", { label: edited.label, count: edited.files.length }), { action });
}

/** @param {import("../types/wire.d.ts").Problem} problem of a package, with a fix */
export async function mendPackage({ code, sentence, fix }) {
  const answer = await ask({ type: "mend_package", code, sentence, label: fix?.label ?? "" });
  if (answer?.type === "package_edited") tellEdited(answer);
}

packageMender.mend = mendPackage;

/** The newest edit of packages that this page made; null: none, or it was taken back. @type {Signal<import("../types/wire.d.ts").PackageEdited | null>} */
export const lastEdit = signal(null);

/** Take it back. */
export async function undoEdit() {
  const edited = lastEdit.value;
  if (edited && (await ask({ type: "undo_package_edit", edit: edited.edit }))) {
    lastEdit.value = null;
    notify(t("packages.undone", { label: edited.label }));
  }
}

/** @param {OutputLine} line @param {{words: string, process: number | null, errors: boolean}} filter @returns {boolean} */
export function isShown(line, { words, process, errors }) {
  if (process !== null && line.process !== process) return false;
  if (errors && line.stream !== "stderr" && line.stream !== "error") return false;
  return words === "" || line.text.toLowerCase().includes(words.toLowerCase());
}

/**
 * What is planned as one plan of what starts: nodes and processes below the file that names them.
 *
 * @typedef {{id: number | null, file: string, level: number, include: Plan["includes"][number] | null, nodes: Plan["nodes"], processes: Plan["processes"]}} PlanPart
 * @param {Plan} plan
 * @returns {PlanPart[]} the file itself first, then each include below the one that names it
 */
export function planParts(plan) {
  /** @type {PlanPart[]} */
  const parts = [];
  /** @type {Set<number | null>} */
  const seen = new Set();
  const add = (
    /** @type {number | null} */ id,
    /** @type {Plan["includes"][number] | null} */ include,
    /** @type {number} */ level,
  ) => {
    if (seen.has(id)) return;
    seen.add(id);
    parts.push({
      id,
      file: include?.file ?? plan.file,
      level,
      include,
      nodes: plan.nodes.filter((one) => one.include === id),
      processes: plan.processes.filter((one) => one.include === id),
    });
    for (const inner of plan.includes) if (inner.parent === id) add(inner.id, inner, level + 1);
  };
  add(null, null, 0);
  return parts;
}
