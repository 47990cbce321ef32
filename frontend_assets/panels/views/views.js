/** The camera as RViz's views: its kind, its values, and the views that are saved. */

/** @import { PropertyView } from "../../types/wire.d.ts" */
/** @import { Value } from "../../lib/view-poses.js" */
/** @import { Shelf } from "./saved.js" */

import { html, useEffect } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { niceStep, parseNumber, shownNumber } from "../../lib/numbers.js";
import { PickBox } from "../../lib/pick-box.js";
import { propertyRows } from "../../lib/property-rows.js";
import { TextBox } from "../../lib/slider.js";
import { EmptyState, IconButton, Switch } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { framesNow } from "../../model/live-displays.js";
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
      <dd>${properties.map((one) => html`<${Editor} key=${`${kind} ${one.name}`} property=${one} value=${valueNow(one)} short=${properties.length > 1} />`)}</dd>
    </div>`,
  )}</dl>`;
}

/** @param {{property: PropertyView, value: Value, short: boolean}} props */
function Editor({ property, value, short }) {
  const { name, kind, choices } = property;
  const set = (/** @type {Value} */ one) => setViewValue(name, one);
  if (kind === "switch")
    return html`<${Switch} label=${name} checked=${value === true} onChange=${set} />`;
  if (kind === "choice")
    return html`<select class="box" aria-label=${name} value=${String(value)} onChange=${(/** @type {any} */ event) => set(event.currentTarget.value)}>
      ${choices.map((one) => html`<option key=${one} value=${one} selected=${one === value}>${one}</option>`)}</select>`;
  if (kind === "frame")
    return html`<${PickBox} label=${name} text=${String(value)} onWrite=${set} none=${t("views.frame.none")}
      choices=${async () => ["<Fixed Frame>", ...(await framesNow()).map((one) => one.name)]} />`;
  return html`<${NumberEditor} property=${property} value=${Number(value)} set=${set} short=${short} />`;
}

/** @param {{property: PropertyView, value: number, set: (value: number) => void, short: boolean}} props */
function NumberEditor({ property: { name, low, high, unit }, value, set, short }) {
  const step = niceStep(0, Math.max(Math.abs(value), 0.01) * 4);
  /** @param {string} typed */
  const write = (typed) => {
    const number = parseNumber(typed);
    if (number !== null) set(Math.min(Math.max(number, low ?? number), high ?? number));
  };
  return html`<${TextBox} class=${`number ${short ? "third" : "narrow"}`} label=${name} text=${shownNumber(value)} number=${value} step=${step} onWrite=${write} />
    ${!short && unit && html`<span class="unit">${unit}</span>`}`;
}
