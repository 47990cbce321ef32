/** The windows that make a package, or add a node, an interface or a launch file to one. */

/** @import { AddToPackage, CreatePackage } from "../types/wire.d.ts" */

import { html, useId, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon } from "../lib/ui.js";
import { chosenPackage, tellEdited, workspaces } from "../model/programs.js";
import { ask } from "../model/requests.js";
import { showSource } from "../model/source.js";
import { CodeLine } from "./code-line.js";
import { nameFault } from "./place-form.js";

/** @typedef {import("../types/wire.d.ts").PackageEdited} PackageEdited */

/** @param {PackageEdited} edited show what was made */
function show(edited) {
  tellEdited(edited);
  if (edited.opened) showSource(edited.opened, 1);
}

/** @param {{sentences: readonly string[], onClose: () => void}} props what is left to a person */
function ByHand({ sentences, onClose }) {
  return html`<div class="open-form"><p class="dialog-text">${t("packages.by_hand")}</p>
    <ul class="packages-by-hand">${sentences.map((one) => html`<li key=${one}>${one}</li>`)}</ul>
    <footer><span class="push"></span><button type="button" class="button primary" data-first onClick=${onClose}>${t("close")}</button></footer></div>`;
}

/** @param {{label: string, value: string, onInput: (value: string) => void, hint?: string, first?: boolean, bad?: boolean}} props */
function TextRow({ label, value, onInput, hint = "", first = false, bad = false }) {
  const id = useId();
  return html`<label class="form-row"><span>${label}</span>
      <input type="text" class="box wide" data-first=${first || null} value=${value} spellcheck=${false} autocomplete="off" aria-invalid=${bad} aria-describedby=${hint ? id : null}
        onInput=${(/** @type {any} */ event) => onInput(event.currentTarget.value)} /></label>
    ${hint && html`<p id=${id} class=${`form-hint ${bad ? "bad" : ""}`} role="status"><${Icon} name=${bad ? "alert" : "info"} size=${14} /><span>${hint}</span></p>`}`;
}

/** @template {string} T @param {{label: string, value: T, choices: readonly (readonly [T, string])[], onChange: (value: T) => void}} props */
function ChoiceRow({ label, value, choices, onChange }) {
  return html`<label class="form-row"><span>${label}</span>
    <select class="box wide" value=${value} onChange=${(/** @type {any} */ event) => onChange(event.currentTarget.value)}>
      ${choices.map(([one, words]) => html`<option key=${one} value=${one}>${words}</option>`)}</select></label>`;
}

/** @typedef {Required<Pick<CreatePackage, "name" | "folder" | "build_type" | "contents" | "node_name" | "library_name" | "license" | "description">> & {dependencies: string}} PackageForm */

/** @param {{onClose: () => void}} props */
export function NewPackageDialog({ onClose }) {
  const folders = workspaces.value?.run_folders ?? [];
  const form = useSignal(
    /** @type {PackageForm} */ ({
      name: "",
      folder: folders[0] ?? "",
      contents: "nodes",
      build_type: "ament_python",
      dependencies: "rclpy",
      node_name: "",
      library_name: "",
      license: "Apache-2.0",
      description: "",
    }),
  );
  const edited = useSignal(/** @type {PackageEdited | null} */ (null));
  const busy = useSignal(false);
  const set = (/** @type {Partial<PackageForm>} */ some) => {
    form.value = { ...form.value, ...some };
  };
  const { value } = form;
  const fault = value.name === "" ? "" : nameFault(value.name);
  const make = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (busy.value || value.name === "" || fault) return;
    busy.value = true;
    const dependencies = value.dependencies.split(/[\s,]+/).filter(Boolean);
    const answer = await ask({ type: "create_package", ...value, dependencies });
    busy.value = false;
    if (answer?.type !== "package_edited") return;
    chosenPackage.value = `${answer.files[0] ?? ""}`.replace(/\/package\.xml$/, "");
    show(answer);
    if (answer.by_hand.length > 0) edited.value = answer;
    else onClose();
  };
  if (edited.value)
    return html`<${Dialog} title=${edited.value.label} closeLabel=${t("close")} onClose=${onClose}><${ByHand} sentences=${edited.value.by_hand} onClose=${onClose} /><//>`;
  return html`<${Dialog} title=${t("packages.new")} closeLabel=${t("close")} class="new-package" onClose=${onClose}>
    <form class="open-form" onSubmit=${make}>
      <div class="place-fields">
        <${TextRow} label=${t("packages.form.name")} first value=${value.name} bad=${fault !== ""} hint=${fault ? t(fault) : t("packages.form.name.hint")} onInput=${(/** @type {string} */ name) => set({ name })} />
        <${ChoiceRow} label=${t("packages.form.folder")} value=${value.folder} choices=${folders.map((one) => [one, one])} onChange=${(/** @type {string} */ folder) => set({ folder })} />
        <${ChoiceRow} label=${t("packages.form.contents")} value=${value.contents} choices=${[
          ["nodes", t("packages.form.contents.nodes")],
          ["interfaces", t("packages.form.contents.interfaces")],
          ["description", t("packages.form.contents.description")],
        ]} onChange=${(/** @type {PackageForm["contents"]} */ contents) => set({ contents })} />
        ${value.contents === "nodes" && html`<${NodeRows} value=${value} set=${set} />`}
        ${value.contents !== "description" && html`<${AboutRows} value=${value} set=${set} />`}
        <div class="form-line"><${CodeLine} code=${createLine(value)} /></div>
      </div>
      <footer><span class="push"></span>
        <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
        <button type="submit" class="button primary" disabled=${busy.value || value.name === "" || fault !== ""}>${t("packages.make")}</button></footer>
    </form>
  <//>`;
}

