/** The camera as RViz's views: its kind, its values, and the views that are saved. */

/** @import { PropertyView } from "../../types/wire.d.ts" */
/** @import { Value } from "../../lib/view-poses.js" */
/** @import { Shelf } from "./saved.js" */

import { html, useEffect } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { EmptyState, IconButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { shownView, viewport } from "../../model/viewport.js";
import {
  askViewKinds,
  deleteOwn,
  deleteShared,
  goBack,
  moveOwn,
  moveShared,
  ownViews,
  renameOwn,
  renameShared,
  saveOwn,
  saveShared,
  setViewValue,
  sharedViews,
  useKind,
  viewBefore,
  viewKinds,
  zeroView,
} from "../../model/views.js";
import { PropertyEditor } from "../property-editor.js";
import { SavedShelf } from "./saved.js";

/** @type {Shelf} */
const SHARED = {
  id: "shared",
  views: sharedViews,
  mayChange: mayEdit,
  save: saveShared,
  rename: renameShared,
  remove: deleteShared,
  move: moveShared,
};

/** @type {Shelf} */
const OWN = {
  id: "own",
  views: ownViews,
  mayChange: { value: true },
  save: saveOwn,
  rename: renameOwn,
  remove: deleteOwn,
  move: moveOwn,
};

export function ViewsPanel() {
  useEffect(() => void askViewKinds(), []);
  if (!viewport.value || !shownView.value)
    return html`<${EmptyState} icon="views" title=${t("views.none")} />`;
  return html`<section class="views scroll" aria-label=${t("panel.views")}>
    <${Kind} kind=${shownView.value.kind} />
    <${Values} />
    <${SavedShelf} shelf=${SHARED} />
    <${SavedShelf} shelf=${OWN} />
  </section>`;
}

/** @param {{kind: string}} props */
function Kind({ kind }) {
  const kinds = viewKinds.value;
  const choose = (/** @type {any} */ event) => useKind(event.currentTarget.value);
  return html`<div class="views-kind">
    <label for="views-kind">${t("views.kind")}</label>
    <select id="views-kind" class="box" value=${kind} onChange=${choose} title=${kinds.find((one) => one.kind === kind)?.doc}>
      ${(kinds.length > 0 ? kinds : [{ kind, doc: "" }]).map((one) => html`<option key=${one.kind} value=${one.kind} title=${one.doc} selected=${one.kind === kind}>${one.kind}</option>`)}
    </select>
    <${IconButton} icon="undo" label=${t("views.back")} disabled=${!viewBefore.value} onClick=${goBack} />
    <button type="button" class="button small" title=${t("views.zero.hint")} onClick=${zeroView}>${t("views.zero")}</button>
  </div>`;
}

/** All properties of the view, three numbers of a place in one row. */
function Values() {
  const { kind, values } = shownView.value ?? { kind: "", values: {} };
  const found = viewKinds.value.find((one) => one.kind === kind);
  if (!found) return null;
  const valueNow = (/** @type {PropertyView} */ one) => values[one.name] ?? one.default;
  return html`<dl class="views-values">${propertyRows(found.properties, (name) => values[name]).map(
    ({ label, properties }) => html`<div key=${label} title=${properties[0]?.doc}>
      <dt>${label}</dt>
      <dd>${properties.map(
        (
          one,
        ) => html`<${PropertyEditor} key=${`${kind} ${one.name}`} label=${one.name} property=${one} value=${valueNow(one)}
        disabled=${false} short=${properties.length > 1} set=${(/** @type {Value} */ value) => setViewValue(one.name, value)} />`,
      )}</dd>
    </div>`,
  )}</dl>`;
}

/**
 * Properties as rows: the three numbers of a place share one.
 *
 * @param {readonly PropertyView[]} properties in their order
 * @param {(name: string) => unknown} now what another property is, on which one may depend
 * @returns {{label: string, properties: PropertyView[]}[]}
 */
export function propertyRows(properties, now) {
  /** @type {Map<string, PropertyView[]>} */
  const rows = new Map();
  for (const one of properties) {
    const values = /** @type {readonly unknown[]} */ (one.when_values);
    if (one.when !== "" && !values.includes(now(one.when))) continue;
    const label = one.name.replace(/\/[XYZ]$/, "");
    rows.set(label, [...(rows.get(label) ?? []), one]);
  }
  return [...rows].map(([label, own]) => ({ label, properties: own }));
}
