/** Name and note of a variant, where it stands in the list. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";

/**
 * @param {{title: string, action: string, name: string, note: string,
 *   run: (name: string, note: string) => Promise<boolean>, onDone: () => void}} props `run` says whether it was done
 */
export function VariantForm({ title, action, name, note, run, onDone }) {
  const typed = useSignal(name);
  const words = useSignal(note);
  const busy = useSignal(false);
  const first = useRef(/** @type {HTMLInputElement | null} */ (null));
  useEffect(() => {
    first.current?.select();
    first.current?.form?.scrollIntoView({ block: "nearest" });
  }, []);
  const submit = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (typed.value.trim() === "" || busy.value) return;
    busy.value = true;
    const done = await run(typed.value.trim(), words.value.trim());
    busy.value = false;
    if (done) onDone();
  };
  const cancel = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    onDone();
  };
  return html`<form class="variant-form" aria-label=${title} onSubmit=${submit} onKeyDown=${cancel}>
    <label><span>${t("variants.name")}</span>
      <input ref=${first} type="text" class="box wide" maxlength="100" required spellcheck=${false} value=${typed.value}
        onInput=${(/** @type {any} */ event) => {
          typed.value = event.currentTarget.value;
        }} /></label>
    <label><span>${t("variants.note")}</span>
      <input type="text" class="box wide" maxlength="2000" value=${words.value}
        onInput=${(/** @type {any} */ event) => {
          words.value = event.currentTarget.value;
        }} /></label>
    <footer>
      <button type="button" class="button small" onClick=${onDone}>${t("cancel")}</button>
      <button type="submit" class="button small primary" disabled=${busy.value || typed.value.trim() === ""}>${action}</button>
    </footer>
  </form>`;
}
