/** Tool Properties: the tools of the 3D view and what is set of each, as in RViz's panel of that name. */

/** @import { ToolKindView, ToolView } from "../../types/wire.d.ts" */

import { html, signal, useEffect } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { counts, settingRows } from "../../lib/live-displays.js";
import { TextBox } from "../../lib/slider.js";
import { Icon, IconButton, MenuButton, ProgressBar } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import {
  addTool,
  mayTake,
  needToolKinds,
  removeTool,
  renameTool,
  setToolProperty,
  takeTool,
  toolInHand,
  toolKinds,
  tools,
  toolValue,
} from "../../model/tools.js";
import { PropertyEditor } from "../property-editor.js";

/** Ids of tools, and `id path` of groups of properties, that are unfolded. @type {import("vendor/preact.js").Signal<ReadonlySet<string>>} */
const unfolded = signal(new Set());

/** @param {string} id */
function toggle(id) {
  const now = new Set(unfolded.value);
  if (!now.delete(id)) now.add(id);
  unfolded.value = now;
}

export function ToolsPanel() {
  useEffect(() => void needToolKinds(), []);
  const isKnown = tools.value.length > 0 && toolKinds.value.size > 0;
  return html`<section class="panel-body tools" aria-label=${t("panel.tools")}>
    <div class="panel-bar">
      <${MenuButton} class="button small" label=${t("tools.add")} disabled=${!mayEdit.value || !isKnown} items=${kindItems}>
        <${Icon} name="plus" size=${14} /><span>${t("tools.add")}</span><//>
    </div>
    ${!mayEdit.value && html`<p class="note panel-said">${t("tools.viewer")}</p>`}
    ${
      isKnown
        ? html`<div class="scroll tools-list">${tools.value.map((tool) => html`<${Tool} key=${tool.id} tool=${tool} />`)}</div>`
        : html`<${ProgressBar} label=${t("tools.loading")} done=${0} total=${0} />`
    }
  </section>`;
}

const kindItems = () =>
  [...toolKinds.value.values()].map(({ kind, name, icon }) => ({
    label: name,
    icon,
    run: () => void addAndUnfold(kind),
  }));

/** @param {string} kind what was added is there to be set */
async function addAndUnfold(kind) {
  const before = new Set(tools.value.map(({ id }) => id));
  await addTool(kind);
  const added = tools.value.find(({ id }) => !before.has(id));
  if (added) unfolded.value = new Set(unfolded.value).add(added.id);
}

/** @param {{tool: ToolView}} props */
function Tool({ tool }) {
  const kind = toolKinds.value.get(tool.kind);
  const isOpen = unfolded.value.has(tool.id);
  const isLast =
    tool.kind === "Interact" && tools.value.filter((one) => one.kind === "Interact").length < 2;
  const isInHand = toolInHand.value?.id === tool.id;
  return html`<section class="tool" aria-label=${tool.name}>
    <header>
      <button type="button" class="tool-fold" aria-expanded=${isOpen} title=${kind?.doc} onClick=${() => toggle(tool.id)}>
        <${Icon} name=${isOpen ? "chevronDown" : "chevronRight"} size=${14} /><${Icon} name=${tool.icon} size=${15} /><h3>${tool.name}</h3></button>
      ${isFirst(tool) && html`<kbd title=${t("tools.key", { key: tool.key })}>${tool.key}</kbd>`}
      <${IconButton} icon="hand" label=${t("tools.take", { name: tool.name })} pressed=${isInHand} disabled=${!mayTake(tool)}
        onClick=${() => takeTool(tool.id)} />
      <${IconButton} icon="trash" label=${t("tools.remove", { name: tool.name })} disabled=${!mayEdit.value || isLast}
        hint=${isLast ? t("tools.stays") : t("tools.remove", { name: tool.name })} onClick=${() => void removeTool(tool.id)} />
    </header>
    ${isOpen && kind && html`<${Properties} tool=${tool} kind=${kind} />`}
  </section>`;
}

/** The key is that of the first of a kind. @param {ToolView} tool */
const isFirst = (tool) => tools.value.find(({ kind }) => kind === tool.kind)?.id === tool.id;

/** @param {{tool: ToolView, kind: ToolKindView}} props */
function Properties({ tool, kind }) {
  const byName = new Map(kind.properties.map((one) => [one.name, one]));
  const counting = kind.properties.filter((one) =>
    counts(one, byName, (name) => toolValue(tool, name)),
  );
  const rows = settingRows(counting, (path) => unfolded.value.has(`${tool.id} ${path}`));
  return html`<div class="tool-properties">
    <p class="muted">${kind.doc}</p>
    <div class="tool-row"><span class="tool-label">${t("tools.name.label")}</span>
      <${TextBox} class="tool-name" label=${t("tools.name", { name: tool.name })} text=${tool.name} disabled=${!mayEdit.value}
        onWrite=${(/** @type {string} */ typed) => typed.trim() && void renameTool(tool.id, typed)} /></div>
    ${rows.map(
      ({
        path,
        label,
        depth,
        folds,
        property,
      }) => html`<div key=${path} class="tool-row" style=${`--depth:${depth}`}>
        ${folds ? html`<${Fold} id=${`${tool.id} ${path}`} label=${label} doc=${property?.doc ?? label} />` : html`<span class="tool-label" title=${property?.doc}>${label}</span>`}
        ${
          property &&
          html`<${PropertyEditor} label=${`${tool.name}: ${path}`} property=${property} disabled=${!mayEdit.value} topics=${path === "Topic" ? tool.publishes : ""}
            value=${toolValue(tool, path) ?? property.default} set=${(
              /** @type {boolean | number | string} */ value,
            ) => void setToolProperty(tool.id, path, value)} />`
        }</div>`,
    )}
    ${rows.length === 0 && html`<p class="muted">${t("tools.no_properties")}</p>`}
  </div>`;
}

/** @param {{id: string, label: string, doc: string}} props */
function Fold({ id, label, doc }) {
  const isOpen = unfolded.value.has(id);
  return html`<button type="button" class="tool-fold tool-label" aria-expanded=${isOpen} title=${doc} onClick=${() => toggle(id)}>
    <${Icon} name=${isOpen ? "chevronDown" : "chevronRight"} size=${13} /><span>${label}</span></button>`;
}
