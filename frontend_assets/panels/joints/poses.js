/** Named poses above the joints: taken with one click; one's own are kept, renamed and deleted here. */

/** @import { PoseView } from "../../types/wire.d.ts" */
/** @import { MenuItem } from "../../lib/ui.js" */

import { computed, html, useLayoutEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { remembered } from "../../lib/remembered.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { documentState, movable, position } from "../../model/document.js";
import {
  applyPose,
  deletePose,
  poses,
  renamePose,
  savePose,
  updatePose,
} from "../../model/poses.js";
import { feed, mayMove } from "../../model/ros.js";
import { showSource } from "../../model/source.js";
import { dialog } from "../../model/view.js";

/** rad or m: nearer than anybody sees, farther than files round. */
const NEAR = 1e-4;

const folded = remembered("poses.folded", false);

/** What is being written: the name of a pose that is renamed, or of a new one. @typedef {{kind: "new"} | {kind: "rename", name: string}} Writing */

export function PosesSection() {
  const writing = useSignal(/** @type {Writing | null} */ (null));
  if (movable.value.length === 0) return null;
  const list = poses.value.poses;
  const done = () => {
    writing.value = null;
  };
  const begin = () => {
    folded.value = false;
    writing.value = { kind: "new" };
  };
  const toggle = () => {
    folded.value = !folded.value;
  };
  return html`<section class="poses" aria-label=${t("poses")}>
    <header class="poses-head">
      <button type="button" class="poses-fold" aria-expanded=${!folded.value} onClick=${toggle}>
        <${Icon} name=${folded.value ? "chevronRight" : "chevronDown"} size=${14} />${t("poses")}
        ${list.length > 0 && html`<span class="numbers muted">${list.length}</span>`}</button>
      <${IconButton} icon="plus" size=${14} label=${t("poses.save")} hint=${mayEdit.value ? t("poses.save") : t("poses.viewer")}
        disabled=${!mayEdit.value} onClick=${begin} />
    </header>
    ${!folded.value && html`<${List} list=${list} writing=${writing} />`}
    ${writing.value?.kind === "new" && html`<${NameForm} label=${t("poses.name")} action=${t("poses.save.do")} name="" run=${savePose} onDone=${done} />`}
  </section>`;
}

/** @param {{list: readonly PoseView[], writing: {value: Writing | null}}} props */
function List({ list, writing }) {
  const { trouble, only_here: onlyHere } = poses.value;
  const done = () => {
    writing.value = null;
  };
  const isRenamed = (/** @type {PoseView} */ { kind, name }) =>
    kind === "own" && writing.value?.kind === "rename" && writing.value.name === name;
  return html`
    ${trouble && html`<p class="note bad poses-note" role="alert"><${Icon} name="alert" size=${13} />${trouble}</p>`}
    ${onlyHere && list.some(({ kind }) => kind === "own") && html`<p class="note poses-note"><${Icon} name="info" size=${13} />${t("poses.only_here", { reason: onlyHere })}</p>`}
    ${list.length === 0 && writing.value === null && !trouble && html`<p class="note poses-note">${t("poses.none")}</p>`}
    <ul class="poses-list">${list.map((pose) =>
      isRenamed(pose)
        ? html`<li key=${pose.key}><${NameForm} label=${t("poses.name")} action=${t("poses.rename.do")} name=${pose.name}
            run=${(/** @type {string} */ name) => renamePose(pose.name, name)} onDone=${done} /></li>`
        : html`<${PoseRow} key=${pose.key} pose=${pose} onRename=${() => {
            writing.value = { kind: "rename", name: pose.name };
          }} />`,
    )}</ul>`;
}

/** @param {{pose: PoseView, onRename: () => void}} props */
function PoseRow({ pose, onRename }) {
  // Drawn anew when this changes, not with every frame of a swing.
  const there = useMemo(() => computed(() => isThere(pose)), [pose]).value;
  const notes = notesOf(pose);
  const off = !mayMove.value;
  return html`<li class=${`pose ${there ? "active" : ""}`}>
    <button type="button" class="pose-choice" aria-pressed=${there} disabled=${off}
      title=${[off ? whyNot() : t("poses.apply", { name: pose.name }), ...notes].join("\n")} onClick=${() => applyPose(pose.key)}>
      <span class="pose-mark">${there && html`<${Icon} name="check" size=${13} />`}</span>
      <span class="pose-name">${pose.name}</span>
      <span class="pose-from muted">${fromText(pose)}</span>
      ${notes.length > 0 && html`<span class="pose-warn"><${Icon} name="alert" size=${12} /><span class="hidden-words">${notes.join(" ")}</span></span>`}
    </button>
    <${MenuButton} class="icon-button narrow" label=${t("poses.menu", { name: pose.name })} items=${() => menuItems(pose, onRename)}>
      <${Icon} name="dots" size=${13} /><//>
  </li>`;
}

/** @returns {string} why no pose can be taken */
function whyNot() {
  const { source } = feed.value;
  if (source === "sliders") return t("poses.viewer");
  return t("source.led", { topic: t(`source.${source}`) });
}

/** @param {PoseView} pose @returns {boolean} the joints stand in it now, as far as they can */
function isThere({ positions, beyond }) {
  const names = Object.keys(positions).filter((name) => !beyond.includes(name));
  return (
    names.length > 0 &&
    names.every((name) => Math.abs(position(name).value - (positions[name] ?? 0)) < NEAR)
  );
}

/** @param {PoseView} pose @returns {string} where it comes from */
function fromText({ kind, group, file }) {
  if (kind === "own") return "";
  return kind === "srdf" && group ? group : baseName(file);
}

/** @param {PoseView} pose @returns {string[]} what of it this robot cannot do, in words */
function notesOf({ unknown, unknown_count: count, beyond }) {
  const more = count > unknown.length ? " …" : "";
  return [
    ...(count > 0 ? [t("poses.unknown", { names: unknown.join(", ") + more })] : []),
    ...(beyond.length > 0 ? [t("poses.beyond", { names: beyond.join(", ") })] : []),
  ];
}

/** @param {PoseView} pose @param {() => void} onRename @returns {MenuItem[]} */
function menuItems(pose, onRename) {
  const { kind, name, file, line } = pose;
  const place = {
    label: t("poses.show"),
    icon: "source",
    run: () => showSource(file, line || 1),
  };
  if (kind !== "own") return [place];
  const locked = !mayEdit.value;
  const remove = () => {
    dialog.value = {
      kind: "confirm",
      title: t("poses.delete"),
      text: t("poses.delete.text", {
        name,
        file: shortPath(poses.value.path, documentState.value?.root ?? ""),
      }),
      action: t("poses.delete"),
      danger: true,
      run: () => void deletePose(name),
    };
  };
  return [
    {
      label: t("poses.update"),
      icon: "reload",
      disabled: locked,
      run: () => void updatePose(name),
    },
    { label: t("poses.rename"), icon: "pencil", disabled: locked, run: onRename },
    { label: t("poses.delete"), icon: "trash", disabled: locked, run: remove },
  ];
}

/**
 * @param {{label: string, action: string, name: string, run: (name: string) => Promise<string>,
 *   onDone: () => void}} props `run` says why it was not done; empty: it was
 */
function NameForm({ label, action, name, run, onDone }) {
  const typed = useSignal(name);
  const busy = useSignal(false);
  const error = useSignal("");
  const box = useRef(/** @type {HTMLInputElement | null} */ (null));
  // Before the next key press, which belongs to the name.
  useLayoutEffect(() => {
    box.current?.focus();
    box.current?.select();
    box.current?.form?.scrollIntoView({ block: "nearest" });
  }, []);
  const submit = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (typed.value.trim() === "" || busy.value) return;
    busy.value = true;
    error.value = await run(typed.value.trim());
    busy.value = false;
    if (error.value === "") onDone();
    else box.current?.select();
  };
  const cancel = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    onDone();
  };
  return html`<form class="poses-form" aria-label=${action} onSubmit=${submit} onKeyDown=${cancel}>
    <input ref=${box} type="text" class="box wide" maxlength="100" required spellcheck=${false} aria-label=${label} placeholder=${label}
      value=${typed.value} aria-invalid=${error.value !== ""} onInput=${(
        /** @type {any} */ event,
      ) => {
        typed.value = event.currentTarget.value;
        error.value = "";
      }} />
    <button type="submit" class="button small primary" disabled=${busy.value || typed.value.trim() === ""}>${action}</button>
    <${IconButton} icon="close" size=${14} label=${t("cancel")} onClick=${onDone} />
    ${error.value && html`<p class="note bad" role="alert"><${Icon} name="error" size=${13} />${error.value}</p>`}
  </form>`;
}
