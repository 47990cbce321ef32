/** The types of ROS: all that are known, what each is made of, and texts of one's own. */

/** @import { InterfaceAnswer, InterfaceFaultView, MessageView } from "../../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { t } from "../../lib/i18n.js";
import { EmptyState, Icon, IconButton, ProgressBar, SearchBox } from "../../lib/ui.js";
import { connection, mayManage } from "../../model/connection.js";
import {
  addTypes,
  askInterfaces,
  byPackage,
  draft,
  faultPlace,
  fieldType,
  foundNames,
  interfaceName,
  interfaceRefused,
  interfaceShown,
  interfaces,
  interfacesRefused,
  kindOf,
  nameParts,
  showInterface,
  valueText,
} from "../../model/interfaces.js";
import { notify } from "../../model/view.js";
import { Refusal } from "../parts.js";

/** More are not listed at once: a search that finds as many is no search. */
const FOUND_MAX = 150;

export function InterfacesPanel() {
  const words = useSignal("");
  const isThere = connection.value === "connected";
  useEffect(() => {
    if (isThere) askInterfaces();
  }, [isThere]);
  return html`<section class="panel-body interfaces" aria-label=${t("panel.interfaces")}>
    <div class="panel-bar interfaces-bar">
      <${SearchBox} label=${t("interfaces.search")} value=${words.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        words.value = text;
      }} />
      <button type="button" class="button" disabled=${!mayManage.value} title=${t("interfaces.add.hint")} onClick=${startDraft}><${Icon} name="plus" size=${14} />${t("interfaces.add")}</button>
    </div>
    <div class="interfaces-parts"><${Names} words=${words.value} />
      ${draft.value ? html`<${InterfaceForm} key=${draft.value.name} />` : html`<${InterfaceDetails} />`}</div>
  </section>`;
}

function startDraft() {
  draft.value = { name: "my_interfaces/msg/", text: "" };
}

/** @param {{words: string}} props */
function Names({ words }) {
  const known = interfaces.value;
  if (interfacesRefused.value)
    return html`<${Refusal} sentence=${interfacesRefused.value} again=${askInterfaces} />`;
  if (!known) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const found = words.trim() === "" ? null : foundNames(known.names, words);
  return html`<nav class="interfaces-names scroll" aria-label=${t("interfaces.names")}>
    ${known.faults.length > 0 && html`<${Faults} faults=${known.faults} />`}
    ${found ? html`<${Found} names=${found} words=${words} />` : html`<${Packages} names=${known.names} own=${known.own} />`}
  </nav>`;
}

/** @param {{faults: readonly InterfaceFaultView[]}} props texts that define no type: where, and what to write */
function Faults({ faults }) {
  return html`<section class="interfaces-faults" aria-label=${t("interfaces.faults")}><h4>${t("interfaces.faults")}</h4>
    <ul>${faults.map((fault) => html`<li key=${fault.place} title=${fault.place}><${Icon} name="alert" size=${14} /><span><b>${faultPlace(fault)}</b> ${fault.reason}</span></li>`)}</ul></section>`;
}

/** @param {{names: readonly string[], words: string}} props */
function Found({ names, words }) {
  if (names.length === 0) return html`<p class="nothing">${t("filter.nothing", { words })}</p>`;
  const more = names.length - FOUND_MAX;
  return html`<ul>${names.slice(0, FOUND_MAX).map((name) => html`<${Name} key=${name} name=${name} words=${name} />`)}</ul>
    ${more > 0 && html`<p class="note padded">${t("interfaces.more", { count: more })}</p>`}`;
}

/** @param {{names: readonly string[], own: readonly string[]}} props those of one's own stand open, above */
function Packages({ names, own }) {
  const owners = new Set(own.map((name) => name.split("/")[0] ?? ""));
  const packages = [...byPackage(names)].sort(
    ([a], [b]) => Number(owners.has(b)) - Number(owners.has(a)) || a.localeCompare(b),
  );
  return packages.map(
    ([owner, types]) =>
      html`<${Package} key=${owner} owner=${owner} types=${types} isOwn=${owners.has(owner)} />`,
  );
}

