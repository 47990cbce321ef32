/** Where the selected part comes from: its place, the macros that led there, what each number is made of. */

/** @import { OriginAttribute, OriginCall, OriginCause, PartOrigin, Place } from "../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { PlaceLink } from "../app/place-link.js";
import { Refusal } from "../app/refusal.js";
import { t } from "../lib/i18n.js";
import { baseName, shortPath } from "../lib/paths.js";
import { EmptyState, Icon } from "../lib/ui.js";
import { documentState, robot, showingLastGood } from "../model/document.js";
import {
  askOrigin,
  byElement,
  followOrigin,
  isComputed,
  origin,
  referredPart,
  valueText,
} from "../model/origin.js";
import { part, selection, selectPart, splitKey } from "../model/selection.js";
import { degrees } from "../model/view.js";
import { EffectLine } from "./effect-line.js";
import { Inputs, OwnButton, OwnText } from "./origin-inputs.js";

export function OriginPanel() {
  useEffect(followOrigin, []);
  return html`<section class="panel-body origin" aria-label=${t("panel.origin")}>
    <${Content} />
    <${EffectLine} />
  </section>`;
}

function Content() {
  const key = part.value;
  const known = origin.value;
  if (!key) {
    const title = t(robot.value ? "origin.none" : "urdf.none");
    return html`<${EmptyState} icon="origin" title=${title} />`;
  }
  if (known?.part !== key)
    return html`<${Heading} part=${key} /><p class="note padded">${t("loading")}</p>`;
  if (!known.origin)
    return html`<${Heading} part=${key} /><${Refusal} sentence=${known.refused} again=${() => askOrigin(key)} />`;
  return html`<${Heading} part=${key} />
    <div class="scroll" key=${key}>
      ${showingLastGood.value && html`<p class="note padded"><${Icon} name="info" size=${13} />${t("last_good")}</p>`}
      <${Way} origin=${known.origin} />
      ${byElement(known.origin.attributes).map(
        ({ element, attributes }) => html`<${Element} key=${element} origin=${known.origin}
          path=${element} attributes=${attributes} />`,
      )}
      ${known.origin.is_cut && html`<p class="note padded">${t("origin.cut")}</p>`}
    </div>`;
}

/** @param {{part: string}} props the part, and the other one that belongs to it: a link's joint, a joint's link */
function Heading({ part: key }) {
  const [kind, name] = splitKey(key);
  const joint = robot.value?.joints.find((one) =>
    kind === "joint" ? one.name === name : one.child === name,
  );
  const link = kind === "joint" ? joint?.child : name;
  const pair = ["link", "joint"].includes(kind) && joint && link;
  return html`<header class="panel-bar origin-head">
    ${
      pair
        ? html`<div class="segments" role="group" aria-label=${t("origin.part")}>
      <${Choice} part=${`link:${link}`} on=${kind === "link"} icon="box" name=${link} />
      <${Choice} part=${`joint:${joint.name}`} on=${kind === "joint"} icon="joints" name=${joint.name} />
    </div>`
        : html`<strong class="origin-name" title=${name}><${Icon} name="box" size=${14} />${kind === "other" ? t("origin.other") : name}</strong>`
    }
  </header>`;
}

/** @param {{part: string, on: boolean, icon: string, name: string}} props */
function Choice({ part: key, on, icon, name }) {
  return html`<button type="button" class="segment" aria-pressed=${on} title=${name}
    onClick=${() => selectPart(key, "", "", "origin")}><${Icon} name=${icon} size=${13} /><span>${name}</span></button>`;
}

/** @param {{origin: PartOrigin}} props how the run came to the part */
function Way({ origin: { place, include_chain, calls, causes, inputs } }) {
  return html`<ol class="way" aria-label=${t("origin.way")}>
    ${include_chain.map((one, at) => html`<${Included} file=${include_chain[at + 1]?.file ?? place.file} at=${one} />`)}
    ${causes.map((cause) => html`<${Cause} cause=${cause} inputs=${inputs} />`)}
    ${calls.map((call, at) => html`<${Call} key=${at} call=${call} inputs=${inputs} />`)}
    <${Step} icon="source" words=${t("origin.written")} place=${place} />
  </ol>`;
}

