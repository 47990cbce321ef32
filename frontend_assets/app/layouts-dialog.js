/** The window of the layouts: save the present one, use, rename and delete them, take them along as a file. */

/** @import { OwnLayout } from "./layouts.js" */

import { html, useRef, useSignal } from "vendor/preact.js";
import { saveAsFile } from "../lib/files.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon, IconButton } from "../lib/ui.js";
import { layoutControl, notify } from "../model/view.js";
import { layoutName } from "./layout-commands.js";
import {
  addLayouts,
  deleteLayout,
  FILE_LARGEST,
  LayoutFileError,
  LIVE,
  layoutFile,
  layoutInUse,
  ownLayouts,
  readLayoutFile,
  renameLayout,
  saveLayout,
} from "./layouts.js";
import { PANELS } from "./panels.js";

const FILE = "layouts.studio.json";

/** @param {{onClose: () => void}} props */
export function LayoutsDialog({ onClose }) {
  const own = ownLayouts.value;
  return html`<${Dialog} title=${t("layouts.title")} closeLabel=${t("close")} class="layouts" onClose=${onClose}>
    <${SaveForm} />
    <ul class="layouts-list" aria-label=${t("layouts.title")}>
      <${Row} name="" onClose=${onClose} /><${Row} name=${LIVE} onClose=${onClose} />
      ${own.map((one) => html`<${Row} key=${one.name} name=${one.name} layout=${one} onClose=${onClose} />`)}
    </ul>
    <footer><${ImportButton} />
      <button type="button" class="button" disabled=${own.length === 0} onClick=${() => saveAsFile(FILE, layoutFile(own))}>
        <${Icon} name="download" />${t("layouts.export_all")}</button>
      <span class="push"></span>
      <button type="button" class="button" onClick=${() => layoutControl.value?.reset()}><${Icon} name="reset" />${t("command.reset_layout")}</button></footer>
  <//>`;
}

function SaveForm() {
  const name = useSignal("");
  /** @param {Event} event */
  const save = (event) => {
    event.preventDefault();
    const control = layoutControl.value;
    if (!control || name.value.trim() === "") return;
    const kept = saveLayout(name.value, control.present());
    notify(t(kept ? "layouts.saved" : "layouts.full", { name: name.value.trim() }), { bad: !kept });
    if (kept) name.value = "";
  };
  return html`<form class="layouts-save" onSubmit=${save}>
    <input type="text" class="box wide" data-first maxlength="60" aria-label=${t("layouts.name")} placeholder=${t("layouts.name")}
      value=${name.value} onInput=${(/** @type {any} */ event) => {
        name.value = event.currentTarget.value;
      }} />
    <button type="submit" class="button primary" disabled=${name.value.trim() === ""}>${t("layouts.save")}</button>
  </form>`;
}

/** @param {{name: string, layout?: OwnLayout, onClose: () => void}} props without `layout` the studio's own */
function Row({ name, layout, onClose }) {
  const naming = useSignal(false);
  const shown = layoutName(name);
  const inUse = layoutInUse.value === name;
  const use = () => {
    layoutControl.value?.use(name);
    onClose();
  };
  if (naming.value) {
    return html`<li class="layouts-row"><${NameBox} name=${name} onDone=${() => {
      naming.value = false;
    }} /></li>`;
  }
  return html`<li class="layouts-row">
    <button type="button" class="layouts-use" aria-pressed=${inUse} onClick=${use}>
      <${Icon} name=${inUse ? "check" : "layout"} /><span class="layouts-name">${shown}</span></button>
    ${
      layout &&
      html`<${IconButton} icon="pencil" label=${t("layouts.rename", { name })} onClick=${() => {
        naming.value = true;
      }} />
      <${IconButton} icon="download" label=${t("layouts.export", { name })} onClick=${() => saveAsFile(`${name}.studio.json`, layoutFile([layout]))} />
      <${IconButton} icon="trash" label=${t("layouts.delete", { name })} onClick=${() => deleteLayout(name)} />`
    }
  </li>`;
}

/** @param {{name: string, onDone: () => void}} props */
function NameBox({ name, onDone }) {
  /** @param {any} event */
  const take = (event) => {
    if (!renameLayout(name, event.currentTarget.value))
      notify(t("layouts.taken", { name: event.currentTarget.value.trim() }), { bad: true });
    onDone();
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.key === "Enter") take(event);
    else if (event.key === "Escape") onDone();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return html`<input type="text" class="box wide" maxlength="60" aria-label=${t("layouts.rename", { name })} value=${name}
    ref=${(/** @type {HTMLInputElement | null} */ box) => box?.focus()} onKeyDown=${onKeyDown} onBlur=${take} />`;
}

function ImportButton() {
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  /** @param {any} event */
  const take = async (event) => {
    const [file] = /** @type {HTMLInputElement} */ (event.currentTarget).files ?? [];
    event.currentTarget.value = "";
    if (file) await importFile(file);
  };
  return html`<input type="file" accept=".json,application/json" hidden ref=${box} aria-label=${t("layouts.import")} onChange=${take} />
    <button type="button" class="button" onClick=${() => box.current?.click()}><${Icon} name="open" />${t("layouts.import")}</button>`;
}

/** @param {File} file */
async function importFile(file) {
  try {
    if (file.size > FILE_LARGEST) throw new LayoutFileError("layouts.import.too_large");
    const { layouts, dropped } = readLayoutFile(await file.text(), (id) => id in PANELS);
    const count = addLayouts(layouts);
    notify(t("layouts.import.done", { count }), { bad: count < layouts.length });
    if (dropped.length > 0)
      notify(
        t("layouts.import.dropped", { panels: dropped.slice(0, 5).join(", ").slice(0, 120) }),
        { bad: true },
      );
  } catch (error) {
    const reason = error instanceof LayoutFileError ? error.reason : "layouts.import.unreadable";
    notify(t(reason, { file: file.name }), { bad: true });
  }
}