/** @param {{owner: string, types: readonly string[], isOwn: boolean}} props */
function Package({ owner, types, isOwn }) {
  const holds = interfaceName.value.startsWith(`${owner}/`);
  const open = useSignal(isOwn);
  useEffect(() => {
    if (holds) open.value = true;
  }, [holds]);
  return html`<details open=${open.value} onToggle=${(/** @type {any} */ event) => {
    open.value = event.currentTarget.open;
  }}><summary><span class="interfaces-package">${owner}</span>${isOwn && html`<span class="tag">${t("interfaces.own")}</span>`}<span class="muted">${types.length}</span></summary>
    ${open.value && html`<ul>${types.map((name) => html`<${Name} key=${name} name=${name} words=${name.slice(owner.length + 1)} />`)}</ul>`}</details>`;
}

/** @param {{name: string, words: string}} props */
function Name({ name, words }) {
  const show = () => {
    draft.value = null;
    showInterface(name);
  };
  return html`<li><button type="button" class="interfaces-name" aria-pressed=${interfaceName.value === name} title=${name} onClick=${show}>${words}</button></li>`;
}

const PARTS = { msg: [""], srv: ["request", "response"], action: ["goal", "result", "feedback"] };

/**
 * What a type is made of: its fields down to numbers and texts, with their comments; and its
 * text.
 */
function InterfaceDetails() {
  const isText = useSignal(false);
  const shown = interfaceShown.value;
  if (interfaceName.value === "")
    return html`<div class="interfaces-details"><${EmptyState} icon="interfaces" title=${t("interfaces.choose")}><p>${t("interfaces.drop")}</p><//></div>`;
  if (!shown)
    return html`<div class="interfaces-details"><p class=${`note padded ${interfaceRefused.value && "bad"}`}>${interfaceRefused.value || t("loading")}</p></div>`;
  const withText = shown.text !== "";
  return html`<section class="interfaces-details scroll" aria-label=${shown.name}>
    <header><h3>${shown.name}</h3>
      ${withText && html`<button type="button" class="chip" aria-pressed=${isText.value} onClick=${() => flip(isText)}>${t("interfaces.text")}</button>`}
      <${IconButton} icon="copy" label=${t("interfaces.copy")} size=${14} onClick=${() => copy(shown.name)} /></header>
    ${isText.value && withText ? html`<${Text} text=${shown.text} />` : html`<${Parts} shown=${shown} />`}
    <p class="interfaces-hash" title=${t("interfaces.hash")}><span>${shown.hash}</span><${IconButton} icon="copy" label=${t("interfaces.copy_hash")} size=${13} onClick=${() => copy(shown.hash)} /></p>
  </section>`;
}

/** @param {import("vendor/preact.js").Signal<boolean>} one */
function flip(one) {
  one.value = !one.value;
}

/** @param {string} text */
async function copy(text) {
  const done = await copyText(text);
  notify(done ? t("copied") : t("copy.failed"), { bad: !done });
}

/** @param {{text: string}} props as it was written */
function Text({ text }) {
  return html`<div class="interfaces-text"><pre>${text}</pre><${IconButton} icon="copy" label=${t("interfaces.copy_text")} size=${14} onClick=${() => copy(text)} /></div>`;
}

/** @param {{shown: InterfaceAnswer}} props */
function Parts({ shown }) {
  const types = new Map(shown.messages.map((one) => [one.name, one]));
  return shown.parts.map((name, at) => {
    const word = PARTS[shown.kind][at] ?? "";
    const message = types.get(name);
    return html`<div key=${name} class="interfaces-part">
      ${word && html`<h4>${t(`interfaces.part.${word}`)}</h4>`}
      ${message && html`<${Message} message=${message} types=${types} />`}</div>`;
  });
}

