/** ROS 2 in the bar below and in a window of its own: is a router there, where, and who else. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon } from "../lib/ui.js";
import { connectRos, disconnectRos } from "./ros.js";
import { mayEdit } from "./state/connection.js";
import { ros } from "./state/ros.js";
import { dialog } from "./state/view.js";

const TONES = { off: "", connecting: "", connected: "good", lost: "bad", failed: "bad" };

/** @returns {string} the state in a few words */
function inShort() {
  const { state, node_count: count } = ros.value;
  return state === "connected" ? t("ros.nodes", { count }) : t(`ros.${state}`);
}

/** Part of the bar below. */
export function RosStatus() {
  const { state } = ros.value;
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class=${`status-button ros-status ${TONES[state]}`} title=${t("ros.details")} onClick=${show}>
    <${Icon} name="link" size=${13} />${t("ros.bar", { state: inShort() })}</button>`;
}

/** @param {{onClose: () => void}} props */
export function RosDialog({ onClose }) {
  const { state, router, trouble, endpoint, domain, distro } = ros.value;
  const isThere = state === "connected" || state === "lost";
  return html`<${Dialog} title=${t("ros")} closeLabel=${t("close")} class="ros-dialog" onClose=${onClose}>
    <p class="dialog-text ros-lead"><${Icon} name=${state === "connected" ? "check" : state === "off" ? "info" : "alert"} size=${16} /><span>${t(`ros.${state}.text`)}</span></p>
    ${trouble && html`<p class="dialog-text bad" role="alert">${trouble}</p>`}
    <dl class="ros-facts">
      <dt>${t("ros.address")}</dt><dd>${endpoint}${isThere && html` <span class="muted">${t(`ros.router.${router}`)}</span>`}</dd>
      <dt>${t("ros.domain")}</dt><dd>${domain}</dd>
      ${isThere && html`<dt>${t("ros.distro")}</dt><dd>${distro}</dd>`}
      ${state === "connected" && html`<dt>${t("ros.others")}</dt><dd><${Nodes} /></dd>`}
    </dl>
    ${state !== "connecting" && html`<${Foot} isThere=${isThere} />`}
  <//>`;
}

/** @param {{isThere: boolean}} props a connection that can be ended; else one can be made */
function Foot({ isThere }) {
  const busy = useSignal(false);
  const act = async () => {
    busy.value = true;
    await (isThere ? disconnectRos() : connectRos());
    busy.value = false;
  };
  const note = isThere ? t("ros.disconnect.note") : "";
  const hint = mayEdit.value ? note : t("ros.viewer");
  return html`<footer><span class="form-note">${hint}</span><span class="push"></span>
    <button key=${isThere} type="button" class=${`button ${isThere ? "" : "primary"}`} data-first=${isThere ? null : true} disabled=${!mayEdit.value || busy.value} onClick=${act}>
      ${busy.value && html`<span class="spinner"></span>`}${t(isThere ? "ros.disconnect" : "ros.connect")}</button></footer>`;
}

function Nodes() {
  const { nodes, node_count: count } = ros.value;
  if (count === 0) return html`<span class="muted">${t("ros.nobody")}</span>`;
  return html`<ul class="ros-nodes">${nodes.map((name) => html`<li key=${name}>${name}</li>`)}
    ${count > nodes.length && html`<li class="muted">${t("ros.more", { count: count - nodes.length })}</li>`}</ul>`;
}