/** @typedef {{value: PackageForm, set: (some: Partial<PackageForm>) => void}} RowsProps */

/** @param {RowsProps} props */
function NodeRows({ value, set }) {
  return html`<${ChoiceRow} label=${t("packages.form.build_type")} value=${value.build_type} choices=${[
    ["ament_python", "ament_python"],
    ["ament_cmake", "ament_cmake"],
  ]} onChange=${(/** @type {PackageForm["build_type"]} */ build_type) => set({ build_type })} />
    <${TextRow} label=${t("packages.form.node_name")} value=${value.node_name} onInput=${(/** @type {string} */ node_name) => set({ node_name })} />
    <${TextRow} label=${t("packages.form.library_name")} value=${value.library_name} onInput=${(/** @type {string} */ library_name) => set({ library_name })} />`;
}

/** @param {RowsProps} props */
function AboutRows({ value, set }) {
  return html`<${TextRow} label=${t("packages.form.dependencies")} value=${value.dependencies} onInput=${(/** @type {string} */ dependencies) => set({ dependencies })} />
    <${TextRow} label=${t("packages.form.license")} value=${value.license} onInput=${(/** @type {string} */ license) => set({ license })} />
    <${TextRow} label=${t("packages.form.description")} value=${value.description} onInput=${(/** @type {string} */ description) => set({ description })} />`;
}

/** @param {PackageForm} form @returns {string} the same as it is typed for ROS */
export function createLine({
  name,
  build_type,
  contents,
  dependencies,
  node_name,
  library_name,
  license,
}) {
  const type = contents === "nodes" ? build_type : "ament_cmake";
  // The name first: a list of dependencies would take it for one of them.
  const words = ["ros2 pkg create", name || "NAME", `--build-type ${type}`];
  if (contents === "nodes" && node_name) words.push(`--node-name ${node_name}`);
  if (contents === "nodes" && library_name) words.push(`--library-name ${library_name}`);
  if (contents !== "description" && license) words.push(`--license ${license}`);
  if (contents !== "description" && dependencies.trim())
    words.push(
      `--dependencies ${dependencies
        .trim()
        .split(/[\s,]+/)
        .join(" ")}`,
    );
  return words.join(" ");
}

const TEMPLATES = /** @type {const} */ ([
  "empty",
  "publisher",
  "subscriber",
  "timer",
  "service_server",
  "service_client",
  "action_server",
  "action_client",
  "parameters",
]);

/** @param {{what: AddToPackage["what"], folder: string, name: string, onClose: () => void}} props `folder`, `name`: of the package */
export function AddToPackageDialog({ what, folder, name: of, onClose }) {
  const name = useSignal("");
  const text = useSignal("");
  const template = useSignal(/** @type {NonNullable<AddToPackage["template"]>} */ ("publisher"));
  const edited = useSignal(/** @type {PackageEdited | null} */ (null));
  const busy = useSignal(false);
  const isInterface = what === "message" || what === "service" || what === "action";
  const title = t(`packages.add.${what}`);
  const make = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (busy.value || name.value === "") return;
    busy.value = true;
    const command = { type: /** @type {const} */ ("add_to_package"), package: folder, what };
    const answer = await ask({
      ...command,
      name: name.value,
      text: text.value,
      template: template.value,
    });
    busy.value = false;
    if (answer?.type !== "package_edited") return;
    show(answer);
    if (answer.by_hand.length > 0) edited.value = answer;
    else onClose();
  };
  if (edited.value)
    return html`<${Dialog} title=${edited.value.label} closeLabel=${t("close")} onClose=${onClose}><${ByHand} sentences=${edited.value.by_hand} onClose=${onClose} /><//>`;
  return html`<${Dialog} title=${title} closeLabel=${t("close")} class="add-to-package" onClose=${onClose}>
    <form class="open-form" onSubmit=${make}>
      <p class="dialog-text">${t("packages.add.to", { name: of })}</p>
      <div class="place-fields">
        <${TextRow} label=${t("packages.form.name")} first value=${name.value} hint=${t(`packages.add.${isInterface ? "type" : what}.hint`)} onInput=${(
          /** @type {string} */ now,
        ) => {
          name.value = now;
        }} />
        ${
          what === "node" &&
          html`<${ChoiceRow} label=${t("packages.template")} value=${template.value} choices=${TEMPLATES.map((one) => [one, t(`packages.template.${one}`)])} onChange=${(
            /** @type {typeof TEMPLATES[number]} */ now,
          ) => {
            template.value = now;
          }} />`
        }
        ${
          isInterface &&
          html`<label class="form-row tall"><span>${t("packages.form.fields")}</span>
          <textarea class="box packages-fields" rows="7" spellcheck=${false} placeholder=${t(`packages.add.${what}.sample`)} value=${text.value} onInput=${(
            /** @type {any} */ event,
          ) => {
            text.value = event.currentTarget.value;
          }}></textarea></label>`
        }
      </div>
      <footer><span class="push"></span>
        <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
        <button type="submit" class="button primary" disabled=${busy.value || name.value === ""}>${t("packages.make")}</button></footer>
    </form>
  <//>`;
}
