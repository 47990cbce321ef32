/**
 * The widgets that turn a property: box and slider, switch, choice, vector, expression, text; and
 * what an argument can be.
 */

/** @import { Signal } from "vendor/preact.js" */
/** @import { SiteView } from "../../types/wire.d.ts" */

import { effect, html, signal, useEffect, useSignal } from "vendor/preact.js";
import {
  completions,
  isExpression,
  shownText,
  splitVector,
  writtenText,
} from "../../lib/expressions.js";
import { t } from "../../lib/i18n.js";
import {
  formatNumber,
  niceStep,
  parseNumber,
  shownNumber,
  toDegrees,
  toRadians,
} from "../../lib/numbers.js";
import { Slider, TextBox } from "../../lib/slider.js";
import { Switch } from "../../lib/ui.js";
import { connection, mayEdit, role } from "../../model/connection.js";
import { allSites, namesBeside, robot, siteOrder } from "../../model/document.js";
import { degrees } from "../../model/view.js";
import { send } from "../../model/wire.js";

/**
 * @typedef {object} Writer sends the newest text of one site, one request at a time
 * @property {Signal<string | null>} attempt what was written last; it stands in the source even when
 *   the run with it failed and the studio still tells of the one before
 * @property {(text: string, options?: {held?: boolean}) => void} write `held`: by a drag that goes on
 * @property {(stepped?: boolean) => Promise<void>} end of the gesture, unless it was one step by a key;
 *   fulfilled when the last text was answered
 */

/**
 * @typedef {object} EditorProps
 * @property {"head" | "below"} part beside the name, or below it
 * @property {SiteView} site
 * @property {string} text what is edited: the site's, or the argument that was passed
 * @property {Writer} writer
 * @property {boolean} invalid
 */

/** @param {EditorProps} props */
export function Editor(props) {
  const kind = editorOf(props.site, props.text);
  const drawn = EDITORS[kind][props.part];
  return drawn ? html`<${drawn} ...${props} />` : null;
}

/** Characters of name and text that fit side by side. */
const ONE_LINE = 30;

/** @param {SiteView} site @returns {readonly string[]} what it can be, as far as that is known */
function choicesOf({ kind, name, widget }) {
  if (widget.choices.length > 0) return widget.choices;
  return (kind === "arg" && argumentChoices.value.get(name)) || [];
}

/** @param {SiteView} site @param {string} text @returns {keyof typeof EDITORS} */
function editorOf(site, text) {
  const { name, widget } = site;
  const long = name.length + shownText(text).length > ONE_LINE;
  if (widget.kind === "vector" && splitVector(text).length > 1) return "vector";
  if (isExpression(text)) return long ? "longText" : "expression";
  if (widget.kind === "switch" && isTruthWord(text)) return "switch";
  if (["choice", "text"].includes(widget.kind) && choicesOf(site).length > 0) return "choice";
  if (widget.kind === "slider" && parseNumber(text) !== null) return "number";
  return long ? "longText" : "text";
}

/** @param {string} text */
const isTruthWord = (text) => /^(true|false|0|1)$/i.test(text.trim());

/** @param {SiteView} site @returns {boolean} the file computes `${...}`, and a number is wanted */
const wraps = ({ kind, widget }) => kind !== "yaml" && ["slider", "vector"].includes(widget.kind);

/** @param {Writer} writer @param {string} text @param {boolean} [stepped] more of the same gesture may follow */
function write(writer, text, stepped = false) {
  writer.write(text);
  if (!stepped) writer.end();
}

/** @param {SiteView} site @returns {boolean} it is shown in degrees */
const inDegrees = ({ widget }) => widget.unit === "rad" && degrees.value;

/**
 * @param {SiteView} site
 * @param {number} value in the file's unit
 * @returns {{lower: number, upper: number, step: number, value: number, toFile: (shown: number) => number}} as shown
 */
function scaleOf(site, value) {
  const { minimum, maximum, step } = site.widget;
  const guess = value === 0 ? 1 : Math.abs(value) * 4;
  const lower = minimum ?? (value < 0 || (maximum ?? 1) <= 0 ? -guess : 0);
  const upper = maximum ?? Math.max(guess, lower + 1e-9);
  const grid = step ?? niceStep(lower, upper);
  if (!inDegrees(site)) return { lower, upper, step: grid, value, toFile: (shown) => shown };
  const deg = { lower: toDegrees(lower), upper: toDegrees(upper) };
  const nice = Math.min(niceStep(deg.lower, deg.upper), 1);
  return { ...deg, step: nice, value: toDegrees(value), toFile: toRadians };
}

/** @param {SiteView} site @param {string} text @param {number} value @returns {string} degrees, else as written */
function boxText(site, text, value) {
  return inDegrees(site) ? shownNumber(toDegrees(value)) : text.trim();
}

