/** turtlesim, drawn: its turtles and the lines they draw, and all that can be done with them. */

/** @import { Ground, OnField, Pen, Turtle, World } from "./world.js" */
/** @import { FieldProps } from "./field.js" */

import { html, useEffect, useMemo, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { allDigits } from "../../lib/numbers.js";
import { Icon, Switch } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { drivingRefused } from "../../model/driving.js";
import { FieldPanel, Troubles } from "../demo-panel.js";
import { hexOf } from "./drawing.js";
import { TurtleField } from "./field.js";
import {
  backgroundRefused,
  clear,
  followBackground,
  followGrounds,
  followTurtleCalls,
  grounds,
  isServed,
  kill,
  reset,
  setBackground,
  setPen,
  turtleLanes,
  turtleTrouble,
  worldOf,
} from "./turtles.js";

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

const LOOK_MS = 200;

/** @param {FieldProps & {node: string}} props */
function TurtleTools({ prefix, node, world, turtles, chosen, choose, isPlacing }) {
  const turn = useTelling();
  const place = () => {
    isPlacing.value = !isPlacing.value;
  };
  return html`<div class="field-tools scroll">
    <ul class="turtle-list" aria-label=${t("turtlesim.turtles")}>${turtles.map(
      (turtle) =>
        html`<li key=${turtle.name}><${Row} turtle=${turtle} now=${world.turtles.get(turtle.name)} turn=${turn} isChosen=${turtle === chosen} choose=${choose} /></li>`,
    )}</ul>
    ${turtles.length === 0 && html`<p class="note">${t("turtlesim.no_turtle")}</p>`}
    <div class="field-buttons" role="group" aria-label=${t("turtlesim.do")}>
      <${Do} icon="plus" word="spawn" service=${`${prefix}/spawn`} pressed=${isPlacing.value} run=${place} />
      <${Do} icon="minus" word="kill" service=${`${prefix}/kill`} off=${!chosen} run=${() => chosen && kill(prefix, chosen.name)} />
      <${Do} icon="wand" word="clear" service=${`${prefix}/clear`} run=${() => clear(prefix)} />
      <${Do} icon="reset" word="reset" service=${`${prefix}/reset`} run=${() => reset(prefix)} />
    </div>
    ${chosen && html`<${PenRow} key=${chosen.path} turtle=${chosen} pen=${world.turtles.get(chosen.name)?.pen} />`}
    <div class="field-line"><label for="turtle-ground">${t("turtlesim.ground")}</label>
      <input id="turtle-ground" type="color" class="colour" value=${hexOf(world.background)} disabled=${!mayAct.value || node === ""}
        onInput=${(/** @type {any} */ event) => setBackground(node, event.currentTarget.value)} /></div>
    <p class="note">${t("turtlesim.keys")}</p>
    <p class="note">${t("turtlesim.seen")}</p>
  </div>`;
}

/** Show what is told now, some times in a second: to follow every pose is left to the drawing. @returns {number} another one each time */
function useTelling() {
  const turn = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => {
      turn.value += 1;
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, []);
  return turn.value;
}

/** @param {{turtle: Turtle, now: OnField | undefined, turn: number, isChosen: boolean, choose: (name: string) => void}} props `turn`: `now` stays the same object */
function Row({ turtle: { name }, now, isChosen, choose }) {
  const heading = ((now?.theta ?? 0) * 180) / Math.PI;
  const place = now?.isHere
    ? t("turtlesim.pose", {
        ...{ x: now.x.toFixed(2), y: now.y.toFixed(2), heading: heading.toFixed(0) },
        ...{ speed: now.forward.toFixed(1) },
      })
    : t("turtlesim.not_heard");
  const whole = now?.isHere
    ? [now.x, now.y, heading, now.forward].map(allDigits).join(" · ")
    : null;
  return html`<button type="button" class="turtle-row" aria-pressed=${isChosen} onClick=${() => choose(name)}>
    <span class="turtle-name">${name}</span><span class="turtle-pose" title=${whole}>${place}</span></button>`;
}

/** @param {{icon: string, word: string, service: string, run: () => void, off?: boolean, pressed?: boolean}} props a button that calls a service */
function Do({ icon, word, service, run, off = false, pressed }) {
  const isOff = off || !mayAct.value || !isServed(service);
  return html`<button type="button" class="button small" title=${t(`turtlesim.${word}.hint`, { service })} disabled=${isOff} aria-pressed=${pressed} onClick=${run}>
    <${Icon} name=${icon} size=${13} />${t(`turtlesim.${word}`)}</button>`;
}

/** @param {{turtle: Turtle, pen: Pen | undefined}} props as it was set last from this studio, or as turtlesim begins */
function PenRow({ turtle: { path, name }, pen }) {
  if (!pen) return null;
  const isOff = !mayAct.value || !isServed(`${path}/set_pen`);
  const change = (/** @type {Partial<Pen>} */ changed) => void setPen(path, { ...pen, ...changed });
  return html`<fieldset class="field-group" disabled=${isOff}><legend>${t("turtlesim.pen", { name })}</legend><div class="field-line">
    <input type="color" class="colour" aria-label=${t("turtlesim.pen.color")} value=${hexOf(pen.color)} disabled=${isOff}
      onChange=${(/** @type {any} */ event) => change({ color: Number.parseInt(event.currentTarget.value.slice(1), 16) })} />
    <label>${t("turtlesim.pen.width")} <input type="number" class="box number" min="1" max="50" value=${pen.width} disabled=${isOff}
      onChange=${(/** @type {any} */ event) => change({ width: Math.round(Math.min(255, Math.max(1, event.currentTarget.valueAsNumber || 1))) })} /></label>
    <span class="field-switch"><${Switch} label=${t("turtlesim.pen.down")} checked=${pen.isDown} disabled=${isOff} onChange=${(/** @type {boolean} */ isDown) => change({ isDown })} />
    <span aria-hidden="true">${t("turtlesim.pen.down")}</span></span></div></fieldset>`;
}
