/** The windows of config files: choose one to open, say where to save one, and what of one is only kept. */

/** @import { RvizConfigOpened, RvizFileEntry, RvizFiles } from "../types/wire.d.ts" */

import { html, useEffect, useId, useRef, useSignal } from "vendor/preact.js";
import { language, t } from "../lib/i18n.js";
import { timeAgo } from "../lib/times.js";
import { Dialog, EmptyState, Icon, IconButton, moveFocus, ProgressBar } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import { documentState } from "../model/document.js";
import {
  configFiles,
  configStem,
  downloadConfig,
  lossGroups,
  openConfigFile,
  openConfigOf,
  RVIZ,
  rvizConfig,
  STUDIO,
  saveConfig,
  undoConfig,
} from "../model/rviz-configs.js";
import { notify } from "../model/view.js";

/** @param {{onClose: () => void}} props */
export function OpenConfigDialog({ onClose }) {
  const found = useSignal(/** @type {RvizFiles | null} */ (null));
  const path = useSignal("");
  const busy = useSignal(false);
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => {
    if (mayManage.value)
      configFiles().then((files) => {
        found.value = files;
      });
  }, []);
  /** @param {() => Promise<unknown>} work */
  const during = async (work) => {
    busy.value = true;
    await work();
    busy.value = false;
  };
  /** @param {Event} event */
  const open = (event) => {
    event.preventDefault();
    if (path.value.trim() !== "") during(() => openConfigFile(path.value.trim()));
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && moveFocus(list.current, step)) event.preventDefault();
  };
  const files = found.value?.files ?? [];
  return html`<${Dialog} title=${t("rviz.open.title")} closeLabel=${t("close")} class="config-dialog" onClose=${onClose}>
    <p class="dialog-text">${t("rviz.open.text")}</p>
    ${
      mayManage.value &&
      html`<form class="config-path" onSubmit=${open}>
      <input type="text" class="box wide" data-first aria-label=${t("rviz.path")} placeholder=${"package://my_robot/rviz/view.rviz"} spellcheck=${false} maxlength="4000"
        value=${path.value} onInput=${(/** @type {any} */ event) => {
          path.value = event.currentTarget.value;
        }} />
      <button type="submit" class="button primary" disabled=${busy.value || path.value.trim() === ""}>${t("rviz.open.do")}</button></form>
    ${!found.value && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
    ${found.value && files.length === 0 && html`<${EmptyState} icon="history" title=${t("rviz.none")} />`}
    <ul class="entries config-files" ref=${list} onKeyDown=${onKeyDown} aria-label=${t("rviz.open.title")}>
      ${files.map(
        (file) =>
          html`<${FileRow} key=${file.path} file=${file} onOpen=${() => during(() => openConfigFile(file.path))} onForget=${async () => {
            found.value = (await configFiles(file.path)) ?? found.value;
          }} />`,
      )}
    </ul>`
    }
    <footer><${ChooseButton} busy=${busy.value} onChoose=${(/** @type {File} */ file) => during(() => openConfigOf(file))} />
      <span class="push"></span><button type="button" class="button" onClick=${onClose}>${t("cancel")}</button></footer>
  <//>`;
}

/** @param {{file: RvizFileEntry, onOpen: () => void, onForget: () => void}} props */
function FileRow({ file, onOpen, onForget }) {
  const { is_there, name, path, time_s } = file;
  const when =
    time_s === null
      ? t("rviz.in_package")
      : is_there
        ? timeAgo(time_s * 1000, Date.now(), language.value)
        : t("recent.gone");
  return html`<li class=${`entry ${is_there ? "" : "off"}`}>
    <button type="button" class="entry-main" disabled=${!is_there} onClick=${onOpen} title=${path}>
      <${Icon} name=${is_there ? (time_s === null ? "package" : "history") : "alert"} />
      <span class="entry-two"><span class="entry-name">${name}</span><span class="entry-path"><bdi>${path}</bdi></span></span>
      <span class="entry-when">${when}</span>
    </button>
    ${time_s !== null && html`<${IconButton} icon="close" size=${14} label=${t("recent.forget", { name })} onClick=${onForget} />`}
  </li>`;
}

/** @param {{busy: boolean, onChoose: (file: File) => void}} props a file of this browser's machine */
function ChooseButton({ busy, onChoose }) {
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  /** @param {any} event */
  const take = (event) => {
    const [file] = /** @type {HTMLInputElement} */ (event.currentTarget).files ?? [];
    event.currentTarget.value = "";
    if (file) onChoose(file);
  };
  return html`<input type="file" accept=".rviz,.yaml,.yml" hidden ref=${box} aria-label=${t("upload.choose")} onChange=${take} />
    <button type="button" class="button" disabled=${busy} onClick=${() => box.current?.click()}><${Icon} name="upload" />${t("upload.choose")}</button>`;
}

