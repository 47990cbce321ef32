/** Why something does not work: what the Doctor found, how it knows, and what mends it. */

/** @import { Command, Concern, Finding, SubjectView, SystemExamined, Talk } from "../../types/wire.d.ts" */
/** @import { Asked } from "../../model/wire.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useSignal } from "vendor/preact.js";
import { CodeLine } from "../../app/code-line.js";
import { copyText } from "../../lib/clipboard.js";
import { commandById } from "../../lib/commands.js";
import { saveAsFile } from "../../lib/files.js";
import { language, t } from "../../lib/i18n.js";
import { shortTime } from "../../lib/times.js";
import { EmptyState, Icon, IconButton, ProgressBar, SearchBox } from "../../lib/ui.js";
import { askOrKeepWhy, polled, useLooking } from "../../model/asking.js";
import { mayAct, mayEdit, mayManage } from "../../model/connection.js";
import { showInterface } from "../../model/interfaces.js";
import { chooseNode } from "../../model/parameters.js";
import { ask } from "../../model/requests.js";
import { setTarget } from "../../model/tf.js";
import { chosenTopic } from "../../model/topics.js";
import { dialog, notify, soughtNode } from "../../model/view.js";
import { viewport } from "../../model/viewport.js";

/** @typedef {Finding["level"]} Level */
/** @typedef {{words: string, hidden: ReadonlySet<Level>}} Filter */

/** @type {readonly Level[]} */
const LEVELS = ["error", "warn", "note"];
/** @type {Record<Level, string>} */
const ICONS = { error: "error", warn: "alert", note: "info" };
const STATES = { well: "check", found: "alert", not_examined: "help" };
const ASK_EVERY_MS = 1500;

/** Whether it examines while the panel is seen: it begins with a click, for it listens to all topics. */
const examines = signal(false);
/** @type {Signal<SystemExamined | null>} */
const examined = signal(null);
const refused = signal("");

/** @returns {{renderer: string, draws_by_software: boolean}} what draws the 3D view here */
function thisBrowser() {
  const drawing = viewport.peek()?.graphics();
  return {
    renderer: (drawing?.renderer ?? "").slice(0, 200),
    draws_by_software: drawing?.software ?? false,
  };
}

/** Keep the answer true while somebody looks; gives the end of looking. */
const followDoctor = polled(
  async () => {
    const answer = await askOrKeepWhy({ type: "examine_system", ...thisBrowser() }, refused);
    if (answer?.type === "system_examined") examined.value = answer;
  },
  ASK_EVERY_MS,
  () => examines.value,
);

export function DoctorPanel() {
  const { panel } = useLooking(followDoctor);
  return html`<section ref=${panel} class="panel-body doctor" aria-label=${t("panel.doctor")}>
    ${examines.value || examined.value ? html`<${Content} answer=${examined.value} />` : html`<${Begin} />`}
  </section>`;
}

function Begin() {
  return html`<${EmptyState} icon="doctor" title=${t("doctor.begin.title")}>
    <p>${t("doctor.begin.hint")}</p>
    <button type="button" class="button primary" onClick=${begin}><${Icon} name="search" />${t("doctor.begin")}</button><//>`;
}

function begin() {
  examines.value = true;
}

function end() {
  examines.value = false;
}

/** @param {{answer: SystemExamined | null}} props */
function Content({ answer }) {
  const filter = useSignal(
    /** @type {Filter} */ ({ words: "", hidden: /** @type {ReadonlySet<Level>} */ (new Set()) }),
  );
  if (refused.value) return html`<p class="note bad padded" role="alert">${refused.value}</p>`;
  if (!answer) return html`<${ProgressBar} label=${t("doctor.examining")} done=${0} total=${0} />`;
  const shown = filteredFindings(answer.findings, filter.value);
  return html`<${Bar} answer=${answer} shown=${shown} filter=${filter} />
    <${Progress} answer=${answer} />
    <div class="scroll doctor-list" role="region" tabindex="0" aria-label=${t("panel.doctor")}>
      <${Verdict} answer=${answer} shown=${shown} />
      ${LEVELS.map((level) => html`<${OfLevel} key=${level} level=${level} findings=${shown.filter((one) => one.level === level)} />`)}
      ${answer.more > 0 && html`<p class="note padded">${t("doctor.more", { count: answer.more })}</p>`}
      <${Looked} subjects=${answer.subjects} />
    </div>`;
}

