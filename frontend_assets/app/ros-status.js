/** ROS 2 in the bar below: is a router there, and who else. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
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
