/** What the robot weighs: its links in a table, their sum, and where its centre of mass is now. */

/** @import { MassOrder, MassRow } from "../../model/masses.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { LongList } from "../../lib/long-list.js";
import { allDigits, shownMeasure, shownNumber } from "../../lib/numbers.js";
import { baseName } from "../../lib/paths.js";
import { EmptyState, Icon, IconButton, MenuButton, ProgressBar, SearchBox } from "../../lib/ui.js";
import { robot } from "../../model/document.js";
import { followFrames, linkPoses } from "../../model/frames.js";
import {
  askMasses,
  centreOfMass,
  followMasses,
  isOddDensity,
  isPossible,
  masses,
  massesRefused,
  massRows,
  massText,
  matchingMasses,
  sortedMasses,
  sumOf,
} from "../../model/masses.js";
import { hovered, selected, selection, selectPart } from "../../model/selection.js";
import { notify } from "../../model/view.js";
import { PlaceLink, Refusal } from "../parts.js";

export function MassesPanel() {
  const filter = useSignal("");
  const order = useSignal(/** @type {MassOrder} */ ("link"));
  useEffect(followFrames, []);
  useEffect(followMasses, []);
  const found = masses.value;
  const body = found
    ? html`<${Weighed} masses=${found} filter=${filter} order=${order} />`
    : html`<${Waiting} />`;
  return html`<section class="panel-body masses" aria-label=${t("panel.masses")}>${body}</section>`;
}

function Waiting() {
  if (!robot.value) return html`<${EmptyState} icon="masses" title=${t("urdf.none")} />`;
  if (massesRefused.value)
    return html`<${Refusal} sentence=${massesRefused.value} again=${askMasses} />`;
  return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
}

