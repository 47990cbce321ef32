/** The types of ROS: all that are known, what each is made of, and texts of one's own. */

/** @import { InterfaceFaultView } from "../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { Refusal } from "../app/refusal.js";
import { t } from "../lib/i18n.js";
import { Icon, ProgressBar, SearchBox } from "../lib/ui.js";
import { connection, mayEdit } from "../model/connection.js";
import {
  askInterfaces,
  byPackage,
  draft,
  faultPlace,
  foundNames,
  interfaceName,
  interfaces,
  interfacesRefused,
  showInterface,
} from "../model/interfaces.js";
import { InterfaceDetails } from "./interfaces-details.js";
import { InterfaceForm } from "./interfaces-form.js";

/** More are not listed at once: a search that finds as many is no search. */
const FOUND_MAX = 150;

export function InterfacesPanel() {
  const words = useSignal("");
  const isThere = connection.value === "connected";
  useEffect(() => {
    if (isThere) askInterfaces();
  }, [isThere]);
  return html`<section class="panel-body interfaces" aria-label=${t("panel.interfaces")}>
    <div class="panel-bar interfaces-bar">
      <${SearchBox} label=${t("interfaces.search")} value=${words.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        words.value = text;
      }} />
      <button type="button" class="button" disabled=${!mayEdit.value} title=${t("interfaces.add.hint")} onClick=${startDraft}><${Icon} name="plus" size=${14} />${t("interfaces.add")}</button>
    </div>
    <div class="interfaces-parts"><${Names} words=${words.value} />
      ${draft.value ? html`<${InterfaceForm} key=${draft.value.name} />` : html`<${InterfaceDetails} />`}</div>
  </section>`;
}

function startDraft() {
  draft.value = { name: "my_interfaces/msg/", text: "" };
}

/** @param {{words: string}} props */
function Names({ words }) {
  const known = interfaces.value;
  if (interfacesRefused.value)
    return html`<${Refusal} sentence=${interfacesRefused.value} again=${askInterfaces} />`;
  if (!known) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const found = words.trim() === "" ? null : foundNames(known.names, words);
  return html`<nav class="interfaces-names scroll" aria-label=${t("interfaces.names")}>
    ${known.faults.length > 0 && html`<${Faults} faults=${known.faults} />`}
    ${found ? html`<${Found} names=${found} words=${words} />` : html`<${Packages} names=${known.names} own=${known.own} />`}
  </nav>`;
}

/** @param {{faults: readonly InterfaceFaultView[]}} props texts that define no type: where, and what to write */
function Faults({ faults }) {
  return html`<section class="interfaces-faults" aria-label=${t("interfaces.faults")}><h4>${t("interfaces.faults")}</h4>
    <ul>${faults.map((fault) => html`<li key=${fault.place} title=${fault.place}><${Icon} name="alert" size=${14} /><span><b>${faultPlace(fault)}</b> ${fault.reason}</span></li>`)}</ul></section>`;
}

/** @param {{names: readonly string[], words: string}} props */
function Found({ names, words }) {
  if (names.length === 0) return html`<p class="nothing">${t("filter.nothing", { words })}</p>`;
  const more = names.length - FOUND_MAX;
  return html`<ul>${names.slice(0, FOUND_MAX).map((name) => html`<${Name} key=${name} name=${name} words=${name} />`)}</ul>
    ${more > 0 && html`<p class="note padded">${t("interfaces.more", { count: more })}</p>`}`;
}

/** @param {{names: readonly string[], own: readonly string[]}} props those of one's own stand open, above */
function Packages({ names, own }) {
  const owners = new Set(own.map((name) => name.split("/")[0] ?? ""));
  const packages = [...byPackage(names)].sort(
    ([a], [b]) => Number(owners.has(b)) - Number(owners.has(a)) || a.localeCompare(b),
  );
  return packages.map(
    ([owner, types]) =>
      html`<${Package} key=${owner} owner=${owner} types=${types} isOwn=${owners.has(owner)} />`,
  );
}

/** @param {{owner: string, types: readonly string[], isOwn: boolean}} props */
function Package({ owner, types, isOwn }) {
  const holds = interfaceName.value.startsWith(`${owner}/`);
  const open = useSignal(isOwn);
  useEffect(() => {
    if (holds) open.value = true;
  }, [holds]);
  return html`<details open=${open.value} onToggle=${(/** @type {any} */ event) => {
    open.value = event.currentTarget.open;
  }}><summary><span class="interfaces-package">${owner}</span>${isOwn && html`<span class="tag">${t("interfaces.own")}</span>`}<span class="muted">${types.length}</span></summary>
    ${open.value && html`<ul>${types.map((name) => html`<${Name} key=${name} name=${name} words=${name.slice(owner.length + 1)} />`)}</ul>`}</details>`;
}

/** @param {{name: string, words: string}} props */
function Name({ name, words }) {
  const show = () => {
    draft.value = null;
    showInterface(name);
  };
  return html`<li><button type="button" class="interfaces-name" aria-pressed=${interfaceName.value === name} title=${name} onClick=${show}>${words}</button></li>`;
}
