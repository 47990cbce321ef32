/** A form of a message: a row for each field, those of messages in it folded, or its YAML. */

/** @import { FieldView, MessageView } from "../types/wire.d.ts" */
/** @import { FormMessage, FormValue, MessageForm, Types } from "../model/message-forms.js" */

import { html, useEffect, useId } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
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

const READ_AFTER_MS = 400;
/** Messages with more boxes are folded at first. */
const OPEN_MAX = 12;

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

/** @param {{form: MessageForm, disabled: boolean}} props */
export function FormOfMessage({ form, disabled }) {
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
  return html`<details class="form-nested" open=${countOf(types, field.base) <= OPEN_MAX}>
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
  return html`<details class="form-nested" open=${items.length > 0 && items.length <= OPEN_MAX}>
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
