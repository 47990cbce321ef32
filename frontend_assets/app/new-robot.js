/** A new robot out of a template, in a package of its own. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { nameFault, robotOf } from "../lib/package-names.js";
import { openNamed } from "../model/requests.js";
import { PlaceFields, usePlace } from "./place-form.js";
import { Picture } from "./start-lists.js";

const TEMPLATES = /** @type {const} */ (["rover", "arm", "blank"]);

export function NewForm() {
  const template = useSignal(/** @type {typeof TEMPLATES[number]} */ ("rover"));
  const place = usePlace("my_robot_description");
  const busy = useSignal(false);
  const name = place.name.value;
  /** @param {Event} event */
  const make = async (event) => {
    event.preventDefault();
    if (busy.value || nameFault(name)) return;
    busy.value = true;
    const folder = place.folder.value.trim();
    await openNamed({ type: "new_robot", template: template.value, name, folder });
    busy.value = false;
  };
  return html`<form class="open-form" onSubmit=${make}>
    <div class="form-scroll">
    <fieldset class="cards templates"><legend>${t("new.template")}</legend>
      ${TEMPLATES.map(
        (one) =>
          html`<label key=${one} class="card"><input type="radio" name="template" value=${one} checked=${template.value === one} onChange=${() => {
            template.value = one;
          }} /><${Picture} name=${`new-${one}`} /><strong>${t(`new.${one}`)}</strong><span>${t(`new.${one}.text`)}</span></label>`,
      )}
    </fieldset>
    <${PlaceFields} place=${place} path=${`${name}/urdf/${robotOf(name)}.urdf.xacro`} /></div>
    <footer><span class="push"></span>
      <button type="submit" class="button primary" disabled=${busy.value || nameFault(name) !== ""}>${t("new.make")}</button></footer>
  </form>`;
}
