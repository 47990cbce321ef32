/** Name and note of a variant, where it stands in the list. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";

/**
 * @param {{title: string, action: string, name: string, note: string,
 *   run: (name: string, note: string) => Promise<string>, onDone: () => void}} props `run` says why it was not done; empty: it was
 */
export function VariantForm({ title, action, name, note, run, onDone }) {
  const typed = useSignal(name);
  const words = useSignal(note);
  const busy = useSignal(false);
  const error = useSignal("");
  const first = useRef(/** @type {HTMLInputElement | null} */ (null));
  useEffect(() => {
    first.current?.select();
    first.current?.form?.scrollIntoView({ block: "nearest" });
  }, []);
  const submit = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (typed.value.trim() === "" || busy.value) return;
    busy.value = true;
    error.value = await run(typed.value.trim(), words.value.trim());
    busy.value = false;
    if (error.value === "") onDone();
    else first.current?.select();
  };
  const cancel = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    onDone();
  };
  return html`<form class="variant-form" aria-label=${title} onSubmit=${submit} onKeyDown=${cancel}>
    <label><span>${t("variants.name")}</span>
      <input ref=${first} type="text" class="box wide" maxlength="100" required spellcheck=${false} value=${typed.value}
        aria-invalid=${error.value !== ""} aria-describedby=${error.value ? "variant-form-error" : undefined}
        onInput=${(/** @type {any} */ event) => {
          typed.value = event.currentTarget.value;
          error.value = "";
        }} /></label>
    ${error.value && html`<p id="variant-form-error" class="note bad" role="alert"><${Icon} name="error" size=${13} />${error.value}</p>`}
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
