/** Above the joints: who moves them, and what of them and of the robot goes out to ROS 2. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { Icon, Switch } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { animating, movable, robot } from "../model/document.js";
import { chooseSource, feed, publishJoints, publishRobot, ros } from "../model/ros.js";

/** @typedef {"sliders" | "animation" | "joint_states" | "tf"} Source */
const SOURCES = /** @type {const} */ (["sliders", "animation", "joint_states", "tf"]);

const folded = remembered("joints.source.folded", false);

export function SourceSection() {
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
  const off = !mayEdit.value || busy.value;
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
