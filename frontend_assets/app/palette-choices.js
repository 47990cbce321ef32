/** What the palette offers: commands, panels, and every named thing of the robot and its files. */

/** @import { Ranked } from "../lib/ranking.js" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { ExampleEntry, JointView, Problem, SiteView } from "../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { commandById, commandLabel, commands, onMac, shortcutText } from "../lib/commands.js";
import { shownText } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { baseName, placeText, shortPath } from "../lib/paths.js";
import { SEVERITY_ICONS } from "../lib/ui.js";
import { mayEdit, mayManage } from "../model/connection.js";
import { allSites, documentState, movable, problems, robot, siteOrder } from "../model/document.js";
import { applyPose, poses } from "../model/poses.js";
import { ask, openNamed } from "../model/requests.js";
import { selectPart } from "../model/selection.js";
import { showFile, shownFile, showSource } from "../model/source.js";
import { applyVariant, variants } from "../model/variants.js";
import { propertyFilter, soughtSite } from "../model/view.js";
import { focusLink, viewport } from "../model/viewport.js";
import { compareWith } from "./menu-commands.js";
import { panelTitle } from "./panels.js";

/**
 * @typedef {Ranked & {key: string, icon: string, hint: string, does: string, run: () => void}} Choice
 *   `does`: what Enter does, in words
 */

/** The robots that come with the studio; null: not known yet. @type {Signal<readonly ExampleEntry[] | null>} */
export const examples = signal(null);

/** Ask for them, once. */
export async function askExamples() {
  if (examples.peek()) return;
  const answer = await ask({ type: "list_examples" });
  if (answer?.type === "examples") examples.value = answer.examples;
}

/** @returns {Choice[]} */
export function allChoices() {
  return [
    ...commandChoices(),
    ...exampleChoices(),
    ...linkChoices(),
    ...jointChoices(),
    ...poseChoices(),
    ...variantChoices(),
    ...propertyChoices(),
    ...fileChoices(0),
    ...problemChoices(),
  ];
}

/** @returns {Choice[]} what can be done now, panels among it */
export function commandChoices() {
  return commands.value
    .filter(({ id, enabled }) => id !== "palette" && (enabled?.() ?? true))
    .map((command) => {
      const [key] = command.keys ?? [];
      const panel = command.id.startsWith("panel.") ? command.id.slice("panel.".length) : "";
      return {
        rank: panel ? "panel" : "command",
        key: command.id,
        icon: command.icon,
        label: panel ? panelTitle(panel) : commandLabel(command),
        words: `${commandLabel(command)} ${wordsFor(command.id)}`,
        hint: key ? shortcutText(key, onMac) : "",
        does: panel ? t("palette.does.panel") : t("palette.does.command"),
        run: command.run,
      };
    });
}

/** @param {string} id of a command @returns {string} what else people call it; empty: nothing */
function wordsFor(id) {
  const key = `palette.also.${id}`;
  const words = t(key);
  return words === key ? "" : words;
}

/** @returns {Choice[]} the robots that come with the studio, once they are told */
function exampleChoices() {
  if (!mayManage.value) return [];
  return (examples.value ?? []).map(({ name, robot: title }) => ({
    rank: "example",
    key: `example ${name}`,
    icon: "robot",
    label: t("palette.example", { name: title }),
    words: name,
    hint: name,
    does: t("palette.does.example"),
    run: () => void openNamed({ type: "open_example", name }),
  }));
}

/** @returns {Choice[]} */
export function linkChoices() {
  return (robot.value?.links ?? []).map(({ name }) => ({
    rank: "link",
    key: `link ${name}`,
    icon: "box",
    label: name,
    words: t("palette.link", { name }),
    hint: "",
    does: t("palette.does.link"),
    run: () => focusLink(name),
  }));
}

/** @returns {Choice[]} */
export function jointChoices() {
  return (robot.value?.joints ?? []).map((joint) => ({
    rank: "joint",
    key: `joint ${joint.name}`,
    icon: "joints",
    label: joint.name,
    words: t("palette.joint", { name: joint.name }),
    hint: joint.type,
    does: t(isMovable(joint) ? "palette.does.joint" : "palette.does.fixed"),
    run: () => showJoint(joint),
  }));
}

