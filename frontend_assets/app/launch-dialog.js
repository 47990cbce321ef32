/** The arguments of a robot as a form: before it opens, when it lacks one, and at any time after. */

/** @import { ArgumentView, Arguments, SiteView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { isChanged } from "../lib/sites.js";
import { Dialog, EmptyState, Icon, IconButton, ProgressBar, Switch } from "../lib/ui.js";
import {
  allSites,
  documentProblems,
  documentState,
  showingLastGood,
  sitesRevision,
} from "../model/document.js";
import { ask, openPath, resetSite } from "../model/requests.js";
import { RefusedError, send } from "../model/wire.js";

/** What is to be passed, by name; null: nothing, the default counts. @typedef {ReadonlyMap<string, string | null>} Values */
/** @typedef {(value: string | null) => void} Write */
/**
 * @typedef {object} Draft
 * @property {Signal<Values>} values
 * @property {Signal<ReadonlySet<string>>} restored names of those whose default goes back to what is saved
 */

const OTHER = "\u0000other";

/** @param {{path: string, onClose: () => void}} props empty path: the open document */
export function LaunchDialog({ path, onClose }) {
  const form = useSignal(/** @type {Arguments | null} */ (null));
  const values = useSignal(/** @type {Values} */ (new Map()));
  const restored = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
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
    const done = await (path
      ? openWith(path, values.value)
      : apply(values.value, editedOf(form.value, restored.value), error));
    busy.value = false;
    if (done) return onClose();
    if (!path) await load();
    requestAnimationFrame(() => firstWrong(rows.current)?.focus());
    return undefined;
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
      const empty = firstLacking(rows.current);
      if (empty) empty.focus();
      else run();
    }}>
      <${Rows} form=${form.value} error=${error.value} draft=${{ values, restored }} />
      <button type="submit" class="hidden-words" tabindex="-1" aria-hidden="true"></button>
    </form>
    <footer>
      <button type="button" class="button" disabled=${!resettable(form.value, values.value, restored.value)} onClick=${() => {
        values.value = new Map((form.value?.arguments ?? []).map((one) => [one.name, null]));
        restored.value = new Set((form.value?.arguments ?? []).map(({ name: one }) => one));
      }}>${t("launch.reset")}</button>
      <span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" disabled=${busy.value || !form.value || (!path && values.value.size + restored.value.size === 0)} onClick=${run}>
        ${path ? t("open.here") : t("launch.apply")}</button>
    </footer>
  <//>`;
}

/** @param {HTMLElement | null} rows @returns {HTMLElement | null | undefined} what lacks a value or is wrong, else the first */
function firstToFill(rows) {
  return firstWrong(rows) ?? rows?.querySelector("input, select, button");
}

/** @param {HTMLElement | null} rows @returns {HTMLElement | null | undefined} */
function firstWrong(rows) {
  return rows?.querySelector("[aria-invalid=true]");
}

/** @param {HTMLElement | null} rows @returns {HTMLElement | null | undefined} */
function firstLacking(rows) {
  return rows?.querySelector("[data-lacking]");
}

/** @param {ArgumentView} one @returns {SiteView | undefined} its default, while the file on disk says another */
function editedDefault({ name, file, line }) {
  sitesRevision.value;
  return [...allSites().values()].find(
    (site) =>
      site.kind === "arg" &&
      site.name === name &&
      site.file === file &&
      site.line === line &&
      isChanged(site),
  );
}

/** @param {ArgumentView} one @returns {ArgumentView} as it will be once its default is that of the file on disk */
function asSaved(one) {
  const saved = editedDefault(one)?.saved_text ?? one.default;
  return { ...one, default: saved, shown: saved ?? "" };
}

