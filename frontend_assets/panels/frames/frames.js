/** The frames of TF, and the pose of one in another in every form in which people write it, live. */

/** @import { ComponentChildren } from "vendor/preact.js" */
/** @import { Step } from "../../lib/frame-pose.js" */
/** @import { FrameStep } from "../../lib/frame-tree.js" */
/** @import { Pose } from "../../lib/kinematics.js" */
/** @import { MenuItem } from "../../lib/ui.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
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
} from "../../lib/frame-pose.js";
import { troubleOf } from "../../lib/frame-tree.js";
import { t } from "../../lib/i18n.js";
import { translationOf } from "../../lib/kinematics.js";
import { shownMeasure, toDegrees } from "../../lib/numbers.js";
import { LinkPicker } from "../../lib/pick-box.js";
import { useSeen } from "../../lib/seen.js";
import { shortTime } from "../../lib/times.js";
import { EmptyState, Icon, IconButton, MenuButton, SearchBox } from "../../lib/ui.js";
import { mayManage } from "../../model/connection.js";
import { robot } from "../../model/document.js";
import { askFrames, followFrames, framesRefused } from "../../model/frames.js";
import { ros } from "../../model/ros.js";
import { part, selectPart } from "../../model/selection.js";
import {
  answered,
  askPair,
  askTf,
  BY_FRAMES,
  chain,
  comparing,
  fixedFrame,
  followTf,
  frameNames,
  isToldByOthers,
  jointWay,
  millimetres,
  pairAnswer,
  pairRefused,
  reference,
  referenceFromTarget,
  setReference,
  setTarget,
  source,
  swapFrames,
  target,
  tfFrames,
  tfRefused,
  tfWay,
} from "../../model/tf.js";
import { dialog, notify } from "../../model/view.js";
import { Refusal } from "../parts.js";
import { FramesTree } from "./tree.js";

export function FramesPanel() {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(followFrames, []);
  useSeen(panel, (seen) => {
    comparing.value = seen;
  });
  const looking = comparing.value;
  useEffect(() => (looking ? followTf() : undefined), [looking]);
  const isEmpty = frameNames.value.length === 0;
  return html`<section ref=${panel} class="panel-body frames" aria-label=${t("panel.frames")}>
    ${isEmpty ? html`<${EmptyState} icon="frames" title=${t("tf.none")}><${ConnectButton} /><//>` : html`<${Content} />`}
  </section>`;
}

function Content() {
  return html`<div class="frames-parts"><${Tree} /><${Pair} /></div>`;
}

function Tree() {
  const filter = useSignal("");
  return html`<div class="tf-part">
    <div class="panel-bar"><${SearchBox} label=${t("tf.filter")} value=${filter.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      filter.value = text;
    }} /></div>
    ${answered.value ? html`<${Summary} /><${FramesTree} filter=${filter.value} /><${Notes} />` : html`<${Waiting} />`}
  </div>`;
}

function Waiting() {
  return tfRefused.value
    ? html`<${Refusal} sentence=${tfRefused.value} again=${askTf} />`
    : html`<p class="note padded">${t("loading")}</p>`;
}

/** How many frames there are, and how many of them are in trouble. */
function Summary() {
  const count = tfFrames.value.length + (answered.value?.answer.more ?? 0);
  const { stale, broken } = troubleOf(tfFrames.value);
  return html`<p class="tf-summary" role="status">
    <span>${t("tf.count", { count })}</span>
    ${stale > 0 && html`<span class="tf-state stale"><${Icon} name="alert" size=${12} /><span>${t("tf.count.stale", { count: stale })}</span></span>`}
    ${broken > 0 && html`<span class="tf-state broken"><${Icon} name="alert" size=${12} /><span>${t("tf.count.broken", { count: broken, fixed: fixedFrame.value })}</span></span>`}
  </p>`;
}

/** What is to be said below the tree: what was left out or refused, and how to see more. */
function Notes() {
  const { more = 0, refused = [] } = answered.value?.answer ?? {};
  const isOff = ros.value.state !== "connected";
  return html`<div class="tf-notes">
    ${more > 0 && html`<p class="note">${t("tf.more", { count: more })}</p>`}
    ${isOff && html`<p class="note tf-off"><span>${t("tf.off")}</span><${ConnectButton} /></p>`}
    ${!isOff && !isToldByOthers.value && html`<p class="note"><${Icon} name="info" size=${13} />${t("tf.quiet")}</p>`}
    ${
      refused.length > 0 &&
      html`<details class="tf-refused"><summary>${t("tf.refused", { count: refused.length })}</summary>
      <ul>${refused.map((sentence) => html`<li key=${sentence}>${sentence}</li>`)}</ul></details>`
    }
  </div>`;
}