/** @param {{masses: NonNullable<typeof masses.value>, filter: Signal<string>, order: Signal<MassOrder>}} props */
function Weighed({ masses: found, filter, order }) {
  if (found.length === 0)
    return html`<${EmptyState} icon="masses" title=${t("masses.none")}><p>${t("masses.none.hint")}</p><//>`;
  const rows = massRows(found, robot.value?.links ?? []);
  const shown = sortedMasses(matchingMasses(rows, filter.value), order.value);
  return html`<div class="panel-bar masses-bar">
      <${SearchBox} label=${t("masses.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
      <${MenuButton} label=${t("masses.copy")} items=${() => copyItems(shown)}><${Icon} name="copy" /><${Icon} name="chevronDown" size=${12} /><//>
    </div>
    <${Sum} masses=${found} />
    <${Table} rows=${shown} order=${order} />
    ${shown.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: filter.value })}</p>`}`;
}

/** @param {readonly MassRow[]} rows */
const copyItems = (rows) =>
  /** @type {const} */ (["tsv", "csv"]).map((form) => ({
    label: t(`masses.copy.${form}`),
    run: async () => {
      const done = await copyText(massText(rows, form));
      notify(done ? t("masses.copied", { count: rows.length }) : t("copy.failed"), { bad: !done });
    },
  }));

/** @param {{masses: NonNullable<typeof masses.value>}} props the centre follows the joints */
function Sum({ masses: found }) {
  const without = (robot.value?.links.length ?? 0) - found.length;
  const centre = linkPoses.value && centreOfMass(found, linkPoses.value);
  return html`<dl class="masses-sum">
    <div><dt>${t("masses.sum")}</dt><dd><strong title=${allDigits(sumOf(found))}>${shownNumber(sumOf(found))}</strong> kg</dd></div>
    <div><dt title=${t("masses.centre.hint")}>${t("masses.centre", { frame: robot.value?.root ?? "" })}</dt>
      <dd class="masses-centre" title=${centre?.map(allDigits).join(" ")}>${centre ? html`${centre.map((value) => [html`<span>${shownMeasure(value)}</span>`, " "])}m` : "–"}</dd></div>
    <div><dt>${t("masses.links")}</dt><dd>${t("masses.links.count", { count: found.length })}${
      without > 0 &&
      html` <span class="muted" title=${t("masses.without.hint")}>${t("masses.without", { count: without })}</span>`
    }</dd></div>
  </dl>`;
}

/** @param {MassRow} row */
const nameOf = ({ mass }) => mass.link;

/** @param {{rows: readonly MassRow[], order: Signal<MassOrder>}} props */
function Table({ rows, order }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  useShowSelected(element);
  return html`<div class="scroll" ref=${element} onPointerLeave=${() => {
    hovered.value = null;
  }}><table class="masses-table" aria-rowcount=${rows.length + 1}>
    <thead><tr>
      <${SortHead} order=${order} by="link" words=${t("masses.link")} />
      <${SortHead} order=${order} by="mass" words=${t("masses.mass")} unit="kg" class="number" />
      <th scope="col">${t("masses.share")}</th>
      <${SortHead} order=${order} by="density" words=${t("masses.density")} unit="kg/m³" class="number" />
      <th scope="col" colspan="3" class="number" title=${t("masses.com.hint")}>${t("masses.com")} <small>m</small></th>
      <${SortHead} order=${order} by="moment" span=${3} words=${t("masses.moments")} unit="kg m²" class="number" />
      <th scope="col" class="where">${t("masses.place")}</th>
    </tr></thead>
    <${LongList} items=${rows} keyOf=${nameOf} row="var(--row)" inTable
      isKept=${(/** @type {MassRow} */ { mass }) => selected.value === mass.link}
      draw=${(/** @type {MassRow} */ row, /** @type {number} */ at) =>
        html`<${Row} key=${row.mass.link} row=${row} number=${at + 2} />`} />
  </table></div>`;
}

/** What was selected elsewhere comes into view. @param {{current: HTMLElement | null}} element */
function useShowSelected(element) {
  const chosen = selection.value;
  useEffect(() => {
    if (!chosen || chosen.by === "masses") return;
    element.current?.querySelector("tr.chosen")?.scrollIntoView({ block: "nearest" });
  }, [chosen]);
}

/** @param {{order: Signal<MassOrder>, by: MassOrder, words: string, unit?: string, span?: number, class?: string}} props */
function SortHead({ order, by, words, unit, span = 1, class: name }) {
  const on = order.value === by;
  const how = by === "link" ? "ascending" : "descending";
  return html`<th scope="col" colspan=${span} class=${name ?? ""} aria-sort=${on ? how : "none"}>
    <button type="button" class="sort" title=${t(`masses.sort.${by}`)} onClick=${() => {
      order.value = by;
    }}>${words}${unit && html` <small>${unit}</small>`}${on && html`<${Icon} name="chevronDown" size=${12} />`}</button></th>`;
}

/** @param {{row: MassRow, number: number}} props `number` in the table, whose head is the first */
function Row({ row, number }) {
  const { mass, share, link } = row;
  const chosen = selected.value === mass.link;
  const pick = () => selectPart(`link:${mass.link}`, "", "", "masses");
  const states = [chosen && "chosen", hovered.value === mass.link && "hovered"];
  return html`<tr aria-rowindex=${number} class=${states.filter(Boolean).join(" ")} onClick=${pick} onDblClick=${() => explain(mass.link)}
    onPointerEnter=${() => {
      hovered.value = mass.link;
    }}>
    <th scope="row"><button type="button" class="link-name" title=${mass.link} aria-pressed=${chosen}>${mass.link}</button></th>
    <td class="number" title=${mass.mass_kg}>${shownNumber(mass.mass_kg)}</td>
    <td class="share"><span class="share-bar" style=${`--share:${(100 * share).toFixed(2)}%`}></span><span class="share-text">${(100 * share).toFixed(1)} %</span></td>
    <${DensityCell} row=${row} />
    ${mass.centre_m.map((value) => html`<td class="number three" title=${mass.centre_m.join(" ")}>${shownMeasure(value)}</td>`)}
    <${Moments} mass=${mass} />
    <td class="where">${link && html`<${PlaceLink} place=${{ file: link.file, line: link.line, column: 1 }} words=${placeWords(link)} />`}
      <${IconButton} icon="origin" label=${t("masses.why", { name: mass.link })} size=${14} onClick=${() => explain(mass.link)} /></td>
  </tr>`;
}

/** @param {NonNullable<MassRow["link"]>} link @returns {string} file and line, short */
const placeWords = ({ file, line }) =>
  `${baseName(file).replace(/(\.(urdf|xacro))+$/, "")}:${line}`;

/** @param {string} link say where its inertial comes from */
function explain(link) {
  selectPart(`link:${link}`, "inertial/mass", "value", "masses");
  commandById("panel.origin")?.run();
}

/** @param {{mass: MassRow["mass"]}} props */
function Moments({ mass }) {
  const [ixx, ixy, ixz, iyy, iyz, izz] = mass.inertia_kg_m2;
  const written = Object.entries({ ixx, ixy, ixz, iyy, iyz, izz }).map(
    ([name, value]) => `${name} ${value}`,
  );
  const possible = isPossible(mass);
  const hint = [...written, ...(possible ? [] : [t("masses.impossible")])].join("\n");
  const moments = mass.moments_kg_m2?.map(shownNumber) ?? ["", "", "–"];
  return moments.map(
    (text, at) => html`<td class=${`number three ${possible ? "" : "odd"}`} title=${hint}>${text}
      ${at === 2 && !possible && html`<${Icon} name="alert" size=${13} /><span class="hidden-words">${t("masses.impossible")}</span>`}</td>`,
  );
}

/** @param {{row: MassRow}} props held against the room that the shapes take */
function DensityCell({ row: { mass, density } }) {
  const hint = /** @type {const} */ (["collision", "visual"])
    .map((of) => `${t(`masses.volume.${of}`)}: ${volumeText(mass[of])}`)
    .join("\n");
  if (!density) return html`<td class="number muted" title=${hint}>–</td>`;
  const odd = isOddDensity(density);
  const words = `${density.isExact ? "" : "≥ "}${shownNumber(density.kg_m3)}`;
  return html`<td class=${`number ${odd ? "odd" : ""}`} title=${odd ? `${hint}\n${t("masses.odd")}` : hint}>${words}
    ${odd && html`<${Icon} name="alert" size=${13} /><span class="hidden-words">${t("masses.odd")}</span>`}</td>`;
}

/** @param {MassRow["mass"]["visual"]} volume @returns {string} in litres */
function volumeText(volume) {
  if (!volume) return t("masses.volume.unknown");
  return `${volume.is_exact ? "" : "≤ "}${allDigits(1000 * volume.volume_m3)} dm³`;
}
