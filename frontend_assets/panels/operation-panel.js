/** What panels that do something in ROS 2 are made of: a list to choose from, a form, what became of it. */

/** @import { ComponentChildren } from "vendor/preact.js" */
/** @import { FieldView, MessageView, OfferView } from "../types/wire.d.ts" */
/** @import { PastedLine } from "../lib/ros2-lines.js" */
/** @import { FormMessage, FormValue, MessageForm, Types } from "../model/message-forms.js" */

import { html, useEffect, useId, useRef, useSignal } from "vendor/preact.js";
import { mendedLine } from "../lib/course-lines.js";
import { t } from "../lib/i18n.js";
import { shownNumber } from "../lib/numbers.js";
import { readLine } from "../lib/ros2-lines.js";
import { useSeen } from "../lib/seen.js";
import { Icon, IconButton, SearchBox } from "../lib/ui.js";
import { mayAct } from "../model/connection.js";
import {
  blank,
  boundsOf,
  choicesOf,
  countOf,
  isFlatList,
  isNested,
  isNumber,
  one,
  troubleOf,
  typeText,
  WORDS,
} from "../model/message-forms.js";
import { matchingOffers } from "../model/operations.js";
import { notify } from "../model/view.js";
import { ConnectFirst, isWireAway, NothingThere, PastNote, Refusal, RouterAway } from "./parts.js";

/** @type {Record<string, string>} */
const ICONS = { bad: "error", cancelled: "stop", canceled: "stop", stopped: "stop" };

/**
 * @typedef {object} OperationPanelProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {PastedLine["kind"]} kind of command lines that it takes
 * @property {(() => () => void)[]} follow what it needs while it is looked at
 * @property {(line: PastedLine) => void} onLine
 * @property {(paste: (text: string) => boolean) => ComponentChildren} children
 */

/** @param {MessageForm} form @returns {(line: PastedLine) => void} takes a command line into a form */
export const openLine =
  (form) =>
  ({ name, type, text }) =>
    void form.open({ name: name.startsWith("/") ? name : `/${name}`, type }, text);

/** @param {OperationPanelProps} props the panel itself: a command line may be pasted anywhere into it */
export function OperationPanel({ id, icon, kind, follow, onLine, children }) {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (is) => {
    seen.value = is;
  });
  const looking = seen.value;
  useEffect(() => {
    const ends = looking ? follow.map((begin) => begin()) : [];
    return () => {
      for (const end of ends) end();
    };
  }, [looking]);
  const take = (/** @type {string} */ text) => {
    const mended = mendedLine(text);
    const line = readLine(mended ?? text);
    if (line?.kind !== kind) return false;
    onLine(line);
    if (mended) notify(t("line.mended", { line: mended }), { long: true });
    return true;
  };
  const onPaste = (/** @type {ClipboardEvent} */ event) => {
    if (mayAct.value && take(event.clipboardData?.getData("text/plain") ?? ""))
      event.preventDefault();
  };
  return html`<section ref=${panel} class="panel-body operations" aria-label=${t(`panel.${id}`)} onPaste=${onPaste}>
    <${RouterAway} />
    ${!mayAct.value && html`<p class="note panel-said">${t("operations.viewer")}</p>`}
    <${PastNote} />
    ${isWireAway() ? html`<${ConnectFirst} icon=${icon} />` : children(take)}
  </section>`;
}

/**
 * @typedef {object} OffersProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {readonly OfferView[] | null} offers null: not known yet
 * @property {string} refused why they are not told
 * @property {() => void} again
 * @property {MessageForm} form
 * @property {(text: string) => boolean} paste takes a command line
 * @property {boolean} [noisy] there are some that every node has
 * @property {ComponentChildren} [next] what to do where there is nothing at all
 * @property {ComponentChildren} [children] what stands below the list
 */

