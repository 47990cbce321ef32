/** A type of one's own as text: named, checked by the studio, and usable at once. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { mayEdit } from "../model/connection.js";
import { addTypes, draft, kindOf, nameParts } from "../model/interfaces.js";

const EXAMPLE = "string robot_name\nfloat32 battery_percent\n";

export function InterfaceForm() {
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
      <button type="submit" class="button primary" disabled=${!mayEdit.value || busy.value || parts === null || text.value.trim() === ""}>${t("interfaces.take")}</button></footer>
  </form>`;
}