/** @param {Arguments | null} form @param {ReadonlySet<string>} names @returns {string[]} ids of their edited defaults */
function editedOf(form, names) {
  const those = (form?.arguments ?? []).filter(({ name }) => names.has(name));
  return those.flatMap((one) => editedDefault(one)?.id ?? []);
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
 * @param {Values} values @param {readonly string[]} edited ids of the defaults that go back to what is saved
 * @param {Signal<string>} error @returns {Promise<boolean>}
 */
async function apply(values, edited, error) {
  for (const id of edited) if (!(await resetSite(id))) return false;
  const given = Object.fromEntries(values);
  if (values.size > 0 && !(await ask({ type: "set_arguments", values: given }))) return false;
  const failed = showingLastGood.value || documentState.value?.phase === "failed";
  const worst = documentProblems.value.find(({ severity }) => severity === "error");
  // What it still needs stands above the rows, and its field has the focus.
  const isKnown = worst?.fix?.action === "give_arguments";
  error.value = failed && worst && !isKnown ? worst.sentence : "";
  return !failed;
}

/** @param {Arguments | null} form @param {Values} values @param {ReadonlySet<string>} restored @returns {boolean} */
function resettable(form, values, restored) {
  return (form?.arguments ?? []).some((one) => isSet(one, values, restored));
}

/** @param {ArgumentView} one @param {Values} values @param {ReadonlySet<string>} restored @returns {boolean} something counts that the saved file does not say */
function isSet(one, values, restored) {
  return (
    passed(one, values) !== null || (!restored.has(one.name) && editedDefault(one) !== undefined)
  );
}

/** @param {string} sentence what went wrong @param {ArgumentView} one @param {string | null} value @returns {boolean} it speaks of this argument */
function isBlamed(sentence, one, value) {
  if (sentence === "" || !value) return false;
  const words = sentence.split(/[^\p{L}\p{N}_./:-]+/u).map((word) => word.replace(/[.:]+$/, ""));
  return words.includes(value) || words.includes(one.name);
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

/** @param {{form: Arguments | null, error: string, draft: Draft}} props */
function Rows({ form, error, draft: { values, restored } }) {
  if (!form)
    return error ? null : html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (form.arguments.length === 0)
    return html`<${EmptyState} icon="arguments" title=${t("launch.none")} />`;
  return form.arguments.map((one) => {
    /** @param {string | null} value */
    const write = (value) => {
      const now = new Map(values.value);
      if (value === one.value) now.delete(one.name);
      else now.set(one.name, value);
      values.value = now;
    };
    const reset = () => {
      write(null);
      if (editedDefault(one)) restored.value = new Set([...restored.value, one.name]);
    };
    const value = passed(one, values.value);
    return html`<${Row} key=${one.name} one=${restored.value.has(one.name) ? asSaved(one) : one} value=${value} isSet=${isSet(one, values.value, restored.value)}
      needed=${form.missing.includes(one.name)} blamed=${isBlamed(error, one, value)} write=${write} reset=${reset} />`;
  });
}

/** @param {{one: ArgumentView, value: string | null, isSet: boolean, needed: boolean, blamed: boolean, write: Write, reset: () => void}} props */
function Row({ one, value, isSet: marked, needed, blamed, write, reset }) {
  const { widget } = one;
  const lacking = needed && !value;
  return html`<div class=${`launch-row ${marked ? "set" : ""} ${blamed ? "blamed" : ""}`} role="group" aria-label=${one.name}>
    <div class="launch-name"><span>${one.name}</span>
      ${widget.help && html`<small>${widget.help}</small>`}</div>
    <div class="launch-value">
      <${Editor} one=${one} value=${value} lacking=${lacking} wrong=${lacking || blamed} write=${write} />
      ${widget.unit && html`<span class="unit">${widget.unit}</span>`}
    </div>
    <${IconButton} icon="reset" label=${t("launch.reset_one", { name: one.name })} disabled=${!marked} onClick=${reset} />
    <${Default} one=${one} value=${value} />
  </div>`;
}

/** @param {{one: ArgumentView, value: string | null}} props what counts without a value, and what it comes to */
function Default({ one, value }) {
  if (one.default === null)
    return value ? null : html`<p class="launch-default">${t("launch.required")}</p>`;
  const computed = one.default.includes("$");
  if (value === null && !computed) return null;
  const text = one.default === "" ? t("launch.empty") : one.default;
  return html`<p class="launch-default" title=${computed ? one.shown : text}>${t("launch.default")} <code>${text}</code></p>`;
}

/** @typedef {{one: ArgumentView, value: string | null, lacking: boolean, wrong: boolean, write: Write}} EditorProps */

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
  const { one, value, lacking, wrong, write } = props;
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
  return html`<select class="box choice" aria-label=${one.name} aria-invalid=${wrong} data-lacking=${lacking || undefined} value=${text} onChange=${choose}>
    ${all.map((choice) => html`<option key=${choice} value=${choice}>${choice || t("launch.empty")}</option>`)}
    <option value=${OTHER}>${t("launch.other")}</option>
  </select>`;
}

/** @param {EditorProps & {first?: boolean}} props */
function Words({ one, value, lacking, wrong, write, first = false }) {
  const placeholder = one.default === null ? "" : one.shown || one.default;
  return html`<input type="text" class=${`box wide ${one.is_file ? "file" : ""}`} aria-label=${one.name} aria-invalid=${wrong}
    data-lacking=${lacking || undefined} data-first=${first || undefined} spellcheck=${false} placeholder=${placeholder} value=${value ?? ""} title=${value ?? one.shown}
    onInput=${(/** @type {any} */ event) => {
      const typed = event.currentTarget.value;
      write(typed === "" && one.value === null ? null : typed);
    }} />`;
}