/** @param {OffersProps} props */
export function Offers({
  id,
  icon,
  offers,
  refused,
  again,
  form,
  paste,
  noisy = false,
  next,
  children,
}) {
  const filter = useSignal("");
  const all = useSignal(false);
  const onInput = (/** @type {string} */ text) => {
    filter.value = mayAct.value && paste(text) ? "" : text;
  };
  const toggle = () => {
    all.value = !all.value;
  };
  const shown = matchingOffers(offers ?? [], filter.value, all.value);
  return html`<div class="operations-list">
    <div class="panel-bar"><${SearchBox} label=${t(`${id}.filter`)} value=${filter.value} onInput=${onInput} />
      ${noisy && html`<${IconButton} icon=${all.value ? "eye" : "eyeOff"} label=${t(`${id}.all`)} pressed=${all.value} onClick=${toggle} />`}</div>
    ${refused && html`<${Refusal} sentence=${refused} again=${again} />`}
    ${
      offers &&
      shown.length === 0 &&
      html`<${NothingThere} icon=${icon} title=${whyNothing(id, offers.length, filter.value)}>
      ${offers.length === 0 && next}
      ${offers.length > 0 && filter.value === "" && html`<button type="button" class="button" onClick=${toggle}>${t(`${id}.all`)}</button>`}<//>`
    }
    ${shown.length > 0 && html`<ul class="scroll offers" aria-label=${t(`panel.${id}`)}>${shown.map((one) => html`<${OfferRow} key=${one.name} offer=${one} form=${form} />`)}</ul>`}
    ${children}
  </div>`;
}

/** @param {string} id of the panel @param {number} count of all offers @param {string} filter @returns {string} why none of them is shown */
function whyNothing(id, count, filter) {
  if (count === 0) return t(`${id}.none`);
  return filter === "" ? t("operations.only_noise", { count }) : t("operations.filtered");
}

/** @param {{offer: OfferView, form: MessageForm}} props */
function OfferRow({ offer: { name, types, nodes }, form }) {
  const type = types[0] ?? "";
  const isChosen = form.chosen.value?.name === name;
  return html`<li><button type="button" class="offer" aria-pressed=${isChosen} title=${[name, ...types, ...nodes].join("\n")}
    onClick=${() => isChosen || form.open({ name, type })}>
    <span class="offer-name">${name}</span><span class="offer-type">${types.join(", ")}</span><span class="offer-node">${nodes.join(", ")}</span></button></li>`;
}

/** @param {{form: MessageForm, onSubmit: () => void, actions: ComponentChildren, children?: ComponentChildren}} props what is chosen, its form, and what can be done with it */
export function OperationForm({ form, onSubmit, actions, children }) {
  const { name = "", type = "" } = form.chosen.value ?? {};
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (mayAct.value && !form.wrong.value) onSubmit();
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) submit(event);
  };
  return html`<form class="operation-form" aria-label=${name} onSubmit=${submit} onKeyDown=${onKeyDown} novalidate>
    <header class="operation-head"><${IconButton} icon="chevronRight" class="operation-back" label=${t("operations.back")} onClick=${form.close} />
      <h3 title=${name}>${name}</h3><span class="offer-type" title=${type}>${type}</span></header>
    <${FormOfMessage} form=${form} disabled=${!mayAct.value} />
    <div class="operation-actions">${actions}</div>
    ${children}
  </form>`;
}

/** @param {{state: string, busy: boolean, bad: boolean, words: string}} props how an operation stands */
export function OperationState({ state, busy, bad, words }) {
  const isGivenUp = ICONS[state] === "stop";
  const icon = ICONS[bad ? "bad" : state] ?? "check";
  return html`<span class=${`operation-state ${bad ? "bad" : ""} ${isGivenUp ? "given-up" : ""}`} role="status">${busy ? html`<span class="spinner"></span>` : html`<${Icon} name=${icon} size=${13} />`}<span>${words}</span></span>`;
}

/** Lists and messages with more are folded at first. */
const OPEN_MAX = 12;
const SHOWN_MAX = 500;

/**
 * Plain values as a tree that folds: a reply, a result, feedback.
 *
 * @param {{value: unknown, label: string}} props
 */
export function ValueTree({ value, label }) {
  const entries = entriesOf(value);
  if (entries.length === 0) return html`<p class="note">${t("form.empty")}</p>`;
  return html`<dl class="value-tree" aria-label=${label}>${entries.map(([name, inner]) => html`<${Entry} key=${name} name=${name} value=${inner} />`)}</dl>`;
}

/** @param {{name: string, value: unknown}} props */
function Entry({ name, value }) {
  if (typeof value !== "object" || value === null)
    return html`<div class="value-row"><dt>${name}</dt><dd title=${wholeText(value)}>${textOf(value)}</dd></div>`;
  const entries = entriesOf(value);
  if (entries.length === 0)
    return html`<div class="value-row"><dt>${name}</dt><dd>${Array.isArray(value) ? "[]" : "{}"}</dd></div>`;
  if (Array.isArray(value) && value.length <= OPEN_MAX && value.every(isLeaf))
    return html`<div class="value-row"><dt>${name}</dt><dd title=${value.map(wholeText).join(", ")}>[${value.map(textOf).join(", ")}]</dd></div>`;
  return html`<details class="value-inner" open=${entries.length <= OPEN_MAX}><summary>${name}<small>${entries.length}</small></summary>
    <dl>${entries.slice(0, SHOWN_MAX).map(([key, inner]) => html`<${Entry} key=${key} name=${key} value=${inner} />`)}</dl></details>`;
}

/** @param {unknown} value @returns {[string, unknown][]} */
const entriesOf = (value) =>
  typeof value === "object" && value !== null
    ? Object.entries(value).map(([key, inner]) => [Array.isArray(value) ? `[${key}]` : key, inner])
    : [];

/** @param {unknown} value */
const isLeaf = (value) => typeof value !== "object" || value === null;

/** @param {unknown} value */
const wholeText = (value) => (value === "" ? '""' : String(value));

/** @param {unknown} value @returns {string} a fraction with as many digits as are read */
const textOf = (value) =>
  typeof value === "number" && !Number.isInteger(value) ? shownNumber(value) : wholeText(value);

const READ_AFTER_MS = 400;
/** Messages with more boxes are folded at first. */
const FIELDS_OPEN_MAX = 12;

/**
 * @typedef {object} FieldProps
 * @property {Types} types
 * @property {MessageView} message that it is a field of
 * @property {FieldView} field
 * @property {FormValue} value
 * @property {string} path from the message that is filled in
 * @property {boolean} disabled
 * @property {(value: FormValue) => void} onChange
 */

/**
 * A form of a message: a row for each field, those of messages in it folded, or its YAML.
 *
 * @param {{form: MessageForm, disabled: boolean}} props
 */
function FormOfMessage({ form, disabled }) {
  return html`<div class="message-form">
    <div class="message-form-head" role="group" aria-label=${t("form.ways")}>
      <button type="button" class="button small" aria-pressed=${!form.inYaml.value} disabled=${!form.isKnown.value}
        onClick=${() => form.inYaml.value && form.toFields()}>${t("form.fields")}</button>
      <button type="button" class="button small" aria-pressed=${form.inYaml.value}
        onClick=${() => form.inYaml.value || form.toYaml()}>YAML</button>
    </div>
    ${form.inYaml.value ? html`<${YamlText} form=${form} disabled=${disabled} />` : html`<${Fields} form=${form} disabled=${disabled} />`}
    ${form.trouble.value && html`<p class="note bad" role="alert">${form.trouble.value}</p>`}
  </div>`;
}

/** @param {{form: MessageForm, disabled: boolean}} props */
function YamlText({ form, disabled }) {
  const { text, trouble, chosen } = form;
  const now = text.value;
  // What is wrong with it is said while it is typed, not only when it is sent.
  useEffect(() => {
    if (!form.isKnown.peek() || now.trim() === "") return undefined;
    const timer = setTimeout(form.check, READ_AFTER_MS);
    return () => clearTimeout(timer);
  }, [now]);
  return html`<textarea class="box yaml" aria-label=${t("form.yaml", { type: chosen.value?.type ?? "" })} rows=${Math.min(Math.max(now.split("\n").length + 1, 4), 16)}
    spellcheck=${false} disabled=${disabled} aria-invalid=${trouble.value ? "true" : null} value=${now}
    onInput=${(/** @type {any} */ event) => {
      text.value = event.currentTarget.value;
    }}></textarea>`;
}

/** @param {{form: MessageForm, disabled: boolean}} props */
function Fields({ form, disabled }) {
  const { types, root, value } = form;
  if (!form.isKnown.value) return null;
  const change = (/** @type {FormValue} */ news) => {
    value.value = /** @type {FormMessage} */ (news);
  };
  return html`<${FieldsOf} types=${types.value} name=${root.value} value=${value.value} path="" disabled=${disabled} onChange=${change} />`;
}

/** @param {{types: Types, name: string, value: FormValue, path: string, disabled: boolean, onChange: (value: FormValue) => void}} props of a whole message */
function FieldsOf({ types, name, value, path, disabled, onChange }) {
  const message = types.get(name);
  if (!message || typeof value === "string") return null;
  if (message.fields.length === 0) return html`<p class="note">${t("form.empty")}</p>`;
  const values = /** @type {FormMessage} */ (value);
  return message.fields.map(
    (
      field,
    ) => html`<${FieldRow} key=${field.name} types=${types} message=${message} field=${field} path=${path ? `${path}.${field.name}` : field.name}
      value=${values[field.name] ?? ""} disabled=${disabled} onChange=${(/** @type {FormValue} */ news) => onChange({ ...values, [field.name]: news })} />`,
  );
}

/** @param {FieldProps} props */
function FieldRow(props) {
  const { field } = props;
  if (field.shape !== "single" && !isFlatList(field)) return html`<${ListRows} ...${props} />`;
  if (isNested(field)) return html`<${NestedRows} ...${props} />`;
  return html`<${SingleRow} ...${props} />`;
}

/** @param {FieldProps} props a message within the message */
function NestedRows({ types, field, value, path, disabled, onChange }) {
  const word = WORDS[field.base];
  const takesWord = word !== undefined;
  const isWord = typeof value === "string";
  const toggle = () => onChange(isWord ? blank(types, field.base) : (word ?? ""));
  return html`<details class="form-nested" open=${countOf(types, field.base) <= FIELDS_OPEN_MAX}>
    <summary><${FieldName} field=${field} />
      ${takesWord && html`<label class="form-word"><input type="checkbox" checked=${isWord} disabled=${disabled} onChange=${toggle} />${t("form.now")}</label>`}</summary>
    ${!isWord && html`<div class="form-inner"><${FieldsOf} types=${types} name=${field.base} value=${value} path=${path} disabled=${disabled} onChange=${onChange} /></div>`}
  </details>`;
}

/** @param {FieldProps} props a list of messages or texts */
function ListRows(props) {
  const { types, field, value, path, disabled, onChange } = props;
  const items = Array.isArray(value) ? value : [];
  const isFixed = field.shape === "array";
  const isFull = isFixed || (field.shape === "bounded" && items.length >= field.count);
  const single = /** @type {FieldView} */ ({ ...field, shape: "single", default: null });
  const change = (/** @type {number} */ at, /** @type {FormValue} */ news) =>
    onChange(items.map((item, n) => (n === at ? news : item)));
  return html`<details class="form-nested" open=${items.length > 0 && items.length <= FIELDS_OPEN_MAX}>
    <summary><${FieldName} field=${field} /><span class="form-count">${items.length}</span></summary>
    <div class="form-inner">${items.map(
      (item, n) => html`<div class="form-item" key=${n}>
        <${FieldRow} ...${props} field=${{ ...single, name: `[${n}]` }} path=${`${path}[${n}]`} value=${item} onChange=${(/** @type {FormValue} */ news) => change(n, news)} />
        ${!isFixed && html`<${IconButton} icon="trash" size=${13} label=${t("form.remove", { name: `${path}[${n}]` })} disabled=${disabled} onClick=${() => onChange(items.filter((_, at) => at !== n))} />`}
      </div>`,
    )}
    ${!isFull && html`<button type="button" class="button small" disabled=${disabled} onClick=${() => onChange([...items, one(types, single)])}>${t("form.add", { name: path })}</button>`}</div>
  </details>`;
}

/** @param {FieldProps} props */
function SingleRow(props) {
  const { field, value, path, disabled, onChange } = props;
  const id = useId();
  const isTruth = field.base === "bool" && field.shape === "single";
  return html`<div class="form-row">
    <label for=${id} title=${field.comment || null}><${FieldName} field=${field} /></label>
    ${
      isTruth
        ? html`<input id=${id} type="checkbox" aria-label=${path} checked=${value === true} disabled=${disabled} onChange=${(/** @type {any} */ event) => onChange(event.currentTarget.checked)} />`
        : html`<${FieldBox} ...${props} id=${id} />`
    }
  </div>`;
}

/** @param {FieldProps & {id: string}} props */
function FieldBox({ id, message, field, value, path, disabled, onChange }) {
  const trouble = troubleOf(field, value);
  const choices = choicesOf(message, field);
  const isBad = trouble !== "";
  return html`<input id=${id} type="text" class="box wide" aria-label=${path} value=${value} disabled=${disabled} spellcheck=${false} autocomplete="off" autocapitalize="off"
      inputmode=${isNumber(field) ? "decimal" : null} list=${choices.length > 0 ? `${id}-choices` : null}
      aria-invalid=${isBad ? "true" : null} aria-describedby=${isBad ? `${id}-trouble` : null} onInput=${(/** @type {any} */ event) => onChange(event.currentTarget.value)} />
    ${choices.length > 0 && html`<datalist id=${`${id}-choices`}>${choices.map(({ name, value: chosen }) => html`<option key=${name} value=${String(chosen)} label=${`${name} = ${chosen}`}></option>`)}</datalist>`}
    ${isBad && html`<p class="note bad" id=${`${id}-trouble`}>${t(trouble, boundsOf(field))}</p>`}`;
}

/** @param {{field: FieldView}} props */
function FieldName({ field }) {
  return html`<span class="form-name"><span>${field.name}</span><small>${typeText(field)}</small></span>`;
}
