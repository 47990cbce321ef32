/** What saving writes, file by file, before it is written; Enter writes it. */

/** @import { Changes, FileChanges } from "../types/wire.d.ts" */
/** @import { DrawnLine } from "../lib/text-differences.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useMemo, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { drawnLines } from "../lib/text-differences.js";
import { Dialog, Icon, ProgressBar } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import { documentState, SAVE_CHOICES, showBeforeSaving } from "../model/document.js";
import { ask, saveFiles } from "../model/requests.js";
import { notify } from "../model/view.js";

/** @param {{onClose: () => void}} props */
export function SaveDialog({ onClose }) {
  const found = useSignal(/** @type {Changes | null} */ (null));
  const left = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const load = async () => {
    const answer = await ask({ type: "get_changes" });
    if (answer?.type !== "changes") return onClose();
    found.value = answer;
    left.value = new Set(answer.files.filter(({ hindrance }) => hindrance).map(({ file }) => file));
  };
  useEffect(() => void load(), []);
  const chosen = found.value?.files.filter(({ file }) => !left.value.has(file)) ?? [];
  const none = found.value !== null && chosen.length === 0;
  /** @param {Event} event */
  const save = async (event) => {
    event.preventDefault();
    if (none) return;
    onClose();
    await saveFiles(found.value && left.value.size > 0 ? chosen.map(({ file }) => file) : null);
  };
  return html`<${Dialog} title=${t("save.title")} closeLabel=${t("close")} class="save-window" onClose=${onClose}>
    <form class="save-form" onSubmit=${save}>
      <div class="save-files" tabindex="0" role="group" aria-label=${t("save.title")}>
        ${
          found.value
            ? found.value.files.map(
                (one) =>
                  html`<${File} key=${one.file} one=${one} left=${left} copies=${found.value?.copies ?? ""} />`,
              )
            : html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`
        }
      </div>
      <footer><${ShowChoice} /><span class="push"></span>
        <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
        <button type="submit" class="button primary" data-first disabled=${none}>${t("command.save")}</button></footer>
    </form>
  <//>`;
}

function ShowChoice() {
  /** @param {{currentTarget: HTMLSelectElement}} event */
  const choose = ({ currentTarget }) => {
    showBeforeSaving.value = SAVE_CHOICES[currentTarget.selectedIndex] ?? "always";
  };
  return html`<label class="save-choice"><span>${t("save.show")}</span>
    <select class="box" onChange=${choose}>${SAVE_CHOICES.map((one) => html`<option key=${one} selected=${showBeforeSaving.value === one}>${t(`save.show.${one}`)}</option>`)}</select></label>`;
}

/** @param {{one: FileChanges, left: Signal<ReadonlySet<string>>, copies: string}} props */
function File({ one, left, copies }) {
  const { file, added, removed, hunks, hindrance } = one;
  const toggle = () => {
    const now = new Set(left.value);
    if (!now.delete(file)) now.add(file);
    left.value = now;
  };
  return html`<section class="save-file" aria-label=${shortName(file)}>
    <label class="save-head"><input type="checkbox" checked=${!left.value.has(file)} disabled=${hindrance !== ""} onChange=${toggle} />
      <span class="save-name" title=${file}>${shortName(file)}</span>
      <span class="save-count added" aria-label=${t("save.added", { count: added })}>+${added}</span>
      <span class="save-count removed" aria-label=${t("save.removed", { count: removed })}>−${removed}</span></label>
    ${hindrance && html`<${Hindered} file=${file} hindrance=${hindrance} copies=${copies} />`}
    ${hunks.map((lines, at) => html`<${Hunk} key=${at} lines=${lines} />`)}
    ${one.left_out > 0 && html`<p class="note">${t("save.more", { count: one.left_out })}</p>`}
    ${hunks.length === 0 && html`<p class="note">${t("save.invisible")}</p>`}
  </section>`;
}

/** @param {string} file @returns {string} as it is called below the opened folder */
function shortName(file) {
  const root = documentState.value?.root ?? "";
  return root && file.startsWith(`${root}/`) ? file.slice(root.length + 1) : file;
}

/** @param {{file: string, hindrance: string, copies: string}} props why it cannot be saved, and a way out */
function Hindered({ file, hindrance, copies }) {
  const path = useSignal(`${copies}/${baseName(file).replace(/^(.+?)(\.|$)/, "$1_copy$2")}`);
  const saveCopy = async () => {
    const answer = await ask({ type: "save_copy", file, path: path.value });
    if (answer) notify(t("save.copied", { path: path.value }));
  };
  /** @param {KeyboardEvent} event */
  const onKey = (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    saveCopy();
  };
  return html`<div class="save-hindered"><p><${Icon} name="lock" size=${14} /><span>${hindrance}</span></p>
    ${
      copies &&
      mayManage.value &&
      html`<div class="save-copy"><input class="box" aria-label=${t("save.copy.path")} spellcheck=${false} value=${path.value} onKeyDown=${onKey}
        onInput=${(/** @type {any} */ event) => {
          path.value = event.currentTarget.value;
        }} />
      <button type="button" class="button small" onClick=${saveCopy}>${t("save.copy")}</button></div>`
    }</div>`;
}

/** @param {{lines: FileChanges["hunks"][number]}} props */
function Hunk({ lines }) {
  const drawn = useMemo(() => drawnLines(lines), [lines]);
  return html`<div class="hunk" role="table">${drawn.map((line, at) => html`<${Line} key=${at} line=${line} />`)}</div>`;
}

const SIGNS = { same: " ", old: "−", new: "+" };

/** @param {{line: DrawnLine}} props */
function Line({ line }) {
  return html`<div class=${`hunk-line ${line.kind}`} role="row"><span class="hunk-number" role="cell">${line.before ?? ""}</span><span class="hunk-number" role="cell">${line.after ?? ""}</span><span class="hunk-sign" role="cell">${SIGNS[line.kind]}</span><code role="cell">${line.pieces.map(
    ({ text, marked }) => (marked ? html`<mark>${text}</mark>` : text),
  )}</code></div>`;
}
