/** turtlesim, drawn: its turtles and the lines they draw, and all that can be done with them. */

/** @import { Ground } from "../lib/turtles.js" */
/** @import { World } from "../lib/turtle-world.js" */

import { html, useEffect, useMemo, useSignal } from "vendor/preact.js";
import { drivingRefused } from "../app/state/driving.js";
import { backgroundRefused, followBackground } from "../app/turtle-background.js";
import { turtleTrouble } from "../app/turtle-deeds.js";
import { followGrounds, followTurtleCalls, grounds, turtleLanes, worldOf } from "../app/turtles.js";
import { FieldPanel, Troubles } from "./field-panel.js";
import { TurtleField } from "./turtlesim-field.js";
import { TurtleTools } from "./turtlesim-tools.js";

/** @param {Ground} one */
const nameOf = ({ node, prefix }) => node || prefix || "/";

export function TurtlesimPanel() {
  const parts = { follow: followGrounds, worlds: grounds, nameOf, world: Shown };
  return html`<${FieldPanel} id="turtlesim" icon="route" demo="turtlesim_node" ...${parts} />`;
}

/** @param {{world: Ground}} props a ground, which is heard from now on */
function Shown({ world: { prefix, node, turtles } }) {
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
  return html`<div class="field-parts">
      <${TurtleField} ...${parts} />
      <${TurtleTools} ...${parts} node=${node} />
    </div>
    <${Troubles} troubles=${[turtleTrouble.value, backgroundRefused.value, drivingRefused.value]} />`;
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
