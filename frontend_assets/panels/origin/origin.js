/** Where the selected part comes from: its place, the macros that led there, what each number is made of. */

/** @import { OriginAttribute, OriginCall, OriginCause, OriginInput, PartOrigin, Place } from "../../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { niceStep, parseNumber, shownNumbers } from "../../lib/numbers.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { TextBox } from "../../lib/slider.js";
import { EmptyState, Icon } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import {
  documentState,
  robot,
  showingLastGood,
  site,
  sitesRevision,
} from "../../model/document.js";
import {
  askOrigin,
  byElement,
  followOrigin,
  hoverSite,
  isComputed,
  origin,
  referredPart,
  valueText,
} from "../../model/origin.js";
import { ask } from "../../model/requests.js";
import { part, selection, selectPart, splitKey } from "../../model/selection.js";
import { degrees, notify } from "../../model/view.js";
import { PlaceLink, Refusal } from "../parts.js";
import { EffectLine, PropertyRow } from "../properties/row.js";

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
function Inputs({ of, inputs, depth = 0 }) {
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
function OwnButton({ id, open, onClick }) {
  const label = t(id ? "origin.edit" : "origin.edit_text");
  return html`<button type="button" class="icon-button own-button" aria-expanded=${open} aria-label=${label}
    title=${label} onClick=${onClick} ...${pointing(id)}><${Icon} name="pencil" size=${13} /></button>`;
}

/**
 * @param {object} props
 * @param {string} props.id of the text, when it is a property of its own
 * @param {{place: Place, text: string, label: string} | null} props.written the text otherwise
 */
function OwnText({ id, written }) {
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

let gestures = 0;

/**
 * Any text of an attribute, edited where it stands in its file, as an editor would.
 *
 * @param {{place: Place, text: string, label: string}} props `place` is where the text begins, inside its quotes
 */
function WrittenText({ place, text, label }) {
  const readOnly = documentState.value?.read_only.includes(place.file);
  const number = parseNumber(text);
  const step = number === null ? undefined : niceStep(0, Math.abs(number) * 4 || 2);
  /** @param {string} typed */
  const onWrite = (typed) => {
    if (typed !== text) write(place, text, typed);
  };
  return html`<${TextBox} class=${number === null ? "wide" : "number"} label=${label} text=${text}
    number=${number} step=${step} disabled=${!mayEdit.value || readOnly} onWrite=${onWrite} />`;
}

/** @param {Place} place @param {string} old @param {string} text */
async function write(place, old, text) {
  const known = await ask({ type: "get_text", file: place.file });
  if (known?.type !== "text") return;
  const change = replacement(known.text, place, old, text);
  if (!change) return notify(t("origin.moved"), { bad: true });
  gestures += 1;
  const gesture = `written ${gestures}`;
  await ask({
    type: "edit_text",
    file: known.file,
    version: known.version,
    changes: [change],
    gesture,
  });
}

/** @type {Record<string, string>} */
const ESCAPES = {
  "&": "&amp;",
  "<": "&lt;",
  '"': "&quot;",
  "'": "&apos;",
  "\n": "&#10;",
  "\t": "&#9;",
};

/**
 * @param {string} text with LF at the end of each line
 * @param {{line: number, column: number}} place from 1, in characters
 * @returns {number} UTF-16 offset, -1 when there is no such place
 */
export function offsetAt(text, { line, column }) {
  let start = 0;
  for (let n = 1; n < line; n += 1) {
    start = text.indexOf("\n", start) + 1;
    if (start === 0) return -1;
  }
  const end = text.indexOf("\n", start);
  const characters = [...text.slice(start, end < 0 ? text.length : end)];
  if (column < 1 || column > characters.length + 1) return -1;
  return start + characters.slice(0, column - 1).join("").length;
}

/**
 * @param {string} file the whole text
 * @param {{line: number, column: number}} place where the attribute's text begins
 * @param {string} old what must stand there
 * @param {string} text that takes its place
 * @returns {{start: number, end: number, text: string} | null} null: something else stands there by now
 */
export function replacement(file, place, old, text) {
  const start = offsetAt(file, place);
  const quote = file[start - 1] ?? "";
  if (start < 1 || (quote !== '"' && quote !== "'")) return null;
  const end = file.indexOf(quote, start);
  if (end < 0 || plain(file.slice(start, end)) !== old) return null;
  return { start, end, text: escaped(text, quote) };
}

/** @param {string} text @param {string} quote around it @returns {string} */
function escaped(text, quote) {
  return text.replace(/[&<"'\n\t]/g, (one) =>
    (one === '"' || one === "'") && one !== quote ? one : (ESCAPES[one] ?? one),
  );
}

/** @param {string} raw @returns {string} references resolved, as XML reads an attribute */
function plain(raw) {
  return raw
    .replace(/[\n\t]/g, " ")
    .replace(/&(?:#(\d+)|#x([\da-fA-F]+)|(\w+));/g, (whole, decimal, hex, name) => {
      if (decimal) return String.fromCodePoint(Number(decimal));
      if (hex) return String.fromCodePoint(Number.parseInt(hex, 16));
      return Object.entries(ESCAPES).find(([, one]) => one === `&${name};`)?.[0] ?? whole;
    });
}
