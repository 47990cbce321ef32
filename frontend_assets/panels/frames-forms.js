/** The forms of one pose, each with what a person copies of it. */

/** @import { Pose } from "../lib/kinematics.js" */
/** @import { MenuItem } from "../lib/ui.js" */

import { html } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import {
  asList,
  asOrigin,
  asText,
  matrixList,
  matrixOf,
  matrixText,
  quaternionOf,
  turnOf,
  written,
} from "../lib/frame-pose.js";
import { t } from "../lib/i18n.js";
import { translationOf } from "../lib/kinematics.js";
import { shownMeasure, toDegrees } from "../lib/numbers.js";
import { Icon, MenuButton } from "../lib/ui.js";
import { millimetres } from "../model/tf.js";
import { notify } from "../model/view.js";

/** @param {{pose: Pose}} props */
export function PoseForms({ pose }) {
  const place = translationOf(pose);
  const { rpy, locked } = turnOf(pose);
  const factor = millimetres.value ? 1000 : 1;
  const lengths = place.map((one) => one * factor);
  const degrees = rpy.map(toDegrees);
  const quaternion = quaternionOf(pose);
  return html`<div class="frames-forms">
    <${Form} title=${t("frames.position")} unit=${html`<${LengthUnit} />`} names="xyz" values=${lengths}
      copies=${copiesOf(pose, lengths)} />
    <div class="frames-turn">
      <${Form} title=${t("frames.rpy")} unit="°" names=${RPY} values=${degrees} copies=${copiesOf(pose, degrees)} />
      <${Form} title="" unit="rad" names=${RPY} values=${rpy} copies=${copiesOf(pose, rpy)}
        note=${t("frames.rpy.note")} />
      ${locked && html`<p class="note frames-note"><${Icon} name="info" size=${13} />${t("frames.locked")}</p>`}
    </div>
    <${Form} title=${t("frames.quaternion")} unit="" names="xyzw" values=${quaternion} copies=${copiesOf(pose, quaternion)} />
    <${Matrix} pose=${pose} />
  </div>`;
}

const RPY = ["roll", "pitch", "yaw"];

/** @param {Pose} pose @param {readonly number[]} values @returns {Copies} */
const copiesOf = (pose, values) => ({
  text: asText(values),
  list: asList(values),
  origin: asOrigin(pose),
});

/** @typedef {{text: string, list: string, origin: string}} Copies */

function LengthUnit() {
  const label = t(millimetres.value ? "frames.to_m" : "frames.to_mm");
  const toggle = () => {
    millimetres.value = !millimetres.value;
  };
  return html`<button type="button" class="unit unit-button" aria-label=${label} title=${label} onClick=${toggle}>${millimetres.value ? "mm" : "m"}</button>`;
}

/**
 * @param {{title: string, unit: unknown, names: string | readonly string[], values: readonly number[],
 *   copies: Copies, note?: string}} props
 */
function Form({ title, unit, names, values, copies, note }) {
  return html`<div class="frames-form">
    ${title && html`<h3>${title}</h3>`}
    <div class="frames-line">
      <div class="frames-values">${values.map(
        (value, at) =>
          html`<span key=${at} class="frames-value"><small>${names[at]}</small><output class="numbers" title=${written(value)}>${shownMeasure(value)}</output></span>`,
      )}</div>
      <span class="unit">${unit}</span>
      <${CopyMenu} label=${t("frames.copy", { what: title || t("frames.rpy") })} copies=${copies} />
    </div>
    ${note && html`<p class="note">${note}</p>`}
  </div>`;
}

/** @param {{pose: Pose}} props */
function Matrix({ pose }) {
  const copies = { text: matrixText(pose), list: matrixList(pose), origin: asOrigin(pose) };
  return html`<div class="frames-form">
    <h3>${t("frames.matrix")}</h3>
    <div class="frames-line">
      <table class="frames-matrix numbers" aria-label=${t("frames.matrix")}><tbody>${matrixOf(
        pose,
      ).map(
        (row, at) =>
          html`<tr key=${at}>${row.map((value, column) => html`<td key=${column} title=${written(value)}>${shownMeasure(value)}</td>`)}</tr>`,
      )}</tbody></table>
      <span class="unit">m</span>
      <${CopyMenu} label=${t("frames.copy", { what: t("frames.matrix") })} copies=${copies} />
    </div>
  </div>`;
}

/** @param {{label: string, copies: Copies}} props */
function CopyMenu({ label, copies }) {
  return html`<${MenuButton} class="icon-button frames-copy" label=${label} items=${() => copyItems(copies)}><${Icon} name="copy" size=${14} /><//>`;
}

/** @param {Copies} copies as they were when the menu was opened @returns {MenuItem[]} */
function copyItems({ text, list, origin }) {
  const item = (/** @type {string} */ name, /** @type {string} */ copied) => ({
    label: t(`frames.copy.${name}`),
    run: async () => {
      if (await copyText(copied)) notify(t("copied"));
    },
  });
  return [item("text", text), item("origin", origin), item("list", list)];
}
