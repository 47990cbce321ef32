/** What a type is made of: its fields down to numbers and texts, with their comments; and its text. */

/** @import { InterfaceAnswer, MessageView } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon, IconButton } from "../lib/ui.js";
import {
  fieldType,
  interfaceName,
  interfaceRefused,
  interfaceShown,
  showInterface,
  valueText,
} from "../model/interfaces.js";
import { notify } from "../model/view.js";

const PARTS = { msg: [""], srv: ["request", "response"], action: ["goal", "result", "feedback"] };

export function InterfaceDetails() {
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
