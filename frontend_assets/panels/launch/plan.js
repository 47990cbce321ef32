/** The plan of a launch file: the form of its arguments, and the list of what it would start. */

/** @import { Plan, PlannedArgument, PlannedCondition, PlannedNode, PlannedParameter, PlannedProcess, PlannedRobot, Where } from "../../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { baseName } from "../../lib/paths.js";
import { Icon, IconButton, Switch } from "../../lib/ui.js";
import { planParts } from "../../model/programs.js";
import { openPath } from "../../model/requests.js";
import { PlaceLink } from "../parts.js";

/** @typedef {(name: string, value: string | null) => void} Write null: the default counts again */

/** @param {{plan: Plan, values: Record<string, string>, write: Write}} props */
export function LaunchPlan({ plan, values, write }) {
  return html`<${Faults} plan=${plan} />
    <${Arguments} plan=${plan} values=${values} write=${write} />
    <${Robots} plan=${plan} />
    <section aria-label=${t("launching.nodes")}><h3>${t("launching.nodes")}</h3>
      ${plan.nodes.length + plan.processes.length === 0 && html`<p class="note">${t("launching.nodes.none")}</p>`}
      ${planParts(plan).map((one) => html`<${Part} key=${one.id} one=${one} />`)}</section>
    <${Later} plan=${plan} />
    <${Gaps} plan=${plan} />`;
}

/** @param {{where: Where}} props */
const LineLink = ({ where }) =>
  where.line > 0
    ? html`<${PlaceLink} place=${{ file: where.file, line: where.line, column: 1 }} />`
    : null;

/** @param {{plan: Plan}} props */
function Faults({ plan }) {
  const ended = plan.ended ? [{ sentence: plan.ended, where: { file: "", line: 0 } }] : [];
  const unknown = plan.unknown.map((name) => ({
    sentence: t("launching.unknown", { name }),
    where: { file: "", line: 0 },
  }));
  const all = [...plan.failures, ...ended, ...unknown];
  if (all.length === 0) return null;
  return html`<ul class="launching-faults" role="alert">${all.map(
    ({ sentence, where }) =>
      html`<li key=${sentence}><${Icon} name="error" size=${14} /><span>${sentence}</span><${LineLink} where=${where} /></li>`,
  )}</ul>`;
}

/** @param {{plan: Plan, values: Record<string, string>, write: Write}} props */
function Arguments({ plan, values, write }) {
  if (plan.arguments.length === 0)
    return html`<section aria-label=${t("launching.arguments")}><h3>${t("launching.arguments")}</h3><p class="note">${t("launching.arguments.none")}</p></section>`;
  return html`<section aria-label=${t("launching.arguments")}><h3>${t("launching.arguments")}</h3>
    ${plan.arguments.map(
      (one) =>
        html`<${Argument} key=${`${one.include} ${one.name}`} one=${one} value=${values[one.name]} write=${write} />`,
    )}</section>`;
}

/** @param {{one: PlannedArgument, value: string | undefined, write: Write}} props a row as in the form of a robot's arguments */
function Argument({ one, value, write }) {
  const isOff = one.condition?.holds === false;
  return html`<div class=${`launch-row ${value === undefined ? "" : "set"} ${isOff ? "off" : ""}`} role="group" aria-label=${one.name}>
    <div class="launch-name"><span>${one.name}</span>${one.description && html`<small>${one.description}</small>`}
      ${isOff && html`<small>${t("launching.only_if", { condition: one.condition?.text ?? "" })}</small>`}</div>
    <div class="launch-value"><${Field} one=${one} value=${value} write=${write} /></div>
    <${IconButton} icon="reset" label=${t("launching.reset", { name: one.name })} disabled=${value === undefined} onClick=${() => write(one.name, null)} />
  </div>`;
}

/** @param {string | null} text */
const isFlag = (text) => /^(true|false)$/i.test(text ?? "");

/** @typedef {{one: PlannedArgument, value: string | undefined, write: Write}} FieldProps */

/** @param {FieldProps} props */
function Field(props) {
  const { one, value } = props;
  const isFlags = one.choices.length > 0 ? one.choices.every(isFlag) : isFlag(one.default);
  if (isFlags && isFlag(value ?? one.value)) return html`<${Flag} ...${props} />`;
  return one.choices.length > 0 ? html`<${Choice} ...${props} />` : html`<${Words} ...${props} />`;
}