/** @param {EditorProps} props */
function NumberHead({ site, text, writer, invalid }) {
  const value = parseNumber(text) ?? 0;
  const scale = scaleOf(site, value);
  /** @param {string} typed @param {{stepped: boolean}} options */
  const onWrite = (typed, { stepped }) => {
    const number = parseNumber(typed);
    const fileText =
      number === null
        ? writtenText(typed, wraps(site))
        : inDegrees(site)
          ? formatNumber(toRadians(number))
          : typed.trim();
    write(writer, fileText, stepped);
  };
  return html`<${TextBox} class="number" label=${site.name} text=${boxText(site, text, value)} number=${scale.value}
      step=${scale.step} disabled=${!mayEdit.value} invalid=${invalid} onWrite=${onWrite} complete=${completer(site)} />
    <${Unit} site=${site} />`;
}

/** @param {SiteView} site @returns {((typed: string) => string[]) | undefined} of names that its file may compute with */
const completer = ({ id, kind }) =>
  kind === "yaml" ? undefined : (typed) => completions(typed, namesBeside(id));

/** @param {EditorProps} props */
function NumberSlider({ site, text, writer }) {
  const value = parseNumber(text) ?? 0;
  const { lower, upper, step, value: shown, toFile } = scaleOf(site, value);
  const unit = inDegrees(site) ? "°" : site.widget.unit;
  return html`<${Slider} label=${t("property.slider", { name: site.name })} min=${lower} max=${upper} step=${step}
    value=${shown} text=${`${shownNumber(shown)} ${unit}`.trim()} disabled=${!mayEdit.value}
    onMove=${(/** @type {number} */ moved) => writer.write(formatNumber(toFile(moved)), { held: true })} onEnd=${writer.end} />`;
}

/** @param {{site: SiteView}} props */
function Unit({ site }) {
  const { unit } = site.widget;
  if (unit !== "rad") return html`<span class="unit">${unit}</span>`;
  const label = t(degrees.value ? "angles.to_radians" : "angles.to_degrees");
  const toggle = () => {
    degrees.value = !degrees.value;
  };
  return html`<button type="button" class="unit unit-button" aria-label=${label} title=${label} onClick=${toggle}>
    ${degrees.value ? "°" : "rad"}</button>`;
}

/** @param {EditorProps} props */
function ExpressionBox({ site, text, writer, invalid }) {
  const whole = shownText(text) !== text;
  /** @param {string} typed */
  const onWrite = (typed) => write(writer, writtenText(typed, whole || wraps(site)));
  return html`<${TextBox} class="expression" label=${site.name} text=${shownText(text)} disabled=${!mayEdit.value}
    invalid=${invalid} onWrite=${onWrite} complete=${completer(site)} /><${Unit} site=${site} />`;
}

/** @param {EditorProps} props */
function SwitchHead({ site, text, writer }) {
  const on = /^(true|1)$/i.test(text.trim());
  return html`<${Switch} label=${site.name} checked=${on} disabled=${!mayEdit.value}
    onChange=${(/** @type {boolean} */ next) => write(writer, likeWord(text, next))} />`;
}

/** @param {string} text @param {boolean} on @returns {string} the other word, in the spelling of the file */
function likeWord(text, on) {
  const word = text.trim();
  if (/^[01]$/.test(word)) return on ? "1" : "0";
  return /^[A-Z]/.test(word) ? (on ? "True" : "False") : String(on);
}

const OTHER = "\u0000other";

/** @param {EditorProps} props */
function ChoiceHead(props) {
  const { site, text, writer } = props;
  const typing = useSignal(false);
  const choices = choicesOf(site);
  const all = choices.includes(text) ? choices : [text, ...choices];
  /** @param {any} event */
  const choose = ({ currentTarget: { value } }) => {
    if (value === OTHER) typing.value = true;
    else write(writer, value);
  };
  useEffect(() => {
    typing.value = false;
  }, [text]);
  if (typing.value) return html`<${PlainText} ...${props} />`;
  return html`<select class="box choice" aria-label=${site.name} value=${text} disabled=${!mayEdit.value} title=${text} onChange=${choose}>
    ${all.map((choice) => html`<option key=${choice} value=${choice}>${choice === "" ? "''" : choice}</option>`)}
    ${site.kind === "arg" && html`<option value=${OTHER}>${t("launch.other")}</option>`}
  </select>${site.widget.unit && html`<span class="unit">${site.widget.unit}</span>`}`;
}

const AXES = ["x", "y", "z", "w"];
const TURNS = ["roll", "pitch", "yaw"];

/** @param {SiteView} site @param {number} count @returns {string[]} names of the numbers of a vector */
function partNames({ name }, count) {
  if (/rpy$/i.test(name) && count === 3) return TURNS;
  if (/(rgba?|colou?r)$/i.test(name)) return ["r", "g", "b", "a"].slice(0, count);
  return Array.from({ length: count }, (_, at) => (count <= 4 ? (AXES[at] ?? "") : String(at + 1)));
}

