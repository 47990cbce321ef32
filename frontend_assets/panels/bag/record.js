/** Recording by the words of `ros2 bag record`: the form, how it goes, and the last minutes saved. */

/** @import { RecordedCount, RecordingState } from "../../types/wire.d.ts" */
/** @import { RecordForm } from "../../model/recording.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { language, t } from "../../lib/i18n.js";
import { parseNumber } from "../../lib/numbers.js";
import { baseName } from "../../lib/paths.js";
import { sinceStart, sizeWords } from "../../lib/timeline.js";
import { Icon, ProgressBar, SearchBox, useBusy } from "../../lib/ui.js";
import { mayManage } from "../../model/connection.js";
import {
  changeForm,
  formFault,
  isRecording,
  openRecorded,
  recordedRate,
  recordForm,
  recording,
  recordTrouble,
  savePast,
  startRecording,
  stopRecording,
  stopWriting,
  writtenShare,
} from "../../model/recording.js";
import { timeState } from "../../model/time.js";
import { isNoise, topics } from "../../model/topics.js";
import { ConnectFirst, isWireAway } from "../parts.js";

export function RecordPart() {
  const state = recording.value;
  const part = useRef(/** @type {HTMLElement | null} */ (null));
  // What has begun, or ended, stands above the form whose button was pressed.
  useEffect(() => part.current?.scrollTo(0, 0), [isRecording.value]);
  if (isWireAway() && !isRecording.value)
    return html`<div class="scroll"><${ConnectFirst} icon="bag" /></div>`;
  return html`<div class="scroll bag-record" ref=${part}>
    ${state && (state.recording || state.path) && html`<${Running} state=${state} />`}
    ${isRecording.value ? html`<${Trouble} />` : html`<${Form} />`}
    <${SavePast} />
  </div>`;
}

/** Why what was asked was not done. */
function Trouble() {
  if (!recordTrouble.value) return null;
  return html`<p class="note bad" role="alert"><${Icon} name="error" size=${13} />${recordTrouble.value}</p>`;
}

const PASTS_S = [30, 120, 300];

/** How far a part is written into a bag. */
export function Writing() {
  const share = writtenShare.value;
  if (share === null) return null;
  const done = Math.round(share * 100);
  const words = t("bag.writing", { share: done });
  return html`<div class="bag-writing" role="status"><span>${words}</span><${ProgressBar} label=${words} done=${done} total=${100} />
    ${mayManage.value && html`<button type="button" class="button small" onClick=${stopWriting}>${t("bag.writing.stop")}</button>`}</div>`;
}

/** What has just happened, as a bag. */
export function SavePast() {
  const { busy, during } = useBusy();
  const state = timeState.value;
  if (isWireAway() || !state || state.mode === "bag") return null;
  const words = (/** @type {number} */ seconds) =>
    seconds < 60
      ? t("bag.past.seconds", { count: seconds })
      : t("bag.past.minutes", { count: seconds / 60 });
  return html`<section class="bag-past"><h3>${t("bag.past")}</h3>
    <p class="bag-past-buttons">${PASTS_S.map(
      (
        one,
      ) => html`<button key=${one} type="button" class="button small" disabled=${busy || !mayManage.value} title=${whoMay()} onClick=${during(() => savePast(one))}>
        <${Icon} name="disk" size=${14} />${words(one)}</button>`,
    )}</p></section>`;
}

/** @returns {string | null} why somebody else has to press it */
const whoMay = () => (mayManage.value ? null : t("bag.viewer"));

/** @param {{state: RecordingState}} props */
function Running({ state }) {
  const { busy, during } = useBusy();
  const { recording: runs, path, seconds, messages: count, lost, bytes, free_bytes: free } = state;
  const rate = runs && recordedRate.value > 0 ? ` · ${sizeWords(recordedRate.value)}/s` : "";
  return html`<section class=${`bag-state ${runs ? "running" : ""}`} aria-label=${t(runs ? "bag.running" : "bag.last")}>
    <header><span class="bag-light" aria-hidden="true"></span><h3>${t(runs ? "bag.running" : "bag.last")}</h3>
      <span class="bag-file" title=${path}>${baseName(path)}</span>
      ${runs && html`<button type="button" class="button small danger" disabled=${busy || !mayManage.value} title=${whoMay()} onClick=${during(stopRecording)}><${Icon} name="stop" size=${13} />${t("bag.stop")}</button>`}
      ${!runs && mayManage.value && html`<button type="button" class="button small" disabled=${busy} onClick=${during(() => openRecorded(path))}><${Icon} name="open" size=${13} />${t("bag.open")}</button>`}
    </header>
    <p class="bag-figures numbers"><b>${sinceStart(seconds)}</b><span>${sizeWords(bytes)}${rate}</span>
      <span>${t("bag.messages.count", { count: count.toLocaleString(language.value) })}</span>
      ${lost > 0 && html`<span class="bag-lost">${t("bag.lost", { count: lost.toLocaleString(language.value) })}</span>`}
      ${runs && html`<span class="muted">${t("bag.free", { size: sizeWords(free) })}</span>`}</p>
    ${state.trouble && html`<p class="note bad" role="alert"><${Icon} name="error" size=${13} />${state.trouble}</p>`}
    <${Counts} of=${state.topics} />
  </section>`;
}

