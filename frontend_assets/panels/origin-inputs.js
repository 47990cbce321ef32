/** What a number is made of: each input as a button that opens its row and what is behind it in turn. */

/** @import { OriginInput, Place } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { WrittenText } from "../app/written-text.js";
import { t } from "../lib/i18n.js";
import { shownNumbers } from "../lib/numbers.js";
import { baseName } from "../lib/paths.js";
import { Icon } from "../lib/ui.js";
import { site, sitesRevision } from "../model/document.js";
import { hoverSite, valueText } from "../model/origin.js";
import { degrees } from "../model/view.js";
import { PropertyRow } from "./property-row.js";

/** No robot needs more; a circle is not possible, but nothing here depends on that. */
const DEEPEST = 60;
/** Characters of a value that fit beside a name. */
const LONGEST = 24;

/**
 * @param {object} props
 * @param {readonly number[]} props.of
 * @param {readonly OriginInput[]} props.inputs all of the part
 * @param {number} [props.depth]
 */
export function Inputs({ of, inputs, depth = 0 }) {
  const open = useSignal(/** @type {number | null} */ (null));
  if (of.length === 0) return null;
  const chosen = open.value;
  const shown = chosen === null ? undefined : inputs[chosen];
  /** @param {number} at */
  const toggle = (at) => {
    open.value = open.value === at ? null : at;
  };
  return html`<div class="inputs">
    <div class="chips">
      ${of.map((at) => {
        const input = inputs[at];
        return (
          input &&
          html`<${InputChip} key=${at} input=${input} open=${chosen === at} onClick=${() => toggle(at)} />`
        );
      })}
    </div>
    ${shown && depth < DEEPEST && html`<${Opened} input=${shown} inputs=${inputs} depth=${depth} />`}
  </div>`;
}

/** @param {{id: string, open: boolean, onClick: () => void}} props opens the very text that stands at the attribute */
export function OwnButton({ id, open, onClick }) {
  const label = t(id ? "origin.edit" : "origin.edit_text");
  return html`<button type="button" class="icon-button own-button" aria-expanded=${open} aria-label=${label}
    title=${label} onClick=${onClick} ...${pointing(id)}><${Icon} name="pencil" size=${13} /></button>`;
}

/**
 * @param {object} props
 * @param {string} props.id of the text, when it is a property of its own
 * @param {{place: Place, text: string, label: string} | null} props.written the text otherwise
 */
export function OwnText({ id, written }) {
  return id ? html`<${SiteRow} id=${id} />` : html`<${WrittenLine} ...${written} />`;
}

/** @param {{input: OriginInput, open: boolean, onClick: () => void}} props */
function InputChip({ input, open, onClick }) {
  const value = shownValue(input);
  const title = `${t(`origin.kind.${input.kind}`)} ${input.name} = ${input.value}`;
  return html`<button type="button" class=${`chip input-chip`} aria-expanded=${open} title=${title}
    onClick=${onClick} ...${pointing(input.site, t("effects.parameter", { name: input.name }))}>
    <span class="input-name">${shortest(input.name)}</span>
    ${value && html`<span class="numbers">${value}</span>`}
    ${input.site && html`<${Icon} name="pencil" size=${11} />`}</button>`;
}

/**
 * @param {string} id of a site; empty: none
 * @param {string} [words] that are said when there is none
 * @returns {Record<string, () => void>} tells while it is pointed at
 */
function pointing(id, words = "") {
  const begin = () => hoverSite(id || null, id ? "" : words);
  const end = () => hoverSite(null);
  return { onPointerEnter: begin, onPointerLeave: end, onFocusIn: begin, onFocusOut: end };
}

/** @param {OriginInput} input @returns {string} as it is now, also in the middle of a drag; of a long text nothing */
function shownValue({ value, site: id }) {
  const live = (id && site(id)?.value) || null;
  const now = live && live.values.length === 0 ? live.value : value;
  const text = valueText(now, live?.widget.unit ?? "", degrees.value);
  if (text === "") return "''";
  if (text.length <= LONGEST) return text;
  return /^[\w:.-]*\//.test(text) ? `…/${baseName(text)}` : "";
}

/** @param {string} name of a key path its end */
const shortest = (name) => (name.length > 28 ? `…${name.slice(-27)}` : name);

/** @param {{input: OriginInput, inputs: readonly OriginInput[], depth: number}} props */
function Opened({ input, inputs, depth }) {
  return html`<div class="opened">
    ${
      input.site
        ? html`<${SiteRow} id=${input.site} />`
        : html`<p class="origin-line"><span class="muted">${t(`origin.kind.${input.kind}`)}</span>
        <strong class="property-name">${input.name}</strong><span class="origin-value numbers" title=${input.value}>${shownNumbers(input.value)}</span></p>
        <${WrittenLine} place=${input.place} text=${input.text} label=${input.name} />`
    }
    ${input.place.file ? html`<p class="opened-place"><${PlaceLink} place=${input.place} /></p>` : html`<p class="note">${t("origin.given")}</p>`}
    ${input.inputs.length > 0 && html`<${Inputs} of=${input.inputs} inputs=${inputs} depth=${depth + 1} />`}
  </div>`;
}

/** @param {{place: Place, text: string, label: string}} props a text that is no property, edited all the same */
function WrittenLine({ place, text, label }) {
  if (!place.file) return null;
  return html`<p class="written"><${WrittenText} place=${place} text=${text} label=${label} /></p>`;
}

/** @param {{id: string}} props the property as the panel of properties has it */
function SiteRow({ id }) {
  sitesRevision.value;
  const one = site(id);
  return one ? html`<${PropertyRow} key=${id} site=${one} />` : null;
}
