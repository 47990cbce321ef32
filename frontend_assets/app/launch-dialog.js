/** The arguments of a robot as a form: before it opens, when it lacks one, and at any time after. */

/** @import { Arguments, ArgumentView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { Dialog, EmptyState, Icon, IconButton, ProgressBar, Switch } from "../lib/ui.js";
import { ask, openPath } from "./actions.js";
import { role } from "./state/connection.js";
import { documentState, problems, showingLastGood } from "./state/document.js";
import { dialog } from "./state/view.js";
import { RefusedError, send } from "./wire.js";

/** What is to be passed, by name; null: nothing, the default counts. @typedef {ReadonlyMap<string, string | null>} Values */
/** @typedef {(value: string | null) => void} Write */

const OTHER = "\u0000other";

/** Show the form by itself when the robot that was opened cannot be without a value. */
export function followMissing() {
  let asked = "";
  effect(() => {
    const state = documentState.value;
    const lacking = problems.value.find(({ fix }) => fix?.action === "give_arguments");
    const what = lacking && state ? `${state.id} ${lacking.sentence}` : "";
    if (what === "" || what === asked || role.value !== "presenter") return;
    asked = what;
    if (dialog.peek() === null) dialog.value = { kind: "launch", path: "" };
  });
}

/** @param {{path: string, onClose: () => void}} props empty path: the open document */
export function LaunchDialog({ path, onClose }) {
  const form = useSignal(/** @type {Arguments | null} */ (null));
  const values = useSignal(/** @type {Values} */ (new Map()));
  const error = useSignal("");
  const busy = useSignal(false);
  const load = async () => {
    try {
      const answer = await send({ type: "get_arguments", path });
      if (answer.type !== "arguments") return;
      form.value = answer;
      values.value = new Map([...offered(answer), ...values.value]);
    } catch (refusal) {
      error.value = refusal instanceof RefusedError ? refusal.message : t("connection.lost");
    }
  };
  useEffect(() => void load(), []);
  const run = async () => {
    busy.value = true;
    error.value = "";
    const done = await (path ? openWith(path, values.value) : apply(values.value, error));
    busy.value = false;
    if (done) onClose();
    else if (!path) await load();
  };
  const name = baseName(path || (documentState.value?.path ?? ""));
  const rows = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => {
    if (form.value) firstToFill(rows.current)?.focus();
  }, [form.value !== null]);
  return html`<${Dialog} title=${t("launch.title", { name })} closeLabel=${t("close")} class="launch" onClose=${onClose}>
    <${Needed} form=${form.value} values=${values.value} />
    ${error.value && html`<p class="note bad" role="alert">${error.value}</p>`}
    <form ref=${rows} class="launch-rows" onSubmit=${(/** @type {Event} */ event) => {
      event.preventDefault();
      run();
    }}>
      <${Rows} form=${form.value} failed=${error.value !== ""} values=${values} />
      <button type="submit" class="hidden-words" tabindex="-1" aria-hidden="true"></button>
    </form>
    <footer>
      <button type="button" class="button" disabled=${!resettable(form.value, values.value)} onClick=${() => {
        values.value = new Map((form.value?.arguments ?? []).map((one) => [one.name, null]));
      }}>${t("launch.reset")}</button>
      <span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" disabled=${busy.value || !form.value || (!path && values.value.size === 0)} onClick=${run}>
        ${path ? t("open.here") : t("launch.apply")}</button>
    </footer>
  <//>`;
}

/** @param {HTMLElement | null} rows @returns {HTMLElement | null | undefined} what lacks a value, else the first */
function firstToFill(rows) {
  return rows?.querySelector("[aria-invalid=true]") ?? rows?.querySelector("input, select, button");
}

/**
 * @param {Arguments} form
 * @returns {[string, string][]} what the file itself would say for the missing ones, had it said it in time
 */
function offered(form) {
  return form.arguments
    .filter(({ name, shown }) => form.missing.includes(name) && shown !== "")
    .map(({ name, shown }) => [name, shown]);
}

/** @param {string} path @param {Values} values @returns {Promise<boolean>} */
function openWith(path, values) {
  const given = [...values].filter(([, value]) => value !== null);
  return openPath(path, Object.fromEntries(/** @type {[string, string][]} */ (given)));
}

/**
 * Pass all at once: one run, one step to undo. Values that break the robot keep the form open.
 *
 * @param {Values} values @param {Signal<string>} error @returns {Promise<boolean>}
 */
async function apply(values, error) {
  if (!(await ask({ type: "set_arguments", values: Object.fromEntries(values) }))) return false;
  const failed = showingLastGood.value || documentState.value?.phase === "failed";
  const worst = problems.value.find(({ severity }) => severity === "error");
  error.value = failed && worst ? worst.sentence : "";
  return !failed;
}

/** @param {Arguments | null} form @param {Values} values @returns {boolean} something is passed */
function resettable(form, values) {
  return (form?.arguments ?? []).some((one) => passed(one, values) !== null);
}