/** @param {{of: readonly RecordedCount[]}} props those of which something is lost come first */
function Counts({ of }) {
  if (of.length === 0) return null;
  const sorted = of.toSorted((a, b) => b.lost - a.lost || a.name.localeCompare(b.name));
  return html`<ul class="bag-counts">${sorted.map(
    ({
      name,
      count,
      lost,
    }) => html`<li key=${name} title=${name}><span class="bag-count-name">${name}</span>
      ${lost > 0 && html`<span class="bag-lost">${t("bag.lost", { count: lost })}</span>`}<span class="numbers">${count.toLocaleString(language.value)}</span></li>`,
  )}</ul>`;
}

/** @type {RecordForm["which"][]} */
const WHICH = ["all", "topics", "regex"];
const EXAMPLES = { regex: "/arm/.*|/tf", exclude: ".*/image_raw" };

function Form() {
  const form = recordForm.value;
  const { busy, during } = useBusy();
  const fault = formFault(form);
  const start = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (!fault && mayManage.value) void during(startRecording)();
  };
  return html`<form class="bag-form" onSubmit=${start} aria-label=${t("bag.part.record")}>
    <fieldset class="bag-which"><legend>${t("bag.which")}</legend>
      <div class="bag-radios">${WHICH.map(
        (one) =>
          html`<label key=${one}><input type="radio" name="bag-which" value=${one} checked=${form.which === one} onChange=${() => changeForm({ which: one })} />${t(`bag.which.${one}`)}</label>`,
      )}</div>
      ${form.which === "regex" && html`<${Text} name="regex" placeholder=${EXAMPLES.regex} />`}
      ${form.which === "topics" && html`<${TopicChoice} />`}
    </fieldset>
    <${Text} name="exclude" placeholder=${EXAMPLES.exclude} />
    <${Text} name="name" placeholder=${t("bag.name.auto")} invalid=${fault === "bag.fault.name"} />
    <div class="bag-pair"><${Choice} name="storage" of=${["mcap", "sqlite3"]} /><${Choice} name="compression" of=${["none", "zstd", "lz4"]} /></div>
    <div class="bag-pair"><${Figure} name="maxBytes" unit="MB" scale=${1e6} /><${Figure} name="maxSeconds" unit="s" scale=${1} /></div>
    <footer>${fault ? html`<span class="note">${t(fault)}</span>` : html`<${Trouble} />`}<span class="push"></span>
      <button type="submit" class="button primary" disabled=${busy || fault !== "" || !mayManage.value} title=${whoMay()}>
        <span class="bag-light on" aria-hidden="true"></span>${t("bag.start")}</button></footer>
  </form>`;
}

/** @param {{name: "regex" | "exclude" | "name", placeholder: string, invalid?: boolean}} props */
function Text({ name, placeholder, invalid }) {
  return html`<label class="bag-field"><span>${t(`bag.form.${name}`)}</span>
    <input class="box wide" aria-invalid=${invalid ? "true" : null} maxlength=${name === "name" ? 200 : 1000} spellcheck=${false} autocomplete="off" placeholder=${placeholder} value=${recordForm.value[name]}
      onInput=${(/** @type {any} */ event) => changeForm({ [name]: event.currentTarget.value })} /></label>`;
}

/** @param {{name: "storage" | "compression", of: readonly string[]}} props */
function Choice({ name, of }) {
  return html`<label class="bag-field"><span>${t(`bag.form.${name}`)}</span>
    <select class="box" value=${recordForm.value[name]} onChange=${(/** @type {any} */ event) => changeForm({ [name]: event.currentTarget.value })}>
      ${of.map((one) => html`<option key=${one} value=${one}>${t(`bag.form.${one}`)}</option>`)}</select></label>`;
}

/** @param {{name: "maxBytes" | "maxSeconds", unit: string, scale: number}} props another file begins then; empty: never */
function Figure({ name, unit, scale }) {
  const value = recordForm.value[name];
  const write = (/** @type {any} */ event) => {
    const typed = parseNumber(event.currentTarget.value);
    changeForm({ [name]: typed !== null && typed > 0 ? Math.round(typed * scale) : 0 });
  };
  return html`<label class="bag-field"><span>${t(`bag.form.${name}`)}</span>
    <span class="bag-unit"><input class="box number" inputmode="decimal" placeholder=${t("bag.form.never")} value=${value > 0 ? value / scale : ""} onChange=${write} />${unit}</span></label>`;
}

/** The topics that are there, and those of the form that are not there yet. */
function TopicChoice() {
  const words = useSignal("");
  const chosen = recordForm.value.topics;
  const there = (topics.value ?? []).filter(({ name }) => !isNoise(name) || chosen.includes(name));
  const names = [...new Set([...chosen, ...there.map(({ name }) => name)])];
  const wanted = words.value.toLowerCase();
  const shown = names.filter((name) => name.toLowerCase().includes(wanted)).toSorted();
  const typed = words.value.trim();
  const isNew = typed.startsWith("/") && !names.includes(typed);
  const toggle = (/** @type {string} */ name) =>
    changeForm({
      topics: chosen.includes(name) ? chosen.filter((one) => one !== name) : [...chosen, name],
    });
  return html`<div class="bag-choice"><${SearchBox} label=${t("topics.filter")} value=${words.value} onInput=${(
    /** @type {string} */ text,
  ) => {
    words.value = text;
  }} />
    <ul>${shown.map(
      (name) =>
        html`<li key=${name}><label title=${name}><input type="checkbox" checked=${chosen.includes(name)} onChange=${() => toggle(name)} /><span>${name}</span></label></li>`,
    )}
      ${isNew && html`<li><button type="button" class="text-button" onClick=${() => toggle(typed)}>${t("bag.topics.add", { topic: typed })}</button></li>`}
      ${shown.length === 0 && !isNew && html`<li class="note">${t("bag.topics.none_here")}</li>`}</ul></div>`;
}
