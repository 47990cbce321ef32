/** turtlesim, drawn: its turtles and the lines they draw, and all that can be done with them. */

/** @import { Ground } from "../lib/turtles.js" */
/** @import { World } from "../lib/turtle-world.js" */

import { html, useEffect, useMemo, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected } from "../app/connect-first.js";
import { DemoFirst } from "../app/demo-first.js";
import { useLooking } from "../app/looking.js";
import { mayEdit } from "../app/state/connection.js";
import { drivingRefused } from "../app/state/driving.js";
import { backgroundRefused, followBackground } from "../app/turtle-background.js";
import { turtleTrouble } from "../app/turtle-deeds.js";
import {
  chosenGround,
  followGrounds,
  followTurtleCalls,
  ground,
  grounds,
  turtleLanes,
  worldOf,
} from "../app/turtles.js";
import { t } from "../lib/i18n.js";
import { Icon, MenuButton, ProgressBar } from "../lib/ui.js";
import { TurtleField } from "./turtlesim-field.js";
import { TurtleTools } from "./turtlesim-tools.js";

const ICON = "route";

export function TurtlesimPanel() {
  const { panel, looking } = useLooking(followGrounds);
  return html`<section ref=${panel} class="panel-body turtlesim" aria-label=${t("panel.turtlesim")}>
    ${isUnconnected() ? html`<${ConnectFirst} icon=${ICON} />` : looking && html`<${Content} />`}
  </section>`;
}

function Content() {
  const shown = ground.value;
  if (!grounds.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (!shown)
    return html`<${DemoFirst} icon=${ICON} title=${t("turtlesim.none")} demo="turtlesim_node" />`;
  return html`<${Shown} key=${shown.prefix} ground=${shown} />`;
}

/** @param {{ground: Ground}} props a ground, which is heard from now on */
function Shown({ ground: { prefix, node, turtles } }) {
  const world = useMemo(() => worldOf(prefix), [prefix]);
  useWorld(world, prefix, node, turtles);
  const wished = useSignal("");
  const isPlacing = useSignal(false);
  const chosen = turtles.find(({ name }) => name === wished.value) ?? turtles[0] ?? null;
  const choose = (/** @type {string} */ name) => {
    wished.value = name;
    world.isStale = true;
  };
  const parts = { prefix, world, turtles, chosen, choose, isPlacing };
  return html`${(grounds.value?.length ?? 0) > 1 && html`<${Choice} prefix=${prefix} />`}
    ${!mayEdit.value && html`<p class="note padded">${t("turtlesim.viewer")}</p>`}
    <div class="field-parts">
      <${TurtleField} ...${parts} />
      <${TurtleTools} ...${parts} node=${node} />
    </div>
    ${[turtleTrouble, backgroundRefused, drivingRefused].map(({ value }) => value && html`<p class="note bad padded" role="alert">${value}</p>`)}`;
}

/** @param {World} world @param {string} prefix @param {string} node @param {Ground["turtles"]} turtles */
function useWorld(world, prefix, node, turtles) {
  const lanes = useMemo(() => turtleLanes(world), [world]);
  useEffect(() => lanes.end, [world]);
  useEffect(
    () => lanes.hear(turtles),
    [world, turtles.map(({ pose, color }) => `${pose} ${color}`).join("\n")],
  );
  useEffect(() => followTurtleCalls(prefix, world), [world]);
  useEffect(
    () => (node ? followBackground(node, (color) => world.setBackground(color)) : undefined),
    [world, node],
  );
}

/** @param {{prefix: string}} props which ground is shown, where there are several */
function Choice({ prefix }) {
  const nameOf = (/** @type {Ground} */ one) => one.node || one.prefix || "/";
  const items = () =>
    (grounds.value ?? []).map((one) => ({
      label: nameOf(one),
      checked: one.prefix === prefix,
      run: () => {
        chosenGround.value = one.prefix;
      },
    }));
  const shown = ground.value;
  return html`<div class="panel-bar row"><${MenuButton} label=${t("turtlesim.choose")} class="button" items=${items}>
    <span class="turtle-node">${shown && nameOf(shown)}</span><${Icon} name="chevronDown" size=${12} /><//></div>`;
}
