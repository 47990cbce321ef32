/** How a robot is made to be met: what to type there, by what it speaks and where it is. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { hostOf, ros } from "../model/ros.js";
import { CodeLine } from "./code-line.js";

const BRIDGE = "zenoh-bridge-ros2dds";
export const SITUATIONS = /** @type {const} */ ([
  "zenoh",
  "here",
  "there",
  "many",
  "humble",
  "bag",
]);

/** @typedef {typeof SITUATIONS[number]} Situation */

const ON_DDS = new Set(["here", "there", "many", "humble"]);

/** @param {Situation} situation @param {string} router the address of one that runs on this machine; empty: none does @returns {readonly string[]} */
export function recipeLines(situation, router) {
  switch (situation) {
    case "zenoh":
      return [
        "sudo apt install ros-$ROS_DISTRO-rmw-zenoh-cpp",
        "export RMW_IMPLEMENTATION=rmw_zenoh_cpp",
        "ros2 run rmw_zenoh_cpp rmw_zenohd",
      ];
    case "here":
      // Without a router it is one itself, at the port that another one holds.
      return [router === "" ? BRIDGE : `${BRIDGE} client -e ${router}`];
    case "there":
      return [BRIDGE];
    case "many":
      // In one network each bridge would find all robots, and pass on what the others brought.
      return [
        "studio router --listen tcp/0.0.0.0:7447",
        `${BRIDGE} -n /robot1 --ros-localhost-only -e tcp/STUDIO:7447`,
      ];
    case "humble":
      return [`ROS_DISTRO=humble ${BRIDGE}`];
    case "bag":
      return ["studio open FOLDER"];
  }
}

export function Recipes() {
  const chosen = useSignal(/** @type {Situation} */ ("zenoh"));
  const situation = chosen.value;
  const { state, endpoint } = ros.value;
  const isHere = (state === "connected" || state === "lost") && hostOf(endpoint) === "";
  return html`<details class="ros-recipes"><summary>${t("ros.recipes")}</summary>
    <label class="field"><span>${t("ros.recipe")}</span>
      <select class="box wide" value=${situation} onChange=${(/** @type {any} */ event) => {
        chosen.value = event.currentTarget.value;
      }}>${SITUATIONS.map((one) => html`<option key=${one} value=${one}>${t(`ros.recipe.${one}`)}</option>`)}</select></label>
    <section aria-live="polite" aria-label=${t(`ros.recipe.${situation}`)}>
      <p class="ros-hint">${t(`ros.recipe.${situation}.text`)}</p>
      ${recipeLines(situation, isHere ? endpoint : "").map((code) => html`<${CodeLine} key=${code} code=${code} />`)}
      <p class="ros-hint">${t(`ros.recipe.${situation}.then`)}</p>
      ${ON_DDS.has(situation) && html`<p class="ros-hint">${t("ros.recipe.cyclone")}</p><p class="ros-hint">${t("ros.recipe.version")}</p>`}
    </section>
  </details>`;
}