/** @param {FieldProps} props as the file writes it: Python's True is no other value than true */
function Flag({ one, value, write }) {
  const [on, off] = /^[TF]/.test(one.default ?? "") ? ["True", "False"] : ["true", "false"];
  const isOn = /^true$/i.test(value ?? one.value ?? "");
  return html`<${Switch} label=${one.name} checked=${isOn} onChange=${(/** @type {boolean} */ next) => write(one.name, next ? on : off)} />`;
}

/** @param {FieldProps} props */
const isLacking = ({ one, value }) => value === undefined && one.value === null;

/** @param {FieldProps} props */
function Choice(props) {
  const { one, value, write } = props;
  const now = value ?? one.value ?? "";
  const lacks = isLacking(props);
  const others = lacks || one.choices.includes(now) ? [] : [now];
  const choose = (/** @type {any} */ event) => write(one.name, event.currentTarget.value);
  return html`<select class="box" aria-label=${one.name} aria-invalid=${lacks} value=${now} onChange=${choose}>
    ${lacks && html`<option value="">${t("launching.choose")}</option>`}
    ${[...others, ...one.choices].map((choice) => html`<option key=${choice} value=${choice}>${choice || t("launching.empty")}</option>`)}</select>`;
}

/** @param {FieldProps} props */
function Words(props) {
  const { one, value, write } = props;
  const placeholder = one.value ?? one.default ?? t("launching.needed");
  const type = (/** @type {any} */ event) => write(one.name, event.currentTarget.value);
  return html`<input type="text" class="box wide" aria-label=${one.name} aria-invalid=${isLacking(props)} spellcheck=${false} value=${value ?? ""}
    placeholder=${placeholder} title=${value ?? placeholder} onInput=${type} />`;
}

/** @param {{plan: Plan}} props */
function Robots({ plan }) {
  if (plan.robots.length === 0) return null;
  return html`<section aria-label=${t("launching.robots")}><h3>${t("launching.robots")}</h3>
    <ul class="launching-robots">${plan.robots.map((one, at) => html`<${Robot} key=${at} one=${one} />`)}</ul></section>`;
}

/** @param {{one: PlannedRobot}} props */
function Robot({ one }) {
  const words = Object.entries(one.mappings).map(([name, value]) => `${name}:=${value}`);
  return html`<li><${Icon} name="robot" /><span class="launching-robot"><span title=${one.file}>${baseName(one.file)}</span>
    ${words.length > 0 && html`<small>${words.join(" ")}</small>`}</span>
    <button type="button" class="button small" onClick=${() => openPath(one.file, one.mappings)}>${t("launching.open_robot")}</button></li>`;
}

/** @param {{one: import("../../model/programs.js").PlanPart}} props what one file names */
function Part({ one }) {
  const { include } = one;
  const isOff = include?.condition?.holds === false;
  return html`<div class=${`launching-include ${isOff ? "off" : ""}`} style=${`--level:${one.level}`}>
    ${
      include &&
      html`<p class="launching-include-name"><${Icon} name="includes" size=${14} /><span title=${include.file}>${baseName(include.file)}</span><${LineLink} where=${include.where} />
      <${Reasons} condition=${include.condition} when=${include.when} />
      ${include.failed && html`<span class="bad">${include.failed}</span>`}</p>`
    }
    <ul class="launching-nodes">${one.nodes.map((node) => html`<${NodeRow} key=${node.id} node=${node} />`)}
      ${one.processes.map((process) => html`<${ProcessRow} key=${process.id} process=${process} />`)}</ul></div>`;
}

/** @param {{condition: PlannedCondition | null, when: string}} props why it is not started, or not at once */
function Reasons({ condition, when }) {
  if (!condition && !when) return null;
  const word =
    condition?.holds === false
      ? "not_because"
      : condition?.holds === null
        ? "unknown_if"
        : "because";
  return html`<span class="launching-reason">${condition && t(`launching.${word}`, { condition: condition.text })}${condition && when ? " · " : ""}${when}</span>`;
}