/** @param {ArgumentView} one @param {Values} values @returns {string | null} */
function passed(one, values) {
  return values.has(one.name) ? (values.get(one.name) ?? null) : one.value;
}

/** @param {{form: Arguments | null, values: Values}} props */
function Needed({ form, values }) {
  const missing = (form?.missing ?? []).filter((name) => !values.get(name));
  if (missing.length === 0) return null;
  return html`<p class="launch-needed" role="status"><${Icon} name="info" />${t("launch.needed", { names: missing.join(", ") })}</p>`;
}

/** @param {{form: Arguments | null, failed: boolean, values: Signal<Values>}} props */
function Rows({ form, failed, values }) {
  if (!form)
    return failed ? null : html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (form.arguments.length === 0)
    return html`<${EmptyState} icon="properties" title=${t("launch.none")} />`;
  return form.arguments.map((one) => {
    /** @param {string | null} value */
    const write = (value) => {
      const now = new Map(values.value);
      if (value === one.value) now.delete(one.name);
      else now.set(one.name, value);
      values.value = now;
    };
    return html`<${Row} key=${one.name} one=${one} value=${passed(one, values.value)}
      needed=${form.missing.includes(one.name)} write=${write} />`;
  });
}

/** @param {{one: ArgumentView, value: string | null, needed: boolean, write: Write}} props */
function Row({ one, value, needed, write }) {
  const { widget } = one;
  const lacking = needed && !value;
  return html`<div class=${`launch-row ${value !== null ? "set" : ""}`} role="group" aria-label=${one.name}>
    <div class="launch-name"><span>${one.name}</span>
      ${widget.help && html`<small>${widget.help}</small>`}</div>
    <div class="launch-value">
      <${Editor} one=${one} value=${value} lacking=${lacking} write=${write} />
      ${widget.unit && html`<span class="unit">${widget.unit}</span>`}
    </div>
    <${IconButton} icon="reset" label=${t("launch.reset_one", { name: one.name })} disabled=${value === null} onClick=${() => write(null)} />
    <${Default} one=${one} value=${value} />
  </div>`;
}

/** @param {{one: ArgumentView, value: string | null}} props what counts without a value, and what it comes to */
function Default({ one, value }) {
  if (one.default === null) return html`<p class="launch-default">${t("launch.required")}</p>`;
  const computed = one.default.includes("$");
  if (value === null && !computed) return null;
  const text = one.default === "" ? t("launch.empty") : one.default;
  return html`<p class="launch-default" title=${computed ? one.shown : ""}>${t("launch.default")} <code>${text}</code></p>`;
}

/** @typedef {{one: ArgumentView, value: string | null, lacking: boolean, write: Write}} EditorProps */

/** @param {EditorProps} props */
function Editor(props) {
  const { kind, choices } = props.one.widget;
  const text = props.value ?? props.one.shown;
  if (kind === "switch" && /^(true|false|0|1|)$/i.test(text)) return html`<${Flag} ...${props} />`;
  return choices.length > 0 ? html`<${Choice} ...${props} />` : html`<${Words} ...${props} />`;
}

/** @param {EditorProps} props */
function Flag({ one, value, write }) {
  const on = /^(true|1)$/i.test(value ?? one.shown);
  return html`<${Switch} label=${one.name} checked=${on} onChange=${(/** @type {boolean} */ next) => write(String(next))} />`;
}

/** @param {EditorProps} props */
function Choice(props) {
  const { one, value, lacking, write } = props;
  const other = useSignal(false);
  const text = value ?? one.shown;
  if (other.value) return html`<${Words} ...${props} first />`;
  const all = one.widget.choices.includes(text)
    ? one.widget.choices
    : [text, ...one.widget.choices];
  /** @param {any} event */
  const choose = ({ currentTarget: { value: chosen } }) => {
    if (chosen === OTHER) other.value = true;
    else write(chosen);
  };
  return html`<select class="box choice" aria-label=${one.name} aria-invalid=${lacking} value=${text} onChange=${choose}>
    ${all.map((choice) => html`<option key=${choice} value=${choice}>${choice || t("launch.empty")}</option>`)}
    <option value=${OTHER}>${t("launch.other")}</option>
  </select>`;
}

/** @param {EditorProps & {first?: boolean}} props */
function Words({ one, value, lacking, write, first = false }) {
  const placeholder = one.default === null ? "" : one.shown || one.default;
  return html`<input type="text" class=${`box wide ${one.is_file ? "file" : ""}`} aria-label=${one.name} aria-invalid=${lacking}
    data-first=${first || undefined} spellcheck=${false} placeholder=${placeholder} value=${value ?? ""} title=${value ?? one.shown}
    onInput=${(/** @type {any} */ event) => {
      const typed = event.currentTarget.value;
      write(typed === "" && one.value === null ? null : typed);
    }} />`;
}
