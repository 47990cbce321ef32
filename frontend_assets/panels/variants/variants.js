/** Named states of the robot: kept, switched in one click, and compared below. */

/** @import { VariantView } from "../../types/wire.d.ts" */
/** @import { MenuItem } from "../../lib/ui.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { shortPath } from "../../lib/paths.js";
import { EmptyState, Icon, MenuButton } from "../../lib/ui.js";
import { mayEdit, mayManage } from "../../model/connection.js";
import { documentState, robot } from "../../model/document.js";
import { ask } from "../../model/requests.js";
import {
  applyVariant,
  compareSides,
  renameVariant,
  saveVariant,
  updateVariant,
  variants,
} from "../../model/variants.js";
import { dialog } from "../../model/view.js";
import { VariantsComparison } from "./comparison.js";

const CHIPS = 4;
const openRobot = () => {
  dialog.value = { kind: "open" };
};

export function VariantsPanel() {
  const adding = useSignal(false);
  const editing = useSignal("");
  const list = variants.value.variants;
  const begin = () => {
    adding.value = true;
    editing.value = "";
  };
  if (!documentState.value || !robot.value)
    return html`<section class="panel-body" aria-label=${t("panel.variants")}><${EmptyState} icon="variants" title=${t("urdf.none")}>
      <button type="button" class="button primary" disabled=${!mayManage.value} onClick=${openRobot}><${Icon} name="open" />${t("command.open")}…</button><//></section>`;
  return html`<section class="panel-body variants" aria-label=${t("panel.variants")}>
    <div class="scroll">
      <div class="variants-side">
      <${Trouble} />
      ${list.length === 0 && !adding.value && html`<${Purpose} />`}
      <ul class="variant-list">
        ${(list.length > 0 || variants.value.modified) && html`<${AsSaved} />`}
        ${list.map((one) =>
          editing.value === one.name
            ? html`<${RenameForm} key=${one.name} variant=${one} onDone=${() => (editing.value = "")} />`
            : html`<${VariantRow} key=${one.name} variant=${one} onRename=${() => (editing.value = one.name)} />`,
        )}
      </ul>
      ${adding.value && html`<${SaveForm} onDone=${() => (adding.value = false)} />`}
      ${
        !adding.value &&
        html`<div class="variants-actions">
        <button type="button" class=${`button ${list.length === 0 ? "primary" : "small"}`} disabled=${!mayEdit.value} onClick=${begin}>
          <${Icon} name="plus" size=${14} />${t("variants.save")}</button></div>`
      }
      </div>
      <${VariantsComparison} />
    </div>
  </section>`;
}

/** What variants are for, while there are none. */
function Purpose() {
  return html`<div class="variants-purpose">
    <${Icon} name="variants" size=${28} />
    <p>${t("variants.none")}</p>
    <p class="muted">${t("variants.purpose")}</p>
    <p class="muted">${t("variants.begin")}</p>
  </div>`;
}

/** The file cannot be read, or not be written. */
function Trouble() {
  const { trouble, only_here: onlyHere, variants: list } = variants.value;
  if (trouble)
    return html`<p class="variants-note bad" role="alert"><${Icon} name="alert" />${trouble}</p>`;
  if (!onlyHere || list.length === 0) return null;
  return html`<p class="variants-note"><${Icon} name="info" />${t("variants.only_here", { reason: onlyHere })}</p>`;
}

/** @param {{onDone: () => void}} props */
function SaveForm({ onDone }) {
  return html`<${VariantForm} title=${t("variants.new")} action=${t("variants.save.do")} name="" note="" run=${saveVariant} onDone=${onDone} />`;
}

/** @param {{variant: VariantView, onDone: () => void}} props */
function RenameForm({ variant, onDone }) {
  /** @param {string} name @param {string} note */
  const rename = (name, note) => renameVariant(variant.name, name, note);
  return html`<li><${VariantForm} title=${t("variants.rename")} action=${t("variants.rename.do")} name=${variant.name}
    note=${variant.note} run=${rename} onDone=${onDone} /></li>`;
}

