/** Where a ROS 2 system is looked for: the fields of it, and the places that were joined of late. */

/** @import { Place } from "../model/ros.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { mayEdit } from "../model/connection.js";
import { DISTROS, DOMAIN_MAX, recentPlaces } from "../model/ros.js";

const EXAMPLE = "robot.local:7447";

/** @param {{place: Signal<Place>}} props */
export function PlaceFields({ place }) {
  const off = !mayEdit.value;
  const { address, domain, distro } = place.value;
  const change = (/** @type {Partial<Place>} */ news) => {
    place.value = { ...place.value, ...news };
  };
  return html`<div class="ros-fields">
    <label class="field ros-address"><span>${t("ros.place.address")}</span>
      <input type="text" class="box wide" data-first maxlength="300" spellcheck=${false} autocapitalize="off" list="ros-places" disabled=${off}
        placeholder=${EXAMPLE} value=${address} onInput=${(/** @type {any} */ event) => change({ address: event.currentTarget.value })} />
      <datalist id="ros-places">${[...new Set(recentPlaces.value.map((one) => one.address))].map((one) => html`<option key=${one} value=${one}></option>`)}</datalist></label>
    <label class="field"><span>${t("ros.domain")}</span>
      <input type="number" class="box" min="0" max=${DOMAIN_MAX} step="1" disabled=${off} value=${Number.isNaN(domain) ? "" : domain}
        onInput=${(/** @type {any} */ event) => change({ domain: event.currentTarget.valueAsNumber })} /></label>
    <label class="field"><span>${t("ros.distro")}</span>
      <select class="box" disabled=${off} value=${distro} onChange=${(/** @type {any} */ event) => change({ distro: event.currentTarget.value })}>
        ${DISTROS.map((one) => html`<option key=${one} value=${one}>${one}</option>`)}</select></label>
  </div>`;
}

/** @param {{onChoose: (place: Place) => void}} props */
export function RecentPlaces({ onChoose }) {
  const places = recentPlaces.value;
  if (places.length === 0 || !mayEdit.value) return null;
  return html`<div class="ros-recent" role="group" aria-label=${t("ros.recent")}>
    <span class="muted">${t("ros.recent")}</span>
    ${places.map(
      (
        place,
      ) => html`<button key=${`${place.address} ${place.domain} ${place.distro}`} type="button" class="button small" title=${t("ros.recent.hint", { ...place })}
        onClick=${() => onChoose(place)}>${place.address}<span class="muted">${t("ros.recent.domain", { domain: place.domain })}</span></button>`,
    )}
  </div>`;
}