/** @param {{message: MessageView, types: ReadonlyMap<string, MessageView>}} props */
function Message({ message, types }) {
  const isEmpty = message.fields.length + message.constants.length === 0;
  return html`${message.comment && html`<p class="interfaces-comment">${message.comment}</p>`}
    ${isEmpty && html`<p class="note">${t("interfaces.empty")}</p>`}
    <ul class="interfaces-fields">
      ${message.constants.map(({ name, base, value, comment }) => html`<li key=${name}><code class="field-type">${base}</code><code class="constant">${name} = ${valueText(value)}</code><${Comment} text=${comment} /></li>`)}
      ${message.fields.map((field) => html`<${Field} key=${field.name} field=${field} types=${types} />`)}
    </ul>`;
}

/** @param {{field: MessageView["fields"][number], types: ReadonlyMap<string, MessageView>}} props one of a message opens to what that is made of */
function Field({ field, types }) {
  const open = useSignal(false);
  const inner = types.get(field.base);
  const value = valueText(field.default);
  const words = html`<code class="field-type">${fieldType(field)}</code><code class="field-name">${field.name}</code>${value && html`<code class="muted">${value}</code>`}<${Comment} text=${field.comment} />`;
  if (!inner) return html`<li>${words}</li>`;
  return html`<li class="nested"><div><${IconButton} icon=${open.value ? "chevronDown" : "chevronRight"} label=${t(open.value ? "interfaces.fold" : "interfaces.unfold", { name: field.name })} size=${13} onClick=${() => flip(open)} />${words}
    <button type="button" class="link-button" title=${t("interfaces.go", { name: field.base })} aria-label=${t("interfaces.go", { name: field.base })} onClick=${() => showInterface(field.base)}><${Icon} name="jump" size=${13} /></button></div>
    ${open.value && html`<${Message} message=${inner} types=${types} />`}</li>`;
}

/** @param {{text: string}} props */
const Comment = ({ text }) => text && html`<span class="interfaces-comment">${text}</span>`;

const EXAMPLE = "string robot_name\nfloat32 battery_percent\n";

/** A type of one's own as text: named, checked by the studio, and usable at once. */
function InterfaceForm() {
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  const name = useSignal(draft.value?.name ?? "");
  const text = useSignal(draft.value?.text ?? "");
  const busy = useSignal(false);
  const error = useSignal("");
  const close = () => {
    draft.value = null;
  };
  useEffect(() => box.current?.focus(), []);
  /** @param {Event} event */
  const add = async (event) => {
    event.preventDefault();
    busy.value = true;
    error.value = await addTypes({ [name.value.trim()]: text.value });
    busy.value = false;
    if (error.value === "") close();
  };
  const parts = nameParts(name.value.trim());
  const kind = kindOf(text.value);
  const isOdd = parts !== null && text.value !== "" && parts.kind !== kind;
  return html`<form class="interfaces-form" aria-label=${t("interfaces.add")} onSubmit=${add}>
    <label class="field"><span>${t("interfaces.name")}</span>
      <input ref=${box} type="text" class="box wide" maxlength="300" spellcheck=${false} autocapitalize="off" value=${name.value} onInput=${(
        /** @type {any} */ event,
      ) => {
        name.value = event.currentTarget.value;
      }} /></label>
    <label class="field tall"><span>${t("interfaces.text")}</span>
      <textarea class="box" spellcheck=${false} placeholder=${EXAMPLE} value=${text.value} onInput=${(
        /** @type {any} */ event,
      ) => {
        text.value = event.currentTarget.value;
      }}></textarea></label>
    ${parts === null && html`<p class="note">${t("interfaces.name.hint")}</p>`}
    ${isOdd && html`<p class="note graph-warning">${t("interfaces.kind.hint", { kind })}</p>`}
    ${error.value && html`<p class="note bad" role="alert">${error.value}</p>`}
    <footer><span class="push"></span><button type="button" class="button" onClick=${close}>${t("cancel")}</button>
      <button type="submit" class="button primary" disabled=${!mayManage.value || busy.value || parts === null || text.value.trim() === ""}>${t("interfaces.take")}</button></footer>
  </form>`;
}
