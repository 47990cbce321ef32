/** Who has control, said in the bar above, with what one can do about it; sharing; and the stop. */

/** @import { Command } from "../lib/commands.js" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import {
  askControl,
  asking,
  control,
  hereCount,
  leads,
  raiseHand,
  returnControl,
  stopRobot,
  takeControl,
  takesPart,
  you,
} from "../model/class.js";
import { connection, hasControl, role } from "../model/connection.js";
import { canCopy, isCopy, openCopy } from "../model/copies.js";
import { canFollow, comeBack, explore, gatherAll, isFollowing } from "../model/following.js";
import { mayJoin } from "../model/student-nodes.js";
import { dialog, isFree } from "../model/view.js";

/** Below the bar above: what one may do here, and who has control where that is somebody else. */
export function ControlBar() {
  if (!isSaid() || isCopy.value) return null;
  return html`<div class=${`bar control-bar ${hasControl.value ? "own" : ""}`} role="status">
    <${Icon} name=${hasControl.value ? "check" : role.value === "presenter" ? "hand" : "watching"} />
    <span class="control-words">${stateWords()}</span>
    <${ControlButton} />
    ${canCopy.value && html`<button type="button" class="button small" title=${t("copy.open.hint")} onClick=${openCopy}><${Icon} name="fork" size=${14} />${t("copy.open")}</button>`}
    <${NodesButton} />
    <span class="push"></span>
    <${FollowButton} />
    ${takesPart.value && !leads.value && html`<${HandButton} />`}
    ${takesPart.value && role.value !== "presenter" && html`<${StopButton} />`}</div>`;
}

/** @returns {boolean} whoever presents knows that they do, and a guest of no class that they look */
const isSaid = () =>
  role.value === "presenter"
    ? control.value.holder !== ""
    : connection.value === "connected" && you.value.role !== "presenter";

/** @returns {string} */
function stateWords() {
  if (hasControl.value) return t("class.control.yours");
  return role.value === "presenter" ? holderWords() : `${t("class.looking")} · ${holderWords()}`;
}

/** @returns {string} who has control */
const holderWords = () =>
  control.value.holder === ""
    ? t("class.control.presenter")
    : t("class.control.of", { name: control.value.name });

/** Taken back, given back, asked for: the one thing that one can do about it. */
function ControlButton() {
  if (!takesPart.value) return null;
  if (role.value === "presenter") return html`<${Button} id="take_back" run=${takeControl} />`;
  if (hasControl.value) return html`<${Button} id="return" run=${returnControl} />`;
  if (leads.value) return html`<${Button} id="take" run=${takeControl} />`;
  const waits = you.value.asking;
  return html`<button type="button" class=${`button small ${waits ? "" : "primary"}`} aria-pressed=${waits} onClick=${() => askControl(!waits)}>
    ${t(waits ? "class.control.asked" : "class.control.ask")}</button>`;
}

/** Looking at what the presenter looks at, or around for oneself. */
function FollowButton() {
  if (!canFollow.value) return null;
  const is = isFollowing.value;
  return html`<span class="follow-words">${t(is ? "class.following" : "class.exploring")}</span>
    <button type="button" class=${`button small ${is ? "" : "primary"}`} onClick=${is ? explore : comeBack}>${t(is ? "class.explore" : "class.follow")}</button>`;
}

/** @param {{id: string, run: () => void}} props */
function Button({ id, run }) {
  return html`<button type="button" class="button small primary" onClick=${run}>${t(`class.control.${id}`)}</button>`;
}

/** Sharing beside saving, and the stop for everybody. */
export function ClassButtons() {
  if (role.value !== "presenter") return null;
  return html`<${ShareButton} />${control.value.class_open && html`<${StopButton} />`}`;
}

function StopButton() {
  return html`<${IconButton} icon="stopSign" class="stop-button" label=${t("command.stop_robot")} hint=${t("class.stop.hint")}
    disabled=${connection.value !== "connected"} onClick=${stopRobot} />`;
}

function ShareButton() {
  const { class_open: open } = control.value;
  const waiting = asking.value.length;
  const here = t("class.here", { count: hereCount.value });
  const label = open ? `${t("class.share")}, ${here}` : t("class.share");
  return html`<button type="button" class=${`button share-button ${open ? "open" : ""}`} aria-label=${label} title=${open ? label : t("class.share.hint")} onClick=${showClass}>
    <${Icon} name="users" /><span class="label">${open ? String(hereCount.value) : t("class.share")}</span>
    ${waiting > 0 && html`<span class="badge amber" aria-label=${t("class.asking", { count: waiting })}>${waiting}</span>`}</button>`;
}

function HandButton() {
  const { hand } = you.value;
  return html`<${IconButton} icon="hand" class="hand-button" pressed=${hand} label=${t("command.raise_hand")} hint=${t(hand ? "class.hand.lower" : "command.raise_hand")} onClick=${() => raiseHand(!hand)} />`;
}

function showClass() {
  dialog.value = { kind: "class" };
}

/** @returns {Command[]} */
export function classCommands() {
  const inClass = () => control.value.class_open && takesPart.value && isFree();
  return [
    {
      id: "share_class",
      icon: "users",
      enabled: () => role.value === "presenter" && isFree(),
      run: showClass,
    },
    { id: "stop_robot", icon: "stopSign", enabled: inClass, run: () => void stopRobot() },
    {
      id: "ask_control",
      icon: "hand",
      enabled: () => inClass() && !leads.value && !hasControl.value && !you.value.asking,
      run: () => void askControl(true),
    },
    {
      id: "take_control",
      icon: "hand",
      enabled: () => inClass() && leads.value && !hasControl.value,
      run: () => void takeControl(),
    },
    {
      id: "return_control",
      icon: "hand",
      enabled: () => inClass() && hasControl.value && role.value !== "presenter",
      run: () => void returnControl(),
    },
    {
      id: "raise_hand",
      icon: "hand",
      enabled: () => inClass() && !leads.value,
      run: () => void raiseHand(!you.value.hand),
    },
    { id: "my_nodes", icon: "node", enabled: () => mayJoin.value && isFree(), run: showNodes },
    { id: "open_copy", icon: "fork", enabled: () => canCopy.value, run: () => void openCopy() },
    {
      id: "gather_all",
      icon: "users",
      enabled: () => inClass() && role.value === "presenter",
      run: () => void gatherAll(),
    },
    {
      id: "class_name",
      icon: "pencil",
      enabled: () => you.value.name !== "" && isFree(),
      run: () => {
        dialog.value = { kind: "class_name" };
      },
    },
  ];
}

/** The way to the window of one's own ROS nodes, while nodes may join. */
export function NodesButton() {
  if (!mayJoin.value) return null;
  return html`<button type="button" class="button small" title=${t("nodes.open.hint")} onClick=${showNodes}><${Icon} name="node" size=${14} />${t("nodes.open")}</button>`;
}

function showNodes() {
  dialog.value = { kind: "nodes" };
}
