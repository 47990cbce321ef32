/** A box for a text that is to be opened as an untitled robot. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { openText } from "./drop.js";

export function PasteForm() {
  const box = useRef(/** @type {HTMLTextAreaElement | null} */ (null));
  const text = useSignal("");
  const busy = useSignal(false);
  useEffect(() => box.current?.focus(), []);
  /** @param {Event} event */
  const open = async (event) => {
    event.preventDefault();
    busy.value = true;
    await openText(text.value);
    busy.value = false;
  };
  return html`<form class="open-form" onSubmit=${open}>
    <p class="open-text">${t("paste.text")}</p>
    <textarea ref=${box} class="box paste-box" aria-label=${t("paste.label")} placeholder=${t("paste.placeholder")} spellcheck=${false}
      value=${text.value} onInput=${(/** @type {any} */ event) => {
        text.value = event.currentTarget.value;
      }}></textarea>
    <footer><${Icon} name="info" size=${14} /><span class="form-note">${t("paste.kept")}</span><span class="push"></span>
      <button type="submit" class="button primary" disabled=${busy.value || text.value.trim() === ""}>${t("paste.open")}</button></footer>
  </form>`;
}
