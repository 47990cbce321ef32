/** A robot whose description is told on the wire, to be opened. */

/** @import { WireRobots } from "../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon, ProgressBar } from "../lib/ui.js";
import { findRobots, openFromRos, ros } from "../model/ros.js";

const TOPIC = "/robot_description";
const PARAMETER = "robot_description";

/** @typedef {{value: string}} Text */

export function RosForm() {
  const found = useSignal(/** @type {WireRobots | null} */ (null));
  const topic = useSignal(TOPIC);
  const node = useSignal("");
  const busy = useSignal(false);
  const error = useSignal("");
  const look = async () => {
    busy.value = true;
    const answer = await findRobots();
    busy.value = false;
    error.value = typeof answer === "string" ? answer : "";
    found.value = typeof answer === "string" ? null : answer;
    const [first] = found.value?.topics ?? [];
    if (first) topic.value = first;
  };
  useEffect(() => {
    look();
  }, []);
  /** @param {Event} event */
  const open = async (event) => {
    event.preventDefault();
    busy.value = true;
    const name = node.value.trim();
    error.value = await openFromRos(
      name ? { node: name, parameter: PARAMETER } : { topic: topic.value.trim() },
    );
    busy.value = false;
  };
  const ready = !busy.value && (topic.value.trim() !== "" || node.value.trim() !== "");
  return html`<form class="open-form ros-form" onSubmit=${open}>
    <p class="open-text">${t("ros.open.text")}</p>
    ${busy.value && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
    <${Field} label=${t("ros.open.topic")} text=${topic} list="ros-topics" choices=${found.value?.topics ?? []} />
    <${Field} label=${t("ros.open.node")} text=${node} list="ros-nodes" choices=${found.value?.nodes ?? []} />
    ${found.value?.topics.length === 0 && html`<p class="ros-note"><${Icon} name="info" size=${13} /><span>${t("ros.open.none", { address: ros.value.endpoint, domain: ros.value.domain })}</span></p>`}
    ${error.value && html`<p class="ros-note bad" role="alert"><${Icon} name="error" size=${13} /><span>${error.value}</span></p>`}
    <footer><span class="form-note">${t("ros.open.note")}</span><span class="push"></span>
      <button type="button" class="button" disabled=${busy.value} onClick=${look}><${Icon} name="reload" />${t("ros.open.again")}</button>
      <button type="submit" class="button primary" disabled=${!ready}>${t("ros.open.do")}</button></footer>
  </form>`;
}

/** @param {{label: string, text: Text, list: string, choices: readonly string[]}} props */
function Field({ label, text, list, choices }) {
  return html`<label class="field"><span>${label}</span>
    <input type="text" class="box wide" list=${list} maxlength="300" spellcheck=${false} value=${text.value}
      onInput=${(/** @type {any} */ event) => {
        text.value = event.currentTarget.value;
      }} />
    <datalist id=${list}>${choices.map((one) => html`<option key=${one} value=${one}></option>`)}</datalist></label>`;
}