/** @param {{node: PlannedNode}} props */
function NodeRow({ node }) {
  const isOpen = useSignal(false);
  const isOff = node.condition?.holds === false;
  const details = detailsOf(node);
  const name = node.full_name || node.name || node.executable;
  const toggle = () => {
    isOpen.value = !isOpen.value;
  };
  return html`<li class=${`launching-node ${isOff ? "off" : ""}`}>
    <div class="launching-line"><button type="button" class="launching-toggle" aria-expanded=${isOpen.value} disabled=${details.length === 0} onClick=${toggle}>
        <${Icon} name=${details.length > 0 ? (isOpen.value ? "chevronDown" : "chevronRight") : "dot"} size=${13} /><strong>${name}</strong><span class="muted">${name === node.executable ? node.package : `${node.package} ${node.executable}`}</span></button>
      <${LineLink} where=${node.where} /></div>
    <${Reasons} condition=${node.condition} when=${node.when} />
    ${node.start.kind === "none" && node.start.text && !isOff && html`<p class="note launching-not">${t("launching.not_started", { reason: node.start.text })}</p>`}
    ${node.respawn && html`<span class="launching-tag">${t("launching.respawn")}</span>`}
    ${isOpen.value && html`<dl class="launching-details">${details.map(([term, text], at) => html`<div key=${at}><dt>${term}</dt><dd>${text}</dd></div>`)}</dl>`}</li>`;
}

/**
 * All that a node is given: terms and texts.
 * @param {PlannedNode} node
 * @returns {[string, string][]}
 */
export function detailsOf(node) {
  /** @type {[string, string[]][]} */
  const words = [
    ["launching.words", [...node.arguments, ...node.ros_arguments]],
    ["launching.prefix", node.prefix],
    ["launching.folder", node.cwd ? [node.cwd] : []],
  ];
  return [
    ...node.parameters.map(
      (one) => /** @type {[string, string]} */ ([one.name, parameterText(one)]),
    ),
    ...node.files.map(
      (file) => /** @type {[string, string]} */ ([t("launching.parameter_file"), file]),
    ),
    ...node.remaps.map((one) => /** @type {[string, string]} */ ([one.source, `→ ${one.target}`])),
    ...words
      .filter(([, given]) => given.length > 0)
      .map(([key, given]) => /** @type {[string, string]} */ ([t(key), given.join(" ")])),
    ...Object.entries(node.environment),
  ];
}

const TEXT_MAX = 200;

/** @param {PlannedParameter} one @returns {string} */
export function parameterText({ value, robot, file }) {
  if (robot !== null) return t("launching.robot_text");
  const text = typeof value === "string" ? value : JSON.stringify(value);
  const short = text.length > TEXT_MAX ? `${text.slice(0, TEXT_MAX)}…` : text;
  return file ? `${short} (${baseName(file)})` : short;
}

/** @param {{process: PlannedProcess}} props */
function ProcessRow({ process }) {
  const isOff = process.condition?.holds === false;
  return html`<li class=${`launching-node ${isOff ? "off" : ""}`}><div class="launching-line"><span class="launching-toggle"><${Icon} name="dot" size=${13} /><code>${process.command.join(" ")}</code></span><${LineLink} where=${process.where} /></div>
    <${Reasons} condition=${process.condition} when=${process.when} />
    ${process.start.kind === "none" && process.start.text && !isOff && html`<p class="note launching-not">${t("launching.not_started", { reason: process.start.text })}</p>`}</li>`;
}

/** @param {{plan: Plan}} props what is done later, set and said */
function Later({ plan }) {
  const rows = [
    ...plan.happenings.map((one) => ({
      words: `${one.when}: ${one.does.join("; ")}`,
      where: one.where,
    })),
    ...plan.settings.map((one) => ({
      words:
        one.value === null ? t("launching.unset", { name: one.name }) : `${one.name}=${one.value}`,
      where: one.where,
    })),
    ...plan.log.map((one) => ({ words: `“${one.text}”`, where: one.where })),
  ];
  if (rows.length === 0) return null;
  return html`<section aria-label=${t("launching.later")}><h3>${t("launching.later")}</h3>
    <ul class="launching-rows">${rows.map(({ words, where }, at) => html`<li key=${at}><span>${words}</span><${LineLink} where=${where} /></li>`)}</ul></section>`;
}

/** @param {{plan: Plan}} props */
function Gaps({ plan }) {
  if (plan.unsupported.length === 0) return null;
  return html`<section aria-label=${t("launching.gaps")}><h3>${t("launching.gaps")}</h3>
    <ul class="launching-rows">${plan.unsupported.map(({ name, sentence, where }, at) => html`<li key=${at}><span><code>${name}</code> ${sentence}</span><${LineLink} where=${where} /></li>`)}</ul></section>`;
}