/** @param {{answer: SystemExamined, shown: readonly Finding[], filter: Signal<Filter>}} props */
function Bar({ answer, shown, filter }) {
  const copy = async () => {
    const done = await copyText(asText(shown));
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  return html`<div class="panel-bar row doctor-bar">
    <button type="button" class=${`button small ${examines.value ? "" : "primary"}`} onClick=${examines.value ? end : begin}>
      <${Icon} name=${examines.value ? "pause" : "search"} size=${14} />${t(examines.value ? "doctor.end" : "doctor.begin")}</button>
    <${SearchBox} label=${t("doctor.search")} value=${filter.value.words} onInput=${(
      /** @type {string} */ words,
    ) => {
      filter.value = { ...filter.value, words };
    }} />
    ${LEVELS.map((level) => html`<${LevelChip} key=${level} level=${level} count=${countOf(answer.findings, level)} filter=${filter} />`)}
    <span class="push"></span>
    <${IconButton} icon="copy" label=${t("doctor.copy")} disabled=${shown.length === 0} onClick=${copy} />
    <${IconButton} icon="download" label=${t("doctor.report.save")} onClick=${saveReport} />
  </div>`;
}

/** @param {{level: Level, count: number, filter: Signal<Filter>}} props shows or hides its level */
function LevelChip({ level, count, filter }) {
  if (count === 0) return null;
  const { hidden } = filter.value;
  const toggle = () => {
    const now = new Set(hidden);
    if (!now.delete(level)) now.add(level);
    filter.value = { ...filter.value, hidden: now };
  };
  const label = `${t(`doctor.level.${level}`)}: ${count}`;
  return html`<button type="button" class=${`chip doctor-chip is-${level}`} aria-pressed=${!hidden.has(level)} aria-label=${label}
    title=${t("doctor.hide", { level: t(`doctor.level.${level}`) })} onClick=${toggle}><${Icon} name=${ICONS[level]} size=${13} />${count}</button>`;
}

/** @param {{answer: SystemExamined}} props */
function Progress({ answer }) {
  if (!examines.value) return null;
  if (answer.is_complete)
    return html`<p class="doctor-live muted" role="status"><span class="doctor-pulse" aria-hidden="true"></span>${t("doctor.since", { time: shortTime(answer.listened_s) })}</p>`;
  return html`<${ProgressBar} label=${t("doctor.examining")} done=${Math.min(answer.listened_s, answer.listens_s * 0.95)} total=${answer.listens_s} />`;
}

/** @param {{answer: SystemExamined, shown: readonly Finding[]}} props that all is well, or that the filter hides all */
function Verdict({ answer, shown }) {
  const isWell = answer.findings.every(({ level }) => level === "note");
  if (isWell)
    return html`<p class="doctor-well" role="status"><${Icon} name="check" size=${18} /><span><strong>${t(answer.is_complete ? "doctor.well" : "doctor.well.so_far")}</strong> ${t("doctor.well.hint")}</span></p>`;
  if (shown.length === 0)
    return html`<p class="nothing">${t("doctor.filtered", { count: answer.findings.length })}</p>`;
  return null;
}

/** @param {{level: Level, findings: readonly Finding[]}} props */
function OfLevel({ level, findings }) {
  if (findings.length === 0) return null;
  return html`<section class=${`doctor-level is-${level}`} aria-label=${t(`doctor.level.${level}`)}>
    <h3><${Icon} name=${ICONS[level]} size=${14} />${t(`doctor.level.${level}`)}<span class="muted numbers">${findings.length}</span></h3>
    ${keyed(findings).map(([key, finding]) => html`<${Card} key=${key} finding=${finding} />`)}</section>`;
}

/** @param {{finding: Finding}} props */
function Card({ finding }) {
  const { code, level, sentence, talk } = finding;
  return html`<article class=${`doctor-card is-${level}`} data-code=${code}>
    <h4><${Icon} name=${ICONS[level]} size=${15} /><span>${t(`doctor.code.${code}`)}</span><span class="doctor-subject">${t(`doctor.subject.${finding.subject}`)}</span></h4>
    <p>${sentence}</p>
    ${talk && html`<${Drawing} talk=${talk} />`}
    <${Deeds} finding=${finding} />
    <${Evidence} finding=${finding} />
  </article>`;
}

/** @param {{finding: Finding}} props what mends it, and what shows it */
function Deeds({ finding: { mend, about } }) {
  const places = shownPlaces(about);
  const may = mend && mayCarryOut(mend.command);
  if (!may && places.length === 0) return null;
  return html`<p class="doctor-deeds">
    ${may && html`<button type="button" class="button small primary" onClick=${() => carryOut(mend.command)}><${Icon} name="wand" size=${14} /><span>${mend.label}</span></button>`}
    ${places.map((one) => html`<button key=${`${one.kind} ${one.name}`} type="button" class="button small" onClick=${() => show(one)}><${Icon} name="eye" size=${14} /><span>${showWords(one)}</span></button>`)}</p>`;
}

/** @param {NonNullable<Finding["mend"]>["command"]} command @returns {boolean} whether this person may send it */
function mayCarryOut({ type }) {
  if (type === "connect_wire") return mayManage.value;
  return type === "set_parameter" ? mayAct.value : mayEdit.value;
}

/** @param {{finding: Finding}} props folded: why it matters, what it is concluded from, and a line for a terminal */
function Evidence({ finding: { code, evidence, line } }) {
  const why = whyOf(code);
  if (!why && evidence.length === 0 && !line) return null;
  return html`<details class="doctor-evidence"><summary>${t("doctor.evidence")}</summary>
    ${why && html`<p>${why}</p>`}
    ${evidence.length > 0 && html`<ul>${evidence.map((one, at) => html`<li key=${at}>${one}</li>`)}</ul>`}
    ${line && html`<${CodeLine} code=${line} label=${t("doctor.line")} />`}
  </details>`;
}

/** @param {{talk: Talk}} props boxes and arrows, which wrap where there is no room */
function Drawing({ talk: { sources, name, targets, meets } }) {
  const words = (/** @type {readonly string[]} */ names) => names.join(", ") || t("doctor.nobody");
  const label = t("doctor.talk", { sources: words(sources), name, targets: words(targets) });
  const arrow = html`<${Icon} name=${meets ? "chevronRight" : "close"} size=${14} />`;
  return html`<div class=${`doctor-talk ${meets ? "" : "apart"}`} role="img" aria-label=${label}>
    <${Boxes} names=${sources} /><span class="doctor-arrow">${arrow}</span><span class="doctor-box topic">${name}</span><span class="doctor-arrow">${arrow}</span><${Boxes} names=${targets} /></div>`;
}

/** @param {{names: readonly string[]}} props */
function Boxes({ names }) {
  if (names.length === 0) return html`<span class="doctor-box nobody">${t("doctor.nobody")}</span>`;
  return html`<span class="doctor-boxes">${names.map((name) => html`<span key=${name} class="doctor-box">${name}</span>`)}</span>`;
}

/** @param {{subjects: readonly SubjectView[]}} props so that one trusts that all is well */
function Looked({ subjects }) {
  return html`<details class="doctor-looked" open=${true}><summary>${t("doctor.looked")}</summary>
    <ul>${subjects.map(
      ({ subject, state, count, detail }) => html`<li key=${subject} class=${state}>
        <${Icon} name=${STATES[state]} size=${13} /><span>${t(`doctor.subject.${subject}`)}<span class="hidden-words"> ${t(`doctor.state.${state}`)}</span></span>
        <span class="numbers">${state === "not_examined" ? "–" : count}</span>
        <span class="muted">${state === "not_examined" ? t("doctor.state.not_examined") : detail}</span></li>`,
    )}</ul></details>`;
}

async function saveReport() {
  const inUse = language.value === "de" ? "de" : "en";
  const answer = await ask({ type: "get_doctor_report", language: inUse, ...thisBrowser() });
  if (answer?.type === "doctor_report") saveAsFile("doctor.html", answer.html, "text/html");
}

/** @param {NonNullable<Finding["mend"]>["command"]} command as the studio wrote it */
const carryOut = (command) =>
  void ask(/** @type {Asked<Command>} */ (/** @type {unknown} */ (command)));

/** What shows a thing of each kind. @type {Record<Concern["kind"], (name: string) => void>} */
const SHOWN = {
  node: (name) => {
    soughtNode.value = name;
    commandById("panel.graph")?.run();
  },
  topic: (name) => {
    chosenTopic.value = name;
    commandById("panel.topics")?.run();
  },
  service: () => commandById("panel.services")?.run(),
  action: () => commandById("panel.actions")?.run(),
  frame: (name) => {
    setTarget(name);
    commandById("panel.frames")?.run();
  },
  parameter: (name) => {
    chooseNode(name);
    commandById("panel.parameters")?.run();
  },
  interface: (name) => {
    showInterface(name);
    commandById("panel.interfaces")?.run();
  },
  display: () => commandById("panel.displays")?.run(),
  document: () => commandById("panel.problems")?.run(),
  connection: () => {
    dialog.value = { kind: "ros" };
  },
  graphics: () => {
    dialog.value = { kind: "graphics" };
  },
};
/** Kinds of which there is one place for all. @type {readonly Concern["kind"][]} */
const WHOLE = ["display", "document", "connection", "graphics"];

/** @param {Concern} place */
const show = ({ kind, name }) => SHOWN[kind](name);

/** @param {Concern} place @returns {string} */
function showWords({ kind, name }) {
  if (kind === "display") return t("doctor.show.displays");
  if (kind === "document") return t("doctor.show.document");
  if (kind === "connection") return t("doctor.show.connection");
  if (kind === "graphics") return t("doctor.show.graphics");
  if (kind === "parameter") return t("doctor.show.parameters", { name });
  return t("doctor.show", { name });
}

/** @param {readonly Concern[]} about @returns {Concern[]} each place once */
export function shownPlaces(about) {
  /** @type {Map<string, Concern>} */
  const places = new Map();
  for (const one of about)
    places.set(`${one.kind} ${WHOLE.includes(one.kind) ? "" : one.name}`, one);
  return [...places.values()];
}

/** @param {string} code @returns {string} why it matters; empty when nothing is written about it */
function whyOf(code) {
  const key = `doctor.why.${code}`;
  const text = t(key);
  return text === key ? "" : text;
}

/** @param {readonly Finding[]} findings @param {Level} level @returns {number} */
export const countOf = (findings, level) => findings.filter((one) => one.level === level).length;

/** @param {readonly Finding[]} findings @param {Filter} filter each of its words occurs somewhere in a finding @returns {Finding[]} */
export function filteredFindings(findings, { words, hidden }) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return findings.filter((one) => {
    if (hidden.has(one.level)) return false;
    const title = t(`doctor.code.${one.code}`);
    const text = [title, one.code, one.subject, one.sentence, ...one.evidence].join(" ");
    return wanted.every((word) => text.toLowerCase().includes(word));
  });
}

/** @param {readonly Finding[]} findings @returns {string} a paragraph for each, to be pasted into a message */
export const asText = (findings) =>
  findings
    .map(({ level, code, sentence, evidence, line }) =>
      [
        `${t(`doctor.level.${level}`)}: ${sentence} [${code}]`,
        ...evidence.map((one) => `  ${one}`),
        ...(line ? [`  $ ${line}`] : []),
      ].join("\n"),
    )
    .join("\n\n");

/** @param {readonly Finding[]} findings @returns {[string, Finding][]} each with a key that stays when others come and go */
export function keyed(findings) {
  /** @type {Map<string, number>} */
  const seen = new Map();
  return findings.map((finding) => {
    // Numbers in a sentence change from answer to answer, and what was unfolded stays so.
    const own = `${finding.code} ${finding.about.map(({ kind, name }) => `${kind}:${name}`).join(" ")}`;
    const number = (seen.get(own) ?? 0) + 1;
    seen.set(own, number);
    return [`${own}#${number}`, finding];
  });
}