/** @param {JointView} joint */
const isMovable = ({ name }) => movable.value.some((one) => one.name === name);

/** @param {JointView} joint a fixed one has no slider, only a place where it comes from */
function showJoint(joint) {
  selectPart(`joint:${joint.name}`, "", "", "palette");
  commandById(isMovable(joint) ? "panel.joints" : "panel.origin")?.run();
  viewport.value?.focus(joint.child);
}

/** @returns {Choice[]} */
export function propertyChoices() {
  const sites = allSites();
  return siteOrder.value.flatMap((id) => {
    const site = sites.get(id);
    return site ? [propertyChoice(site)] : [];
  });
}

/** @param {SiteView} site @returns {Choice} texts without a name are told apart by their places */
function propertyChoice(site) {
  const unnamed = site.kind === "literal";
  const text = shownText(site.argument ?? site.text);
  return {
    rank: unnamed ? "literal" : "property",
    key: site.id,
    icon: "properties",
    label: site.name,
    words: t("palette.property", { name: site.name }),
    hint: unnamed ? `${text} · ${placeText(site)}` : text,
    does: t("palette.does.property"),
    run: () => {
      propertyFilter.value = "";
      commandById("panel.properties")?.run();
      soughtSite.value = site.id;
    },
  };
}

/** @returns {Choice[]} */
function poseChoices() {
  if (!mayEdit.value) return [];
  return poses.value.poses.map(({ key, name, group, file }) => ({
    rank: "pose",
    key: `pose ${key}`,
    icon: "joints",
    label: t("palette.pose", { name }),
    hint: group || baseName(file),
    does: t("palette.does.pose"),
    run: () => void applyPose(key),
  }));
}

/** @returns {Choice[]} */
function variantChoices() {
  if (!mayEdit.value) return [];
  return variants.value.variants.flatMap(({ name, note }) => [
    {
      rank: "variant",
      key: `variant ${name}`,
      icon: "variants",
      label: t("palette.variant", { name }),
      hint: shownText(note),
      does: t("palette.does.variant"),
      run: () => void applyVariant(name),
    },
    {
      rank: "variant",
      key: `compare ${name}`,
      icon: "compare",
      label: t("palette.compare", { name }),
      hint: "",
      does: t("palette.does.compare"),
      run: () => compareWith({ kind: "variant", name }),
    },
  ]);
}

/** @param {number} line 0: none is asked for @returns {Choice[]} */
export function fileChoices(line) {
  const state = documentState.value;
  return (state?.files ?? []).map((file) => ({
    rank: "file",
    key: `file ${file}`,
    icon: "fileCode",
    label: shortPath(file, state?.root ?? ""),
    words: t("palette.file", { name: shortPath(file, state?.root ?? "") }),
    hint: line > 0 ? t("palette.line", { line }) : "",
    does: line > 0 ? t("palette.does.line", { line }) : t("palette.does.file"),
    run: () => (line > 0 ? showSource(file, line) : showFile(file)),
  }));
}

/** @param {number} line @param {number} column @returns {Choice[]} that line of the file in front */
export function lineChoices(line, column) {
  const file = shownFile.value || documentState.value?.files[0];
  if (!file || line < 1) return [];
  return [
    {
      rank: "line",
      key: "line",
      icon: "jump",
      label: t("palette.line_of", { line, file: baseName(file) }),
      hint: "",
      does: t("palette.does.line", { line }),
      run: () => showSource(file, line, column),
    },
  ];
}

/** @returns {Choice[]} */
export function problemChoices() {
  return problems.value.map((problem, at) => ({
    rank: "problem",
    key: `problem ${at}`,
    icon: SEVERITY_ICONS[problem.severity],
    label: problem.sentence,
    words: problem.code,
    hint: placeText(problem.place),
    does: t(problem.place?.line ? "palette.does.problem" : "palette.does.panel"),
    run: () => showProblem(problem),
  }));
}

/** @param {Problem} problem */
function showProblem({ place }) {
  commandById("panel.problems")?.run();
  if (place?.line) showSource(place.file, place.line, place.column || 1);
}
