/** Two states side by side: what is chosen, the ghost in 3D, and the table of differences. */

/** @import { Side } from "../types/wire.d.ts" */

import { effect, html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { Slider } from "../lib/slider.js";
import { Icon, IconButton, ProgressBar } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { displays } from "../model/document.js";
import { ask, setDisplay } from "../model/requests.js";
import {
  canCompare,
  compareSides,
  comparison,
  sideKey,
  sideName,
  sideOf,
  variants,
} from "../model/variants.js";
import { viewport } from "../model/viewport.js";
import { DifferenceTable, InputTable } from "./variants-table.js";

export function VariantsComparison() {
  const { sides, busy, faults } = comparison.value;
  const section = useComesIntoView(sides !== null);
  if (!sides) return canCompare.value ? html`<${Begin} />` : null;
  return html`<section ref=${section} class="comparison" aria-label=${t("compare.title")}>
    <div class="comparison-bar">
      <header class="comparison-head"><h3>${t("compare.title")}</h3>
        <${IconButton} icon="close" label=${t("compare.end")} disabled=${!mayEdit.value} onClick=${end} /></header>
      <${Sides} sides=${sides} />
      <${GhostControls} />
    </div>
    ${busy && html`<${ProgressBar} label=${t("compare.busy")} done=${0} total=${0} />`}
    ${faults.map((one) => html`<p key=${one} class="variants-note bad" role="status"><${Icon} name="alert" />${one}</p>`)}
    <${InputTable} />
    <${DifferenceTable} />
  </section>`;
}

/** Below the list it would open out of sight. @param {boolean} open @returns {{current: HTMLElement | null}} */
function useComesIntoView(open) {
  const section = useRef(/** @type {HTMLElement | null} */ (null));
  const before = useRef(open);
  useEffect(() => {
    const around = section.current?.closest(".scroll");
    if (around && section.current && open && !before.current)
      around.scrollTop +=
        section.current.getBoundingClientRect().top - around.getBoundingClientRect().top;
    before.current = open;
  }, [open]);
  return section;
}

async function end() {
  const wasBeside = isBeside();
  if (displays.value.ghost?.visible) await setDisplay("ghost", "visible", false);
  await ask({ type: "compare_variants", sides: null });
  if (wasBeside) fitSoon();
}

/** The view was fitted around both robots. @returns {boolean} */
function isBeside() {
  const settings = displays.value.ghost;
  return settings?.visible === true && settings.beside === true;
}

/** Once what went is gone from the scene. */
function fitSoon() {
  setTimeout(() => viewport.value?.fit(), DRAWN_AFTER_MS);
}

function Begin() {
  const { active, modified, variants: list } = variants.value;
  const begin = async () => {
    await allSettled();
    const other = list.find(({ name }) => name !== active);
    /** @type {Side} */
    const saved = { kind: "saved", name: "" };
    /** @type {Side} */
    const present = { kind: "present", name: "" };
    const same = !modified && active === "" && other;
    // What changed since reads from then to now.
    if (same) compareSides(present, { kind: "variant", name: other.name });
    else compareSides(saved, present);
  };
  return html`<div class="comparison-begin">
    <button type="button" class="button small" disabled=${!mayEdit.value} onClick=${begin}>
      <${Icon} name="compare" size=${14} />${t("compare.begin")}</button></div>`;
}

/** @param {{sides: [Side, Side]}} props */
function Sides({ sides: [one, other] }) {
  const swap = () => compareSides(other, one);
  return html`<div class="comparison-sides">
    <${SideChoice} label=${t("compare.one")} side=${one} beside=${other} choose=${(/** @type {Side} */ side) => compareSides(side, other)} />
    <${IconButton} icon="compare" label=${t("compare.swap")} disabled=${!mayEdit.value} onClick=${swap} />
    <${SideChoice} label=${t("compare.other")} side=${other} beside=${one} choose=${(/** @type {Side} */ side) => compareSides(one, side)} />
  </div>`;
}

/** @param {{label: string, side: Side, beside: Side, choose: (side: Side) => void}} props */
function SideChoice({ label, side, beside, choose }) {
  /** @type {Side[]} */
  const all = [
    { kind: "present", name: "" },
    { kind: "saved", name: "" },
    ...variants.value.variants.map(({ name }) => ({
      kind: /** @type {const} */ ("variant"),
      name,
    })),
  ];
  return html`<select class="box" aria-label=${label} value=${sideKey(side)} disabled=${!mayEdit.value} title=${sideName(side)}
    onChange=${(/** @type {any} */ event) => choose(sideOf(event.currentTarget.value))}>
    ${all.map((one) => html`<option key=${sideKey(one)} value=${sideKey(one)} disabled=${sideKey(one) === sideKey(beside)}>${sideName(one)}</option>`)}
  </select>`;
}

/** The scene comes to this page on a lane of its own. */
const DRAWN_AFTER_MS = 400;
const PLACES = /** @type {const} */ (["off", "over", "beside"]);

/** For everybody who looks: whether the other robot is drawn, where, and how clearly. */
function GhostControls() {
  const settings = displays.value.ghost;
  if (!settings) return null;
  const place = settings.visible ? (settings.beside ? "beside" : "over") : "off";
  const off = !mayEdit.value;
  return html`<div class="ghost-controls" role="group" aria-label=${t("ghost")}>
    <span class="ghost-label"><${Icon} name="ghost" size=${14} />${t("ghost")}</span>
    <span class="ghost-places">
      ${PLACES.map((one) => html`<button key=${one} type="button" aria-pressed=${one === place} disabled=${off} title=${t(`ghost.${one}.hint`)} onClick=${() => putGhost(one)}>${t(`ghost.${one}`)}</button>`)}
    </span>
  </div>
  ${place !== "off" && html`<${GhostLook} opacity=${Number(settings.opacity)} off=${off} />`}`;
}

/** @param {{opacity: number, off: boolean}} props which robot it is, and how clearly it is drawn */
function GhostLook({ opacity, off }) {
  const ghost = comparison.value.ghost;
  const move = (/** @type {number} */ value) => setDisplay("ghost", "opacity", value);
  return html`<div class="ghost-look"><p class="ghost-legend">${ghost && html`<i></i>${sideName(ghost)}`}</p>
    <${Slider} label=${t("ghost.opacity")} min=${0.05} max=${1} step=${0.05} value=${opacity}
      text=${`${Math.round(opacity * 100)} %`} disabled=${off} onMove=${move} onEnd=${async () => {}} /></div>`;
}

/** @param {typeof PLACES[number]} place */
async function putGhost(place) {
  const wasBeside = isBeside();
  if (place !== "off") await setDisplay("ghost", "beside", place === "beside");
  await setDisplay("ghost", "visible", place !== "off");
  if (place === "beside") whenDrawn(() => viewport.value?.fit());
  else if (wasBeside) fitSoon();
}

/** Once the ghost stands in the scene, and viser has drawn it. @param {() => void} run */
function whenDrawn(run) {
  const stop = effect(() => {
    if (!comparison.value.ghost) return;
    setTimeout(run, DRAWN_AFTER_MS);
    queueMicrotask(() => stop());
  });
}
