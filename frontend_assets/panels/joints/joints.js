/** One slider per joint that moves. A drag only asks; the position shown is the studio's answer. */

/** @import { JointView } from "../../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { rangeOf, unitsOf } from "../../lib/joints.js";
import { LongList } from "../../lib/long-list.js";
import { allDigits, parseNumber, shownMeasure, shownNumber } from "../../lib/numbers.js";
import { remembered } from "../../lib/remembered.js";
import { reveal } from "../../lib/seen.js";
import { Slider, TextBox } from "../../lib/slider.js";
import { EmptyState, Icon, SearchBox, Switch } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { animating, movable, position, robot } from "../../model/document.js";
import {
  jointsSettled,
  moveJoint,
  randomizeJoints,
  toggleAnimation,
  zeroJoints,
} from "../../model/requests.js";
import { chooseSource, feed, mayMove, publishJoints, publishRobot, ros } from "../../model/ros.js";
import { hovered, selected, selection, selectPart } from "../../model/selection.js";
import { degrees } from "../../model/view.js";
import { PosesSection } from "./poses.js";

export function JointsPanel() {
  const filter = useSignal("");
  const words = filter.value.trim().toLowerCase();
  const shown = movable.value.filter(({ name }) => name.toLowerCase().includes(words));
  return html`<section class="panel-body joints-panel" aria-label=${t("panel.joints")}>
    <div class="panel-bar">
      <${SearchBox} label=${t("joints.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
      <${JointActions} />
    </div>
    <div class="scroll">
      ${words === "" && html`<${SourceSection} /><${PosesSection} />`}
      <${LongList} items=${shown} keyOf=${nameOf} row="66px"
        isKept=${(/** @type {JointView} */ { child }) => selected.value === child}
        draw=${(/** @type {JointView} */ joint) => html`<${JointRow} key=${joint.name} joint=${joint} />`} />
      ${shown.length === 0 && html`<${Nothing} words=${filter.value.trim()} />`}
    </div>
  </section>`;
}

/** @param {JointView} joint */
const nameOf = ({ name }) => name;

/** @param {{words: string}} props */
function Nothing({ words }) {
  const none = t(robot.value ? "joints.none" : "urdf.none");
  const title = words ? t("filter.nothing", { words }) : none;
  return html`<${EmptyState} icon="joints" title=${title} />`;
}

function JointActions() {
  const off = !mayMove.value || movable.value.length === 0;
  const toggleUnit = () => {
    degrees.value = !degrees.value;
  };
  return html`<div class="actions">
    <button type="button" class="button small" disabled=${off} onClick=${zeroJoints}><${Icon} name="zero" size=${14} />${t("joints.zero")}</button>
    <button type="button" class="button small" disabled=${off} onClick=${randomizeJoints}><${Icon} name="random" size=${14} />${t("joints.random")}</button>
    <button type="button" class="button small" aria-pressed=${animating.value} disabled=${off} onClick=${toggleAnimation}>
      <${Icon} name=${animating.value ? "stop" : "animate"} size=${14} />${t(animating.value ? "joints.stop" : "joints.animate")}</button>
    <button type="button" class="button small units" onClick=${toggleUnit} aria-label=${t(degrees.value ? "angles.to_radians" : "angles.to_degrees")}
      title=${t(degrees.value ? "angles.to_radians" : "angles.to_degrees")}>${degrees.value ? "°" : "rad"}</button>
  </div>`;
}

/** @param {{joint: JointView}} props */
function JointRow({ joint }) {
  const follows = joint.mimic !== "";
  const chosen = selected.value === joint.child;
  const row = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => {
    return chosen && selection.value?.by !== "joints" ? reveal(row.current) : undefined;
  }, [chosen, selection.value]);
  return html`<div ref=${row} class=${`property joint ${chosen ? "chosen" : ""} ${follows ? "follows" : ""}`} role="group" aria-label=${joint.name}
    onPointerEnter=${() => {
      hovered.value = joint.child;
    }} onPointerLeave=${() => {
      hovered.value = null;
    }}>
    <div class="property-head">
      <button type="button" class="property-name joint-name" title=${jointHint(joint)} aria-pressed=${chosen}
        onClick=${() => selectPart(`joint:${joint.name}`, "", "", "joints")}>${joint.name}</button>
      <${JointBox} joint=${joint} />
    </div>
    <${JointSlider} joint=${joint} />
    ${follows && html`<p class="note"><${Icon} name="link" size=${12} />${followText(joint)}</p>`}
  </div>`;
}

/** @param {JointView} joint @returns {string} which joint it follows, and how far */
function followText({ mimic, multiplier }) {
  const name = multiplier === 1 ? mimic : `${mimic} × ${shownNumber(multiplier)}`;
  return t("joint.follows", { name });
}

/** @param {JointView} joint @returns {string} */
function jointHint({ name, type, parent, child }) {
  return `${name}\n${t(`joint.${type}`)}: ${parent} → ${child}`;
}

/** @param {{joint: JointView}} props */
function JointBox({ joint }) {
  const { unit, show, take, step } = unitsOf(joint, degrees.value);
  const value = show(position(joint.name).value);
  const off = !mayMove.value || joint.mimic !== "";
  /** @param {string} typed */
  const onWrite = (typed) => {
    const number = parseNumber(typed);
    if (number !== null) moveJoint(joint.name, take(number));
  };
  return html`<${TextBox} class="number" label=${joint.name} text=${shownMeasure(value)} number=${value} step=${step}
      disabled=${off} onWrite=${onWrite} />
    <span class="unit">${unit}</span>`;
}

/** @param {{joint: JointView}} props */
function JointSlider({ joint }) {
  const { lower, upper, limited } = rangeOf(joint);
  const { unit, show, take, step } = unitsOf(joint, degrees.value);
  const value = show(position(joint.name).value);
  const end = (/** @type {number} */ limit) =>
    html`<span title=${allDigits(show(limit))}>${shownMeasure(show(limit))}</span>`;
  return html`<${Slider} label=${t("joint.slider", { name: joint.name })} min=${show(lower)} max=${show(upper)} step=${step}
      value=${value} text=${`${shownMeasure(value)} ${unit}`} disabled=${!mayMove.value || joint.mimic !== ""}
      onMove=${(/** @type {number} */ moved) => moveJoint(joint.name, take(moved))} onEnd=${jointsSettled} />
    <div class="limits">${end(lower)}<span>${limited ? "" : t("joint.unlimited")}</span>${end(upper)}</div>`;
}

/** @typedef {"sliders" | "animation" | "joint_states" | "tf"} Source */
const SOURCES = /** @type {const} */ (["sliders", "animation", "joint_states", "tf"]);

const folded = remembered("joints.source.folded", false);

/** Above the joints: who moves them, and what of them and of the robot goes out to ROS 2. */
function SourceSection() {
  if (!robot.value) return null;
  const toggle = () => {
    folded.value = !folded.value;
  };
  return html`<section class="poses joints-source" aria-label=${t("source_of_joints")}>
    <header class="poses-head">
      <button type="button" class="poses-fold" aria-expanded=${!folded.value} onClick=${toggle}>
        <${Icon} name=${folded.value ? "chevronRight" : "chevronDown"} size=${14} />${t("source_of_joints")}</button>
      ${folded.value && html`<span class="muted ros-short">${t(`source.${sourceNow()}`)}</span>`}
    </header>
    ${!folded.value && html`<${Choices} />`}
  </section>`;
}

/** @returns {Source} */
function sourceNow() {
  const { source } = feed.value;
  return source === "sliders" && animating.value ? "animation" : source;
}

function Choices() {
  const busy = useSignal(false);
  /** @param {() => Promise<unknown>} change */
  const run = async (change) => {
    busy.value = true;
    await change();
    busy.value = false;
  };
  const { publishes_robot: robotOut, publishes_joints: jointsOut } = feed.value;
  const { description_from: from, trouble, rivals } = feed.value;
  const off = !mayAct.value || busy.value;
  return html`
    <label class="ros-row"><span>${t("source_of_joints.label")}</span>
      <select class="box" disabled=${off || movable.value.length === 0} value=${sourceNow()} onChange=${(
        /** @type {any} */ event,
      ) => run(() => chooseSource(event.currentTarget.value))}>
        ${SOURCES.map((one) => html`<option key=${one} value=${one} selected=${one === sourceNow()}>${t(`source.${one}`)}</option>`)}
      </select></label>
    <${SourceState} />
    <${PublishRow} label=${t("publish.robot")} topics="/robot_description  /tf" checked=${robotOut} disabled=${off || from !== ""}
      onChange=${(/** @type {boolean} */ on) => run(() => publishRobot(on))} />
    <${PublishRow} label=${t("publish.joints")} topics="/joint_states" checked=${jointsOut} disabled=${off}
      onChange=${(/** @type {boolean} */ on) => run(() => publishJoints(on))} />
    ${rivals.length > 0 && html`<p class="ros-note amber" role="status"><${Icon} name="alert" size=${12} /><span>${t("publish.rivals", { names: rivals.join(", ") })}</span></p>`}
    ${from && html`<p class="ros-note"><${Icon} name="link" size=${12} /><span>${t("source.described", { from })}</span></p>`}
    ${trouble && html`<p class="ros-note bad" role="alert"><${Icon} name="alert" size=${12} /><span>${trouble}</span></p>`}
    <${RosNote} />`;
}

/** @param {{label: string, topics: string, checked: boolean, disabled: boolean, onChange: (on: boolean) => void}} props */
function PublishRow({ label, topics, checked, disabled, onChange }) {
  return html`<div class="ros-row"><span class="ros-what">${label}<span class="muted ros-topics">${topics}</span></span>
    <${Switch} label=${label} checked=${checked} disabled=${disabled} onChange=${onChange} /></div>`;
}

/** Whether positions come from the wire, in words. */
function SourceState() {
  const { source_state: state, rate_hz: rate, strangers, joints_paused: paused } = feed.value;
  if (state === "") return null;
  const words = t(`source.state.${state}`, { rate, topic: t(`source.${feed.value.source}`) });
  const tone = state === "live" ? "good" : "amber";
  return html`<p class=${`ros-note ${tone}`} role="status"><${Icon} name=${state === "live" ? "check" : "alert"} size=${12} /><span>${words}</span></p>
    ${strangers.length > 0 && html`<p class="ros-note"><${Icon} name="info" size=${12} /><span>${t("source.strangers", { names: strangers.join(", ") })}</span></p>`}
    ${paused && html`<p class="ros-note"><${Icon} name="info" size=${12} /><span>${t("publish.paused")}</span></p>`}`;
}

/** What keeps the wire from working, where it is used. */
function RosNote() {
  const { state } = ros.value;
  const { source, publishes_robot: robotOut, publishes_joints: jointsOut } = feed.value;
  const isUsed = source !== "sliders" || robotOut || jointsOut;
  if (state === "connecting")
    return html`<p class="ros-note" role="status"><span class="spinner"></span><span>${t("ros.connecting")}</span></p>`;
  if (state !== "lost" || !isUsed) return null;
  return html`<p class="ros-note bad" role="alert"><${Icon} name="alert" size=${12} /><span>${t("ros.lost.text")}</span></p>`;
}
