/** The window to open a robot: recent ones, served folders, examples, a new one, a pasted text. */

/** @import { FolderEntry } from "../types/wire.d.ts" */

/** @import { OpenTab } from "../model/view.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { chosenFiles } from "../lib/dropped.js";
import { parseArguments } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { Dialog, Icon } from "../lib/ui.js";
import { choosePackage, openPath } from "../model/requests.js";
import { EverythingSwitch, FolderList, useBrowser } from "./file-browser.js";
import { NewForm } from "./new-robot.js";
import { PasteForm } from "./paste-form.js";
import { RosForm } from "./ros-form.js";
import { ExampleCards, RecentList } from "./start-lists.js";
import { uploadFiles } from "./upload.js";

const ICONS = /** @type {const} */ ({
  recent: "history",
  browse: "folder",
  examples: "robot",
  new: "filePlus",
  paste: "clipboard",
  ros: "link",
});
const TABS = /** @type {OpenTab[]} */ (Object.keys(ICONS));

/** The page of the window that was used last. */
const lastTab = remembered("open.tab", /** @type {OpenTab} */ ("browse"), (value) =>
  TABS.includes(/** @type {OpenTab} */ (value)),
);

/** @param {{tab: OpenTab | undefined, onClose: () => void}} props */
export function OpenDialog({ tab, onClose }) {
  const chosen = useSignal(tab ?? lastTab.value);
  /** @param {OpenTab} next */
  const choose = (next) => {
    chosen.value = next;
    lastTab.value = next;
  };
  return html`<${Dialog} title=${t("open.title")} closeLabel=${t("close")} class="open-dialog" onClose=${onClose}>
    <div class="open-body">
      <${Tabs} chosen=${chosen.value} onChoose=${choose} />
      <div class="open-page" role="tabpanel" id="open-page" aria-labelledby=${`open-tab-${chosen.value}`}>
        <${Page} tab=${chosen.value} onClose=${onClose} />
      </div>
    </div>
  <//>`;
}

/** @param {{tab: OpenTab, onClose: () => void}} props */
function Page({ tab, onClose }) {
  if (tab === "recent") return html`<${RecentList} />`;
  if (tab === "examples") return html`<${ExampleCards} />`;
  if (tab === "new") return html`<${NewForm} />`;
  if (tab === "paste") return html`<${PasteForm} />`;
  if (tab === "ros") return html`<${RosForm} />`;
  return html`<${BrowsePage} onClose=${onClose} />`;
}

/** @param {{chosen: OpenTab, onChoose: (tab: OpenTab) => void}} props */
function Tabs({ chosen, onChoose }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  // On a phone they stand in a row that moves along.
  useEffect(() => {
    list.current
      ?.querySelector(`#open-tab-${chosen}`)
      ?.scrollIntoView({ inline: "center", block: "nearest" });
  }, [chosen]);
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const next = TABS[(TABS.indexOf(chosen) + step + TABS.length) % TABS.length] ?? chosen;
    onChoose(next);
    const button = list.current?.querySelector(`#open-tab-${next}`);
    if (button instanceof HTMLElement) button.focus();
  };
  return html`<div class="open-side">
    <div class="open-tabs" role="tablist" aria-label=${t("open.title")} ref=${list} onKeyDown=${onKeyDown}>
      ${TABS.map(
        (
          tab,
        ) => html`<button key=${tab} type="button" role="tab" id=${`open-tab-${tab}`} class="open-tab" aria-selected=${tab === chosen}
          aria-controls="open-page" tabindex=${tab === chosen ? 0 : -1} onClick=${() => onChoose(tab)}>
          <${Icon} name=${ICONS[tab]} /><span>${t(`open.tab.${tab}`)}</span></button>`,
      )}
    </div>
    <${FileButtons} />
  </div>`;
}

/** The browser's own windows for files and for a folder; what is chosen is sent to the studio. */
export function FileButtons() {
  const files = useRef(/** @type {HTMLInputElement | null} */ (null));
  const folder = useRef(/** @type {HTMLInputElement | null} */ (null));
  /** @param {any} event */
  const onChange = (event) => {
    uploadFiles(chosenFiles(event.currentTarget.files));
    event.currentTarget.value = "";
  };
  return html`<div class="file-buttons">
    <button type="button" class="button" onClick=${() => files.current?.click()}><${Icon} name="upload" />${t("upload.choose")}</button>
    <button type="button" class="button" onClick=${() => folder.current?.click()}><${Icon} name="folderOpen" />${t("upload.choose_folder")}</button>
    <p class="file-hint">${t("upload.hint")}</p>
    <input ref=${files} type="file" hidden multiple aria-label=${t("upload.choose")} onChange=${onChange} />
    <input ref=${folder} type="file" hidden webkitdirectory aria-label=${t("upload.choose_folder")} onChange=${onChange} />
  </div>`;
}

/** @param {{onClose: () => void}} props */
function BrowsePage({ onClose }) {
  const values = useSignal("");
  const browser = {
    ...useBrowser(),
    onFile: (/** @type {string} */ path) => openPath(path, parseArguments(values.value)),
  };
  const opening = useSignal("");
  /** @param {FolderEntry} entry @param {boolean} tab */
  const open = async (entry, tab) => {
    opening.value = entry.path;
    const opened = await openPath(entry.path, parseArguments(values.value), { tab });
    opening.value = "";
    if (opened && tab) onClose();
  };
  return html`<${FolderList} browser=${browser} opening=${opening.value} onOpen=${open} />
    <div class="open-foot"><label class="field"><span>${t("open.arguments")}</span>
      <input type="text" class="box wide" placeholder="name:=value" spellcheck=${false} value=${values.value}
        onInput=${(/** @type {any} */ event) => {
          values.value = event.currentTarget.value;
        }} /></label><${EverythingSwitch} browser=${browser} /></div>`;
}

/** @param {{name: string, onClose: () => void}} props */
export function PackageDialog({ name, onClose }) {
  const browser = useBrowser({ everything: true });
  // A missing package often lies where nothing is served: its folder can be written, too.
  const written = useSignal("");
  const path = written.value.trim() || browser.folder.value?.path;
  const choose = async () => {
    if (path && (await choosePackage(name, path))) onClose();
  };
  return html`<${Dialog} title=${t("package.title", { name })} closeLabel=${t("close")} class="package-dialog" onClose=${onClose}>
    <p class="dialog-text">${t("package.text", { name })}</p>
    <${FolderList} browser=${browser} opening="" onOpen=${null} />
    <label class="field"><span>${t("package.path")}</span>
      <input type="text" class="box wide" placeholder=${browser.folder.value?.path ?? ""} spellcheck=${false} value=${written.value}
        onInput=${(/** @type {any} */ event) => {
          written.value = event.currentTarget.value;
        }} /></label>
    <footer><span class="place">${path ?? ""}</span><span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" disabled=${!path} onClick=${choose}>${t("package.use")}</button></footer>
  <//>`;
}