/** @param {{icon: string, words: string, place: Place}} props */
function Step({ icon, words, place }) {
  const title = shortPath(place.file, documentState.value?.root ?? "");
  return html`<li title=${title}><${Icon} name=${icon} size=${13} /><span>${words}</span><${PlaceLink} place=${place} /></li>`;
}

/** @param {{file: string, at: Place}} props a file, and where it is included */
function Included({ file, at }) {
  const root = documentState.value?.root ?? "";
  return html`<li title=${`${shortPath(file, root)}\n${shortPath(at.file, root)}`}><${Icon} name="includes" size=${13} />
    <span><${PlaceLink} place=${{ file, line: 1, column: 1 }} words=${baseName(file)} /> ${t("origin.included")}</span><${PlaceLink} place=${at} /></li>`;
}

/** @param {{cause: OriginCause, inputs: PartOrigin["inputs"]}} props */
function Cause({ cause, inputs }) {
  const words = t(
    cause.tag === "xacro:unless" ? "origin.unless" : (CAUSES[cause.tag] ?? "origin.if"),
  );
  return html`<li><${Icon} name="branch" size=${13} /><span>${words} <code>${cause.text}</code></span>
    <${PlaceLink} place=${cause.place} />
    <div class="below"><${Inputs} of=${cause.inputs} inputs=${inputs} /></div></li>`;
}

/** @type {Record<string, string>} */
const CAUSES = { "xacro:include": "origin.chosen", "xacro:call": "origin.chosen" };

/** @param {{call: OriginCall, inputs: PartOrigin["inputs"]}} props */
function Call({ call, inputs }) {
  return html`<li><${Icon} name="macro" size=${13} />
    <span>${t("origin.macro")} <${PlaceLink} place=${call.defined_at} words=${call.macro} /></span>
    <${PlaceLink} place=${call.called_at} />
    ${call.arguments.length > 0 && html`<div class="below"><${Inputs} of=${call.arguments} inputs=${inputs} /></div>`}
  </li>`;
}

/** @param {{origin: PartOrigin, path: string, attributes: OriginAttribute[]}} props */
function Element({ origin: { inputs, part: key }, path, attributes }) {
  const name = path === "" ? `<${splitKey(key)[0]}>` : path.replaceAll("/", " › ");
  return html`<section class="origin-element" aria-label=${path || name}>
    <h3>${name}</h3>
    ${attributes.map((one) => html`<${Attribute} key=${one.attribute} of=${one} inputs=${inputs} part=${key} />`)}
  </section>`;
}

/** @param {{of: OriginAttribute, inputs: PartOrigin["inputs"], part: string}} props */
function Attribute({ of, inputs, part: key }) {
  const row = useRef(/** @type {HTMLElement | null} */ (null));
  const editing = useSignal(false);
  const wanted = selection.value;
  const sought =
    wanted?.part === key && wanted.element === of.element && wanted.attribute === of.attribute;
  useEffect(() => {
    if (sought) row.current?.scrollIntoView({ block: "center" });
  }, [sought, wanted]);
  const value = valueText(of.value, of.unit, degrees.value);
  const computed = isComputed(of.text);
  const other = referredPart(of);
  const written =
    of.attribute && !of.site ? { place: of.place, text: of.text, label: of.attribute } : null;
  return html`<div ref=${row} class=${`origin-attribute ${sought ? "chosen" : ""}`} role="group"
      aria-label=${of.attribute || t("origin.text")}>
    <div class="origin-line">
      <span class="property-name" title=${of.attribute}>${of.attribute || t("origin.text")}</span>
      ${
        other
          ? html`<span class="origin-value"><button type="button" class="text-button" title=${t("origin.show")}
        onClick=${() => selectPart(other, "", "", "origin")}>${value}</button></span>`
          : html`<span class="origin-value numbers" title=${of.value}>${value}</span>`
      }
      ${(of.site || written) && html`<${OwnButton} id=${of.site} open=${editing.value} onClick=${() => (editing.value = !editing.value)} />`}
      <${PlaceLink} place=${of.place} />
    </div>
    ${computed && html`<code class="origin-text">${of.text}</code>`}
    ${editing.value && html`<${OwnText} id=${of.site} written=${written} />`}
    <${Inputs} of=${of.inputs} inputs=${inputs} />
  </div>`;
}
