/** ROS 2 in the bar below: is a router there, and who else. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { connection, mayEdit } from "../model/connection.js";
import { connectRos, ros } from "../model/ros.js";
import { dialog } from "../model/view.js";

const TONES = { off: "", connecting: "", connected: "good", lost: "bad", failed: "bad" };

/** @returns {string} the state in a few words */
function inShort() {
  const { state, node_count: count, nearby_count: nearby } = ros.value;
  if (connection.value !== "connected") return t("ros.unknown");
  if (state === "connected") return t("ros.nodes", { count });
  return nearby > 0 ? t("ros.nearby", { count: nearby }) : t(`ros.${state}`);
}

/** What is known is the studio's: without it nothing is. @returns {string} */
const tone = () => (connection.value === "connected" ? TONES[ros.value.state] : "");

/** Part of the bar below. */
export function RosStatus() {
  const isFound = ros.value.nearby_count > 0 && mayEdit.value;
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class=${`status-button ros-status ${tone()}`} title=${t("ros.details")} onClick=${show}>
    <${Icon} name="link" size=${13} />${t("ros.bar", { state: inShort() })}</button>
    ${isFound && html`<button type="button" class="status-button connect" aria-label=${t("ros.connect.bar")} onClick=${connectRos}>${t("ros.connect")}</button>`}`;
}
