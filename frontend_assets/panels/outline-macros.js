/** The macros of a robot's files: what they take, what they say of themselves, where they are called. */

/** @import { OutlineMacro, Parameter } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { t } from "../lib/i18n.js";
import { LongList } from "../lib/long-list.js";
import { callOf } from "../lib/outline.js";
import { Icon } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { shownFile, showSource, writeSnippet } from "../model/source.js";

/** @typedef {{key: string, macro: OutlineMacro}} Keyed */

/** @param {{macros: OutlineMacro[], filter: string}} props */
export function MacroList({ macros, filter }) {
  const open = useSignal("");
  if (macros.length === 0)
    return html`<p class="nothing">${filter ? t("filter.nothing", { words: filter }) : t("outline.no_macros")}</p>`;
  const rows = macros.map((macro, at) => ({
    macro,
    key: `${macro.name} ${macro.place.file} ${macro.place.line} ${at}`,
  }));
  /** @param {string} key */
  const toggle = (key) => {
    open.value = open.value === key ? "" : key;
  };
  return html`<div role="list" class="outline-macros"><${LongList} items=${rows} keyOf=${(/** @type {Keyed} */ { key }) => key} row="var(--row)"
    isKept=${(/** @type {Keyed} */ { key }) => key === open.value}
    draw=${(/** @type {Keyed} */ { key, macro }) =>
      html`<${MacroRow} key=${key} macro=${macro} open=${open.value === key} toggle=${() => toggle(key)} />`} /></div>`;
}

/** @param {{macro: OutlineMacro, open: boolean, toggle: () => void}} props */
function MacroRow({ macro, open, toggle }) {
  const { name, calls } = macro;
  return html`<div role="listitem" class=${`outline-macro ${open ? "open" : ""}`}>
    <button type="button" class="outline-name" aria-expanded=${open} onClick=${toggle}>
      <${Icon} name="macro" size=${14} /><span>${name}</span>
      <span class="muted numbers" title=${t("language.calls", { count: calls })}>${calls}×</span>
    </button>
    ${open && html`<${MacroDetails} macro=${macro} />`}
  </div>`;
}

/** @param {{macro: OutlineMacro}} props */
function MacroDetails({ macro }) {
  const { doc, parameters, place, called_at: places, calls } = macro;
  const insert = () => {
    const { text, stops } = callOf(macro);
    writeSnippet(text, stops);
  };
  const hint = shownFile.value === "" ? t("outline.insert_hint") : t("outline.insert");
  return html`<div class="outline-details">
    ${doc && html`<p class="outline-doc">${doc}</p>`}
    ${parameters.length > 0 && html`<ul class="outline-params" aria-label=${t("outline.parameters")}>${parameters.map((one) => html`<${ParameterLine} key=${one.name} parameter=${one} />`)}</ul>`}
    <p class="outline-calls">${calls === 0 ? t("outline.never_called") : t("outline.called_at")} ${places.map((one, at) => html`${at > 0 && " · "}<${PlaceLink} place=${one} />`)}</p>
    <div class="row">
      <button type="button" class="button small" onClick=${() => showSource(place.file, place.line, place.column)}><${Icon} name="definition" size=${14} />${t("outline.definition")}</button>
      ${mayEdit.value && html`<button type="button" class="button small" disabled=${shownFile.value === ""} title=${hint} onClick=${insert}><${Icon} name="plus" size=${14} />${t("outline.insert")}</button>`}
    </div>
  </div>`;
}

/** @param {{parameter: Parameter}} props */
function ParameterLine({ parameter: { name, kind, default: text, forwards } }) {
  const words = kind === "value" ? defaultWords(text, forwards) : t(`outline.${kind}`);
  return html`<li><code>${name}</code> <span class="muted">${words}</span></li>`;
}

/** @param {string | null} text @param {boolean} forwards */
function defaultWords(text, forwards) {
  if (forwards) return text ? t("outline.forwards_or", { text }) : t("outline.forwards");
  return text === null ? t("outline.required") : t("outline.default", { text: text || "''" });
}