/** The robot as its files say: always there to go back to. */
function AsSaved() {
  const { active: name, modified } = variants.value;
  const active = name === "";
  const changed = modified || !active;
  return html`<li class=${`variant ${active ? "active" : ""}`}>
    <${Choice} name="" label=${t("variants.saved")} active=${active}>
      <small class="muted">${t(changed && mayEdit.value ? "variants.saved.back" : "variants.saved.note")}</small>
    <//>
  </li>`;
}

/** @param {{variant: VariantView, onRename: () => void}} props */
function VariantRow({ variant, onRename }) {
  const active = variants.value.active === variant.name;
  return html`<li class=${`variant ${active ? "active" : ""}`}>
    <${Choice} name=${variant.name} label=${variant.name} active=${active}>
      ${variant.note && html`<small>${variant.note}</small>`}
      <${Chips} variant=${variant} />
    <//>
    ${active && variants.value.modified && mayEdit.value && html`<button type="button" class="button small" onClick=${() => updateVariant(variant.name)}>${t("variants.update")}</button>`}
    <${MenuButton} class="icon-button" label=${t("variants.menu", { name: variant.name })} items=${() => menuItems(variant, onRename)}>
      <${Icon} name="dots" size=${14} /><//>
  </li>`;
}

/** @param {{name: string, label: string, active: boolean, children: unknown}} props switches to it */
function Choice({ name, label, active, children }) {
  const changed = active && variants.value.modified;
  return html`<button type="button" class="variant-choice" aria-pressed=${active} disabled=${!mayEdit.value}
    title=${mayEdit.value ? t("variants.apply", { name: label }) : t("variants.viewer")} onClick=${() => applyVariant(name)}>
    <span class="variant-mark">${active && html`<${Icon} name="check" size=${14} />`}</span>
    <span class="variant-words">
      <span class="variant-name">${label}${changed && html`<em class="variant-modified">${t("variants.modified")}</em>`}</span>
      ${children}
    </span>
  </button>`;
}

/** @param {{variant: VariantView}} props what it sets, as far as there is room */
function Chips({ variant }) {
  const set = [
    ...Object.entries(variant.arguments).map(([name, value]) => [
      name,
      value ?? t("variants.not_passed"),
    ]),
    ...variant.texts.map(({ name, text }) => [name, text]),
  ];
  if (set.length === 0) return html`<small class="muted">${t("variants.same")}</small>`;
  const more = set.length - CHIPS;
  return html`<span class="variant-values">
    ${set.slice(0, CHIPS).map(([name, text]) => html`<code key=${name} title=${`${name} = ${text}`}>${name} <b>${text}</b></code>`)}
    ${more > 0 && html`<small class="muted">${t("variants.more", { count: more })}</small>`}
  </span>`;
}

/** @param {VariantView} variant @param {() => void} onRename @returns {MenuItem[]} */
function menuItems(variant, onRename) {
  const { name } = variant;
  const locked = !mayEdit.value;
  const remove = () => {
    dialog.value = {
      kind: "confirm",
      title: t("variants.delete"),
      text: t("variants.delete.text", {
        name,
        file: shortPath(variants.value.path, documentState.value?.root ?? ""),
      }),
      action: t("variants.delete"),
      danger: true,
      run: () => void ask({ type: "delete_variant", name }),
    };
  };
  const compare = () => compareSides({ kind: "present", name: "" }, { kind: "variant", name });
  return [
    { label: t("variants.compare.with"), icon: "compare", disabled: locked, run: compare },
    {
      label: t("variants.update.long"),
      icon: "reload",
      disabled: locked,
      run: () => void updateVariant(name),
    },
    { label: t("variants.rename"), icon: "pencil", disabled: locked, run: onRename },
    { label: t("variants.delete"), icon: "trash", disabled: locked, run: remove },
  ];
}

/**
 * Name and note of a variant, where it stands in the list.
 *
 * @param {{title: string, action: string, name: string, note: string,
 * run: (name: string, note: string) => Promise<string>, onDone: () => void}} props `run` says why it was not done; empty: it was
 */
function VariantForm({ title, action, name, note, run, onDone }) {
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
