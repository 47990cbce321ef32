/** A shelf of saved views: use, save, rename, arrange and delete; what was deleted can be brought back. */

/** @import { Saved, ViewSpec } from "../../model/views.js" */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { TextBox } from "../../lib/slider.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { currentView, useView } from "../../model/views.js";

/**
 * @typedef {object} Shelf
 * @property {"shared" | "own"} id
 * @property {{readonly value: readonly Saved[]}} views
 * @property {{readonly value: boolean}} mayChange
 * @property {(view: ViewSpec, before?: string) => Promise<unknown>} save
 * @property {(id: string, name: string) => Promise<unknown>} rename
 * @property {(id: string) => Promise<unknown>} remove
 * @property {(id: string, before: string) => Promise<unknown>} move
 */

/** @typedef {{view: Saved, before: string}} Deleted */

/** @param {{shelf: Shelf}} props */
export function SavedShelf({ shelf }) {
  const naming = useSignal(/** @type {string | null} */ (null));
  const deleted = useSignal(/** @type {Deleted | null} */ (null));
  const views = shelf.views.value;
  const title = t(`views.${shelf.id}`);
  const save = () => {
    const spec = currentView(freeName(views));
    if (spec) shelf.save(spec);
  };
  return html`<section class="views-shelf" aria-label=${title}>
    <header><h3 title=${t(`views.${shelf.id}.hint`)}>${title}</h3>
      <${IconButton} icon="plus" label=${t(`views.${shelf.id}.save`)} disabled=${!shelf.mayChange.value} onClick=${save} /></header>
    ${views.length === 0 && html`<p class="nothing">${t(`views.${shelf.id}.none`)}</p>`}
    <ul>${views.map((view, at) => html`<${Row} key=${view.id} shelf=${shelf} view=${view} at=${at} naming=${naming} deleted=${deleted} />`)}</ul>
    ${deleted.value && html`<${BringBack} shelf=${shelf} deleted=${deleted} />`}
  </section>`;
}

/** @param {{shelf: Shelf, view: Saved, at: number, naming: {value: string | null}, deleted: {value: Deleted | null}}} props */
function Row({ shelf, view, at, naming, deleted }) {
  if (naming.value === view.id)
    return html`<li class="views-row"><${Naming} shelf=${shelf} view=${view} naming=${naming} /></li>`;
  return html`<li class="views-row">
    <button type="button" class="views-use" title=${t("views.use", { name: view.name })} onClick=${() => useView(view)}>
      <${Icon} name="camera" size=${14} /><span>${view.name}</span><small class="muted">${view.kind}</small></button>
    ${shelf.mayChange.value && html`<${MenuButton} label=${t("views.menu", { name: view.name })} items=${() => itemsOf(shelf, view, at, naming, deleted)}><${Icon} name="dots" /><//>`}
  </li>`;
}

/** @param {Shelf} shelf @param {Saved} view @param {number} at @param {{value: string | null}} naming @param {{value: Deleted | null}} deleted */
function itemsOf(shelf, view, at, naming, deleted) {
  const views = shelf.views.value;
  const remove = async () => {
    const before = views[at + 1]?.id ?? "";
    if (await shelf.remove(view.id)) deleted.value = { view, before };
  };
  const overwrite = async () => {
    const now = currentView(view.name);
    if (!now) return;
    await shelf.save(now, view.id);
    if (await shelf.remove(view.id)) deleted.value = { view, before: "" };
  };
  return [
    { label: t("views.rename"), icon: "pencil", run: () => rename(naming, view) },
    { label: t("views.overwrite"), icon: "camera", run: overwrite },
    {
      label: t("views.up"),
      disabled: at === 0,
      run: () => void shelf.move(view.id, views[at - 1]?.id ?? ""),
    },
    {
      label: t("views.down"),
      disabled: at === views.length - 1,
      run: () => void shelf.move(view.id, views[at + 2]?.id ?? ""),
    },
    { label: t("views.delete"), icon: "trash", run: remove },
  ];
}

/** @param {{value: string | null}} naming @param {Saved} view */
function rename(naming, view) {
  naming.value = view.id;
}

/** @param {{shelf: Shelf, view: Saved, naming: {value: string | null}}} props */
function Naming({ shelf, view, naming }) {
  const end = () => {
    naming.value = null;
  };
  const write = async (/** @type {string} */ name) => {
    end();
    await shelf.rename(view.id, name);
  };
  return html`<span class="views-naming" ref=${focusOnce} onFocusOut=${end}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => event.key === "Escape" && end()}>
    <${TextBox} class="name" label=${t("views.name", { name: view.name })} text=${view.name} onWrite=${write} /></span>`;
}

/** @param {HTMLElement | null} element */
function focusOnce(element) {
  const box = element?.querySelector("input");
  if (box && document.activeElement !== box) {
    box.focus();
    box.select();
  }
}

/** @param {{shelf: Shelf, deleted: {value: Deleted | null}}} props */
function BringBack({ shelf, deleted }) {
  const { view, before } = /** @type {Deleted} */ (deleted.value);
  const isThere = shelf.views.value.some(({ id }) => id === before);
  const undo = async () => {
    if (await shelf.save(view, isThere ? before : "")) deleted.value = null;
  };
  return html`<p class="views-deleted" role="status"><span>${t("views.deleted", { name: view.name })}</span>
    <button type="button" class="text-button" onClick=${undo}>${t("views.undo")}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${() => {
      deleted.value = null;
    }} /></p>`;
}

/** @param {readonly Saved[]} views @returns {string} that none of them has */
function freeName(views) {
  const taken = new Set(views.map(({ name }) => name));
  for (let number = 1; ; number += 1) {
    const name = t("views.new", { number });
    if (!taken.has(name)) return name;
  }
}