/** @param {{onClose: () => void}} props */
export function SaveConfigDialog({ onClose }) {
  const folder = useSignal("");
  const name = useSignal("");
  const ending = useSignal(
    /** @type {typeof RVIZ | typeof STUDIO} */ (
      rvizConfig.value.name.endsWith(STUDIO) ? STUDIO : RVIZ
    ),
  );
  const isThere = useSignal("");
  const changed = useSignal(false);
  const rviz2 = useSignal(true);
  const hint = useId();
  useEffect(() => {
    name.value = proposedName();
    const [, place] = /^(.*)[/\\][^/\\]+$/.exec(rvizConfig.value.path) ?? [];
    if (place) folder.value = place;
    else
      configFiles().then((files) => {
        folder.value = files?.folder ?? "";
      });
  }, []);
  const converts = () => rvizConfig.value.rviz1 && rviz2.value;
  const path = `${folder.value.trim().replace(/[/\\]+$/, "")}/${name.value.trim()}${ending.value}`;
  /** @param {Event} event */
  const save = async (event) => {
    event.preventDefault();
    if (name.value.trim() === "") return;
    const saved = await saveConfig(path, { replace: isThere.value === path, rviz2: converts() });
    if (!saved) return;
    isThere.value = saved.isThere ? path : "";
    changed.value = saved.changed;
    if (saved.isThere) return;
    onClose();
    notify(t("rviz.saved", { file: saved.path }));
  };
  const download = () => {
    onClose();
    downloadConfig(ending.value, { rviz2: converts() });
  };
  return html`<${Dialog} title=${t("rviz.save.title")} closeLabel=${t("close")} class="config-dialog" onClose=${onClose}>
    <form class="open-form" onSubmit=${save}>
      <fieldset class="config-kinds"><legend>${t("rviz.kind")}</legend>
        ${[RVIZ, STUDIO].map(
          (one) =>
            html`<label key=${one} class="form-check"><input type="radio" name="config-kind" checked=${ending.value === one} onChange=${() => {
              ending.value = /** @type {typeof RVIZ | typeof STUDIO} */ (one);
            }} /><span><strong>${one}</strong> ${t(one === RVIZ ? "rviz.kind.rviz" : "rviz.kind.studio")}</span></label>`,
        )}</fieldset>
      ${
        rvizConfig.value.rviz1 &&
        html`<label class="form-check"><input type="checkbox" checked=${rviz2.value} onChange=${(
          /** @type {any} */ event,
        ) => {
          rviz2.value = event.currentTarget.checked;
        }} /><span>${t("rviz.to_rviz2")}</span></label>`
      }
      <label class="form-row"><span>${t("rviz.name")}</span>
        <input type="text" class="box wide" data-first maxlength="100" spellcheck=${false} value=${name.value} onInput=${(
          /** @type {any} */ event,
        ) => {
          name.value = event.currentTarget.value;
        }} /></label>
      <label class="form-row"><span>${t("new.folder")}</span>
        <input type="text" class="box wide" maxlength="3000" spellcheck=${false} aria-describedby=${hint} value=${folder.value} onInput=${(
          /** @type {any} */ event,
        ) => {
          folder.value = event.currentTarget.value;
        }} /></label>
      <p id=${hint} class=${`form-hint ${isThere.value === path ? "bad" : ""}`} role="status">
        <${Icon} name=${isThere.value === path ? "alert" : "filePlus"} size=${14} /><span class="form-path">${isThere.value === path ? t(changed.value ? "rviz.changed" : "rviz.is_there", { file: path }) : path}</span></p>
      <footer><button type="button" class="button" onClick=${download}><${Icon} name="download" />${t("rviz.download")}</button><span class="push"></span>
        <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
        <button type="submit" class=${`button ${isThere.value === path ? "danger" : "primary"}`} disabled=${name.value.trim() === ""}>${t(isThere.value === path ? "rviz.replace" : "command.save")}</button></footer>
    </form>
  <//>`;
}

/** @returns {string} without its ending */
function proposedName() {
  const name = rvizConfig.value.name || (documentState.value?.title ?? "view");
  return configStem(name).split(".")[0] || "view";
}

/** @param {{opened: RvizConfigOpened, onClose: () => void}} props what was taken of a file, and what is only kept */
export function OpenedConfigDialog({ opened, onClose }) {
  const { displays, losses, name, tools, views } = opened;
  const groups = lossGroups(losses);
  const undo = () => {
    onClose();
    undoConfig();
  };
  return html`<${Dialog} title=${t("rviz.opened.title", { name })} closeLabel=${t("close")} class="config-dialog" onClose=${onClose}>
    <p class="dialog-text">${t("rviz.opened.taken", { displays, tools, views })}</p>
    ${
      groups.length > 0 &&
      html`<p class="dialog-text">${t("rviz.opened.kept")}</p>
    <ul class="config-losses" tabindex="0" aria-label=${t("rviz.opened.kept")}>${groups.map(
      ({ reason, classes }) => html`<li key=${reason}><strong>${t(`rviz.loss.${reason}`)}</strong>
        <ul>${classes.map((one) => html`<li key=${one}>${one}</li>`)}</ul></li>`,
    )}</ul>`
    }
    <footer><button type="button" class="button" disabled=${!rvizConfig.value.undo} onClick=${undo}><${Icon} name="undo" />${t("command.rviz_undo")}</button>
      <span class="push"></span><button type="button" class="button primary" data-first onClick=${onClose}>${t("close")}</button></footer>
  <//>`;
}
