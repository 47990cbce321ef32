/** The window that gives a robot a place of its own, with a package around it. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Dialog } from "../lib/ui.js";
import { robot, title } from "../model/document.js";
import { openNamed } from "../model/requests.js";
import { nameFault, PlaceFields, robotOf, usePlace } from "./place-form.js";

/** @returns {string} a name out of the robot's own, as far as that can be one */
function proposedName() {
  const base = (robot.value?.name || title.value.split(".")[0] || "robot")
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "_")
    .replace(/^[^a-z]+|_+$/g, "");
  const name = `${base || "my_robot"}_description`;
  return nameFault(name) || base === "untitled" ? "my_robot_description" : name;
}

/** @param {{onClose: () => void}} props */
export function SaveAsDialog({ onClose }) {
  const place = usePlace(proposedName());
  const asPackage = useSignal(true);
  const busy = useSignal(false);
  const name = place.name.value;
  const file = `${robotOf(name)}.urdf.xacro`;
  /** @param {Event} event */
  const save = async (event) => {
    event.preventDefault();
    if (busy.value || nameFault(name)) return;
    busy.value = true;
    const folder = place.folder.value.trim();
    await openNamed({ type: "save_as", name, folder, as_package: asPackage.value });
    busy.value = false;
  };
  return html`<${Dialog} title=${t("save_as.title")} closeLabel=${t("close")} class="save-as" onClose=${onClose}>
    <form class="open-form" onSubmit=${save}>
      <p class="dialog-text">${t("save_as.text")}</p>
      <${PlaceFields} place=${place} path=${asPackage.value ? `${name}/urdf/${file}` : file} />
      <label class="form-check"><input type="checkbox" checked=${asPackage.value} onChange=${(
        /** @type {any} */ event,
      ) => {
        asPackage.value = event.currentTarget.checked;
      }} /><span>${t("save_as.package")}</span></label>
      <footer><span class="push"></span>
        <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
        <button type="submit" class="button primary" disabled=${busy.value || nameFault(name) !== ""}>${t("command.save")}</button></footer>
    </form>
  <//>`;
}
