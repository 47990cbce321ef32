/**
 * The window to open a robot: recent ones, served folders, examples, a new one, a pasted text,
 * one that is described in the ROS 2 system.
 */

/** @import { FolderEntry, WireRobots } from "../types/wire.d.ts" */
/** @import { OpenTab } from "../model/view.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { parseArguments } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { Dialog, Icon, ProgressBar } from "../lib/ui.js";
import { openRecorded } from "../model/recording.js";
import { choosePackage, openNamed, openPath } from "../model/requests.js";
import { findRobots, openFromRos, ros } from "../model/ros.js";
import { EverythingSwitch, FolderList, useBrowser } from "./file-browser.js";
import { nameFault, PlaceFields, robotOf, usePlace } from "./place-form.js";
import { ExampleCards, Picture, RecentList } from "./start-card.js";
import { FileButtons, openText } from "./uploads.js";

/** A box for a text that is to be opened as an untitled robot. */
function PasteForm() {
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

const TEMPLATES = /** @type {const} */ (["rover", "arm", "blank"]);

/** A new robot out of a template, in a package of its own. */
function NewForm() {
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

const TOPIC = "/robot_description";
const PARAMETER = "robot_description";

/** @typedef {{value: string}} Text */

/** A robot whose description is told on the wire, to be opened. */
function RosForm() {
  const found = useSignal(/** @type {WireRobots | null} */ (null));
  const topic = useSignal(TOPIC);
  const node = useSignal("");
  const busy = useSignal(false);
  const error = useSignal("");
  const look = async () => {
    busy.value = true;
    const answer = await findRobots();
    busy.value = false;
    error.value = typeof answer === "string" ? answer : "";
    found.value = typeof answer === "string" ? null : answer;
    const [first] = found.value?.topics ?? [];
    if (first) topic.value = first;
  };
  useEffect(() => {
    look();
  }, []);
  /** @param {Event} event */
  const open = async (event) => {
    event.preventDefault();
    busy.value = true;
    const name = node.value.trim();
    error.value = await openFromRos(
      name ? { node: name, parameter: PARAMETER } : { topic: topic.value.trim() },
    );
    busy.value = false;
  };
  const ready = !busy.value && (topic.value.trim() !== "" || node.value.trim() !== "");
  return html`<form class="open-form ros-form" onSubmit=${open}>
    <p class="open-text">${t("ros.open.text")}</p>
    ${busy.value && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
    <${Field} label=${t("ros.open.topic")} text=${topic} list="ros-topics" choices=${found.value?.topics ?? []} />
    <${Field} label=${t("ros.open.node")} text=${node} list="ros-nodes" choices=${found.value?.nodes ?? []} />
    ${found.value?.topics.length === 0 && html`<p class="ros-note"><${Icon} name="info" size=${13} /><span>${t("ros.open.none", { address: ros.value.endpoint, domain: ros.value.domain })}</span></p>`}
    ${error.value && html`<p class="ros-note bad" role="alert"><${Icon} name="error" size=${13} /><span>${error.value}</span></p>`}
    <footer><span class="form-note">${t("ros.open.note")}</span><span class="push"></span>
      <button type="button" class="button" disabled=${busy.value} onClick=${look}><${Icon} name="reload" />${t("ros.open.again")}</button>
      <button type="submit" class="button primary" disabled=${!ready}>${t("ros.open.do")}</button></footer>
  </form>`;
}

/** @param {{label: string, text: Text, list: string, choices: readonly string[]}} props */
function Field({ label, text, list, choices }) {
  return html`<label class="field"><span>${label}</span>
    <input type="text" class="box wide" list=${list} maxlength="300" spellcheck=${false} value=${text.value}
      onInput=${(/** @type {any} */ event) => {
        text.value = event.currentTarget.value;
      }} />
    <datalist id=${list}>${choices.map((one) => html`<option key=${one} value=${one}></option>`)}</datalist></label>`;
}

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
    const opened =
      entry.kind === "bag"
        ? await openRecorded(entry.path)
        : await openPath(entry.path, parseArguments(values.value), { tab });
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
