/** What is known of the selected link, below the tree; its opacity is this person's own. */

import { html } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { shownNumber } from "../lib/numbers.js";
import { baseName, shortPath } from "../lib/paths.js";
import { IconButton } from "../lib/ui.js";
import { documentState, robot } from "../model/document.js";
import { fadeLink, linkOpacity, onlySelected, selected, selectPart } from "../model/selection.js";
import { tellIn } from "../model/tf.js";
import { focusLink } from "../model/viewport.js";

export function LinkDetails() {
  const link = robot.value?.links.find(({ name }) => name === selected.value);
  if (!link) return null;
  const joint = robot.value?.joints.find(({ child }) => child === link.name);
  const close = () => {
    selected.value = null;
  };
  return html`<aside class="details" aria-label=${t("link.details", { name: link.name })}>
    <header><strong><button type="button" class="text-button" title=${`${link.name}\n${t("origin.show")}`}
        onClick=${() => explain(`link:${link.name}`)}>${link.name}</button></strong>
      <span class="details-buttons"><${IconButton} icon="fit" label=${t("link.focus")} onClick=${() => focusLink(link.name)} />
      <${IconButton} icon="properties" label=${t("link.values")} onClick=${showValues} />
      <${IconButton} icon="frames" label=${t("link.tell_in")} onClick=${() => tellIn(link.name)} />
      <${IconButton} icon="close" label=${t("link.deselect")} onClick=${close} /></span>
    </header>
    <dl>
      ${joint && html`<dt>${t("link.joint")}</dt><dd><button type="button" class="text-button" title=${t("origin.show")} onClick=${() => explain(`joint:${joint.name}`)}>${joint.name}</button> <span class="muted">${t(`joint.${joint.type}`)}</span></dd>`}
      ${joint?.mimic && html`<dt>${t("joint.mimic")}</dt><dd>${joint.mimic}</dd>`}
      <dt>${t("link.mass")}</dt><dd title=${link.mass_kg}>${link.mass_kg === null ? t("link.no_inertia") : `${shownNumber(link.mass_kg)} kg`}</dd>
      <dt>${t("link.shapes")}</dt><dd>${t("link.shapes.text", { visuals: link.visuals, collisions: link.collisions })}</dd>
      ${link.meshes.length > 0 && html`<dt>${t("link.meshes")}</dt><dd>${link.meshes.map((uri) => html`<span class="line" title=${uri}>${baseName(uri)}</span>`)}</dd>`}
      ${link.file && html`<dt>${t("link.place")}</dt><dd title=${shortPath(link.file, documentState.value?.root ?? "")}><${PlaceLink} place=${{ file: link.file, line: link.line ?? 0, column: 1 }} /></dd>`}
      ${link.macros.length > 0 && html`<dt>${t("link.macros")}</dt><dd>${link.macros.join(" › ")}</dd>`}
      <dt>${t("link.opacity")}</dt><dd><${Opacity} link=${link.name} /></dd>
    </dl>
  </aside>`;
}

function showValues() {
  onlySelected.value = true;
  commandById("panel.properties")?.run();
}

/** @param {string} part say where it comes from */
function explain(part) {
  selectPart(part, "", "", "displays");
  commandById("panel.origin")?.run();
}

/** @param {{link: string}} props */
function Opacity({ link }) {
  const value = linkOpacity.value.get(link) ?? 1;
  return html`<input type="range" class="slider" min="0" max="1" step="0.05" value=${value} style=${`--fill:${value * 100}%`}
    aria-label=${t("link.opacity.of", { name: link })} title=${t("only_here")}
    onInput=${(/** @type {any} */ event) => fadeLink(link, Number(event.currentTarget.value))} />`;
}
