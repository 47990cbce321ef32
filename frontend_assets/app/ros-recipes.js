/** How a robot is made to be met: what to type there, by what its nodes speak. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { CodeLine } from "./code-line.js";

const ZENOH = [
  "sudo apt install ros-$ROS_DISTRO-rmw-zenoh-cpp",
  "export RMW_IMPLEMENTATION=rmw_zenoh_cpp",
  "ros2 run rmw_zenoh_cpp rmw_zenohd",
];
const DDS = ["zenoh-bridge-ros2dds -l tcp/0.0.0.0:7447"];

export function Recipes() {
  return html`<details class="ros-recipes"><summary>${t("ros.recipes")}</summary>
    <${Recipe} name="zenoh" lines=${ZENOH} />
    <${Recipe} name="dds" lines=${DDS} />
  </details>`;
}

/** @param {{name: "zenoh" | "dds", lines: readonly string[]}} props */
function Recipe({ name, lines }) {
  return html`<section aria-label=${t(`ros.recipe.${name}`)}>
    <h3>${t(`ros.recipe.${name}`)}</h3>
    <p class="ros-hint">${t(`ros.recipe.${name}.text`)}</p>
    ${lines.map((code) => html`<${CodeLine} key=${code} code=${code} />`)}
    <p class="ros-hint">${t(`ros.recipe.${name}.then`)}</p>
  </section>`;
}