function ConnectButton() {
  if (ros.value.state === "connected" || !mayManage.value) return null;
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class="button" onClick=${show}><${Icon} name="link" size=${14} />${t("ros.connect")}</button>`;
}

function Pair() {
  const names = frameNames.value;
  const isApart = source.value === "joints" && jointWay.value === null;
  return html`<div class="frames-pair">
    <div class="panel-bar frames-head">
      <span class="muted">${t("frames.of")}</span>
      <${LinkPicker} label=${t("frames.target")} value=${target.value} links=${names} placeholder=${t("frames.choose")} onPick=${setTarget} />
      <span class="muted">${t("frames.in")}</span>
      <${LinkPicker} label=${t("frames.reference")} value=${reference.value} links=${names} onPick=${setReference} />
      <${IconButton} icon="compare" label=${t("frames.swap")} disabled=${target.value === null} onClick=${swapFrames} />
    </div>
    <div class="scroll">
      ${target.value === null && html`<${EmptyState} icon="frames" title=${t("frames.none")} />`}
      ${target.value !== null && isApart && html`<p class="note padded"><${Icon} name="info" size=${13} />${t("frames.apart")}</p>`}
      ${target.value !== null && html`<${Values} />`}
      ${target.value !== null && html`<${Way} />`}
    </div>
  </div>`;
}

/** Drawn anew with every joint frame, and nothing else of the panel. */
function Values() {
  const pose = referenceFromTarget.value;
  if (pose) return html`<${PoseForms} pose=${pose} />`;
  if (source.value === "tf" && pairAnswer.value?.trouble)
    return html`<p class="note frames-trouble" role="status"><${Icon} name="alert" size=${14} /><span>${troubleText(pairAnswer.value.trouble)}</span></p>`;
  const [refused, again] =
    source.value === "tf" ? [pairRefused.value, askPair] : [framesRefused.value, askFrames];
  return refused
    ? html`<${Refusal} sentence=${refused} again=${again} />`
    : html`<p class="note padded">${t("loading")}</p>`;
}

/** @param {string} sentence the studio's @returns {string} a frame of the way that nobody tells of any more says it better */
function troubleText(sentence) {
  const stale = tfFrames.value.find(
    ({ name, state }) => state === "stale" && chain.value.has(name),
  );
  if (!stale) return sentence;
  return t("tf.stale.way", { frame: stale.name, time: shortTime(stale.age_s ?? 0) });
}

/** The frames from the one to the other, and the joints where those of the robot lead there. */
function Way() {
  const first = reference.value ?? "";
  const joints = jointWay.value;
  if (joints)
    return html`<${Steps} label=${t("frames.way")} first=${first}>${joints.map(
      (step) => html`<${JointStep} key=${step.joint.name} step=${step} />`,
    )}<//>`;
  const frames = tfWay.value;
  if (!frames) return null;
  return html`<${Steps} label=${t("tf.way")} first=${first}>${frames.map(
    (step) => html`<${TfStep} key=${step.at} step=${step} />`,
  )}<//><p class="note padded">${t("tf.told_last")}</p>`;
}

/** @param {{label: string, first: string, children?: ComponentChildren}} props */
function Steps({ label, first, children }) {
  return html`<ol class="frames-way" aria-label=${label}><li><${FrameButton} name=${first} /></li>${children}</ol>`;
}

/** @param {{step: Step}} props */
function JointStep({ step: { joint, up } }) {
  return html`<li><${Arrow} up=${up} />
    <${PartButton} part=${`joint:${joint.name}`} name=${joint.name} icon="joints" still=${joint.type === "fixed"} />
    <${FrameButton} name=${up ? joint.parent : joint.child} /></li>`;
}

/** @param {{step: FrameStep}} props */
function TfStep({ step: { at, up } }) {
  return html`<li><${Arrow} up=${up} /><${FrameButton} name=${at} /></li>`;
}

/** @param {{up: boolean}} props */
function Arrow({ up }) {
  const words = t(up ? "frames.up" : "frames.down");
  return html`<span class="frames-arrow" title=${words} aria-label=${words}>${up ? "↑" : "↓"}</span>`;
}

/** @param {{name: string}} props a link of the robot is selected with it */
function FrameButton({ name }) {
  if (robot.value?.links.some((link) => link.name === name))
    return html`<${PartButton} part=${`link:${name}`} name=${name} icon="box" />`;
  return html`<span class="segment" title=${name}><${Icon} name="frames" size=${12} /><span>${name}</span></span>`;
}

/** @param {{part: string, name: string, icon: string, still?: boolean}} props */
function PartButton({ part: key, name, icon, still = false }) {
  return html`<button type="button" class=${`segment ${still ? "still" : ""}`} aria-pressed=${part.value === key} title=${name}
    onClick=${() => selectPart(key, "", "", BY_FRAMES)}><${Icon} name=${icon} size=${12} /><span>${name}</span></button>`;
}

/**
 * The forms of one pose, each with what a person copies of it.
 *
 * @param {{pose: Pose}} props
 */
function PoseForms({ pose }) {
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
