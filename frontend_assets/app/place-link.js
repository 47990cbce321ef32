/** A place in a file as a link: it leads to the line in the source. */

/** @import { Place } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { placeText } from "../lib/paths.js";
import { showSource } from "../model/source.js";

/** @param {{place: Place | null | undefined, words?: string}} props `words` in place of `name.xacro:12` */
export function PlaceLink({ place, words }) {
  const text = words ?? placeText(place ?? null);
  if (!place?.line) return text ? html`<span class="place">${text}</span>` : null;
  return html`<span class="place"><button type="button" class="text-button" title=${t("property.show_source")}
    onClick=${() => showSource(place.file, place.line, place.column || 1)}>${text}</button></span>`;
}