/** @param {EditorProps} props */
function VectorBoxes({ site, text, writer, invalid }) {
  const parts = splitVector(text);
  const names = partNames(site, parts.length);
  return html`<div class=${`vector of-${parts.length}`}>
    ${parts.map(
      (
        part,
        at,
      ) => html`<${VectorPart} key=${at} site=${site} part=${part} name=${names[at] ?? ""} invalid=${invalid}
      onPart=${(/** @type {string} */ fileText, /** @type {boolean} */ stepped) =>
        write(writer, parts.map((one, n) => (n === at ? fileText : one)).join(" "), stepped)} />`,
    )}
  </div>`;
}

/**
 * @param {{site: SiteView, part: string, name: string, invalid: boolean,
 *   onPart: (text: string, stepped: boolean) => void}} props
 */
function VectorPart({ site, part, name, invalid, onPart }) {
  const number = parseNumber(part);
  const shown = number === null ? shownText(part) : boxText(site, part, number);
  const step = number === null ? undefined : vectorStep(site);
  /** @param {string} typed @param {{stepped: boolean}} options */
  const onWrite = (typed, { stepped }) => {
    const value = parseNumber(typed);
    const inFile =
      value !== null && inDegrees(site)
        ? formatNumber(toRadians(value))
        : writtenText(typed, site.kind !== "yaml");
    // A bare blank would make one number two; inside braces it does no harm.
    onPart(inFile.includes(" ") && !inFile.startsWith("${") ? `\${${inFile}}` : inFile, stepped);
  };
  return html`<label class="vector-part"><span>${name}</span>
    <${TextBox} class=${number === null ? "expression" : "number"} label=${`${site.name} ${name}`} text=${shown}
      number=${number !== null && inDegrees(site) ? toDegrees(number) : number} step=${step} invalid=${invalid}
      disabled=${!mayEdit.value} onWrite=${onWrite} /></label>`;
}

/** @param {SiteView} site @returns {number} what an arrow key is worth in a vector */
function vectorStep(site) {
  if (inDegrees(site)) return 1;
  return site.widget.step ?? 0.01;
}

/** @param {EditorProps} props what is turned stands below */
function UnitOnly({ site }) {
  return html`<${Unit} site=${site} />`;
}

/** @param {EditorProps} props */
function PlainText({ site, text, writer, invalid }) {
  return html`<${TextBox} class="wide" label=${site.name} text=${text} disabled=${!mayEdit.value} invalid=${invalid}
    onWrite=${(/** @type {string} */ typed) => write(writer, writtenText(typed, wraps(site)))} />
    ${site.widget.unit && html`<${Unit} site=${site} />`}`;
}

/** @param {EditorProps} props a text that needs the whole width, below its name */
function LongText({ site, text, writer, invalid }) {
  const wrapped = shownText(text) !== text;
  const names = isExpression(text) ? "expression wide" : "wide";
  return html`<${TextBox} class=${names} label=${site.name} text=${shownText(text)} disabled=${!mayEdit.value} invalid=${invalid}
    onWrite=${(/** @type {string} */ typed) => write(writer, writtenText(typed, wrapped || wraps(site)))} />`;
}

/** @typedef {(props: EditorProps) => unknown} Part */
/** @type {{[kind in "number" | "expression" | "switch" | "choice" | "vector" | "text" | "longText"]: {head: Part, below?: Part}}} */
const EDITORS = {
  number: { head: NumberHead, below: NumberSlider },
  expression: { head: ExpressionBox },
  switch: { head: SwitchHead },
  choice: { head: ChoiceHead },
  vector: { head: UnitOnly, below: VectorBoxes },
  text: { head: PlainText },
  longText: { head: UnitOnly, below: LongText },
};

/** So long nothing came or went before it is asked for again. */
const SETTLE_MS = 250;

/** Choices by the name of the argument. @type {import("vendor/preact.js").Signal<ReadonlyMap<string, readonly string[]>>} */
const argumentChoices = signal(new Map());

/** Keep `argumentChoices` true while somebody looks. @returns {() => void} the end of looking */
export function followChoices() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  const end = effect(() => {
    const ids = siteOrder.value;
    const asks =
      connection.value === "connected" && role.value === "presenter" && robot.value !== null;
    clearTimeout(later);
    if (asks && ids.length > 0) later = setTimeout(ask, SETTLE_MS);
  });
  return () => {
    clearTimeout(later);
    end();
  };
}

async function ask() {
  if (![...allSites().values()].some(({ kind }) => kind === "arg")) return;
  const answer = await send({ type: "get_arguments", path: "" }).catch(() => null);
  if (answer?.type !== "arguments") return;
  const offered = answer.arguments.filter(({ widget }) => widget.choices.length > 0);
  argumentChoices.value = new Map(offered.map(({ name, widget }) => [name, widget.choices]));
}
