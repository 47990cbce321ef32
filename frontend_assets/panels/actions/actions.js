/** The actions that somebody serves: goals sent by a form, several at once, with progress, feedback, cancel and result. */

/** @import { GoalStatusView, GoalView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useEffect } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { Icon, ProgressBar } from "../../lib/ui.js";
import { askedWhenChanged, askOrKeepWhy } from "../../model/asking.js";
import { mayAct } from "../../model/connection.js";
import { filterLogTo, levelOf } from "../../model/log.js";
import { goalForm } from "../../model/message-forms.js";
import {
  actions,
  askActions,
  cancelGoal,
  followActions,
  followOperations,
  goals,
  isGoalOver,
  offersRefused,
  plainOf,
  sendGoal,
  shortOf,
  tookText,
  turnedRad,
} from "../../model/operations.js";
import {
  Offers,
  OperationForm,
  OperationPanel,
  OperationState,
  openLine,
  ValueTree,
} from "../operation-panel.js";

const FOLLOW = [followActions, () => followOperations("goals")];
const LOG_SHOWN = 50;

export function ActionsPanel() {
  return html`<${OperationPanel} id="actions" icon="goal" kind="action" follow=${FOLLOW} onLine=${openLine(goalForm)}>
    ${(
      /** @type {(text: string) => boolean} */ paste,
    ) => html`<div class=${`operations-parts ${goalForm.chosen.value ? "chosen" : ""}`}>
      <${Offers} id="actions" icon="goal" offers=${actions.value} refused=${offersRefused.value} again=${askActions} form=${goalForm} paste=${paste}
        next=${html`<p>${t("actions.none.hint")}</p><button type="button" class="button" onClick=${showLessons}><${Icon} name="lessons" />${t("actions.none.do")}</button>`}>
        <${UnderWay} /><//>
      ${goalForm.chosen.value && html`<${Chosen} name=${goalForm.chosen.value.name} />`}
    </div>`}
  <//>`;
}

const showLessons = () => commandById("panel.lessons")?.run();

/** Goals of all actions that are under way, whoever sent them from a page. */
function UnderWay() {
  const running = goals.value.filter((one) => !isGoalOver(one));
  if (running.length === 0) return null;
  return html`<section class="goals-running" aria-label=${t("actions.running")}><h4>${t("actions.running")}</h4>
    ${running.map((goal) => html`<div class="goal-line" key=${goal.operation}><span class="offer-name" title=${goal.name}>${goal.name}</span><${Stand} goal=${goal} /><${Progress} goal=${goal} /></div>`)}</section>`;
}

/** @param {{name: string}} props the action that is chosen, and its goals */
function Chosen({ name }) {
  useEffect(() => followStatuses(name), [name]);
  const own = goals.value.filter((one) => one.name === name).reverse();
  return html`<div class="operations-chosen scroll">
    <${OperationForm} form=${goalForm} onSubmit=${sendGoal} actions=${html`
      <button type="submit" class="button primary" disabled=${!mayAct.value || goalForm.wrong.value}><${Icon} name="send" />${t("actions.send")}</button>`} />
    ${own.map((goal) => html`<${Goal} key=${goal.operation} goal=${goal} />`)}
    <${Others} />
  </div>`;
}

/** @param {{goal: GoalView}} props */
function Goal({ goal }) {
  const last = plainOf(goal.feedback.at(-1)?.values ?? "");
  const result = plainOf(goal.result);
  const over = isGoalOver(goal);
  return html`<section class="operation-reply" aria-label=${t("actions.goal", { number: goal.operation })}>
    <header class="goal-head"><${Stand} goal=${goal} />${!over && html`<${Cancel} goal=${goal} />`}</header>
    <p class="goal-asked" title=${goal.text}>${goal.text.trim().replace(/\s+/g, " ") || "{}"}</p>
    <${Progress} goal=${goal} />
    <${Why} goal=${goal} />
    ${goal.trouble && html`<p class="note bad" role="alert">${goal.trouble}</p>`}
    ${!over && last !== undefined && html`<${ValueTree} value=${last} label=${t("actions.feedback")} />`}
    ${result !== undefined && html`<${ValueTree} value=${result} label=${t("actions.result")} />`}
    <${Turned} rad=${turnedRad(goal.action_type, result)} />
    ${goal.feedback_count > 0 && html`<${Log} goal=${goal} />`}
  </section>`;
}

/** @param {{goal: GoalView}} props why it ended, as far as its end and the log of its server tell */
function Why({ goal }) {
  const { state, servers, server_said: said } = goal;
  if (state === "canceled") return html`<p class="note">${t("actions.canceled.why")}</p>`;
  if (state !== "aborted" && state !== "rejected") return null;
  const server = servers[0];
  const show = (/** @type {string} */ node) => {
    filterLogTo(node);
    commandById("panel.log")?.run();
  };
  return html`<p class="note bad" role="alert">${t(state === "aborted" ? "actions.aborted.why" : "actions.rejected.do")}</p>
    ${said && html`<p class="note">${t("actions.server_said", { node: said.node, level: t(`log.level.${levelOf(said.level)}`) })} <q>${said.text}</q></p>`}
    ${server && html`<button type="button" class="button small" onClick=${() => show(server)}><${Icon} name="log" size=${13} />${t("actions.log.show", { node: server })}</button>`}`;
}

/** @param {{rad: number | null}} props what turtlesim's result means */
function Turned({ rad }) {
  if (rad === null) return null;
  const angle = {
    rad: Math.abs(rad).toFixed(2),
    degrees: Math.abs((rad * 180) / Math.PI).toFixed(0),
  };
  return html`<p class="note">${t(rad < 0 ? "actions.turned.right" : "actions.turned.left", angle)}</p>`;
}

/** @param {{goal: GoalView}} props how it stands, in words */
function Stand({ goal }) {
  const bad = goal.state === "failed" || goal.state === "rejected" || goal.state === "aborted";
  const words = t(`actions.${goal.state}`, { time: tookText(goal.took_s) });
  return html`<${OperationState} state=${goal.state} busy=${!isGoalOver(goal)} bad=${bad} words=${words} />`;
}

/** @param {{goal: GoalView}} props */
function Cancel({ goal }) {
  const asked = goal.state === "canceling";
  return html`<button type="button" class="button small" disabled=${asked || !mayAct.value} onClick=${() => cancelGoal(goal.operation)}>
    ${t(asked ? "actions.cancelling" : "cancel")}</button>`;
}

/** @param {{goal: GoalView}} props a bar while it is under way, as far as its feedback tells */
function Progress({ goal }) {
  if (isGoalOver(goal)) return null;
  const answer = progressOf(goal.feedback.map(({ values }) => plainOf(values)));
  const percent = answer && Math.round(answer.share * 100);
  return html`<div class="goal-progress"><${ProgressBar} label=${t("actions.progress")} done=${answer?.share ?? 0} total=${answer ? 1 : 0} />
    ${percent !== null && html`<span class="goal-percent">${percent} %</span>`}</div>`;
}

/** @param {{goal: GoalView}} props the newest first */
function Log({ goal }) {
  const shown = goal.feedback.slice(-LOG_SHOWN).reverse();
  return html`<details class="operation-history"><summary>${t("actions.log", { count: goal.feedback_count })}</summary>
    <ol class="operation-log">${shown.map((one) => html`<li key=${one.number}><span class="goal-time">${one.after_s.toFixed(1)} s</span><span>${shortOf(plainOf(one.values))}</span></li>`)}</ol></details>`;
}

/** Goals of this action that somebody else sent, as its server tells. */
function Others() {
  const others = goalStatuses.value.filter((one) => !one.is_ours);
  if (others.length === 0) return null;
  return html`<section class="goals-others" aria-label=${t("actions.others")}><h4>${t("actions.others")}</h4>
    <ul>${others.map((one) => html`<li key=${one.goal_id}><code>${one.goal_id.slice(0, 8)}</code> ${t(`actions.${one.state}`, { time: "" })}</li>`)}</ul></section>`;
}

/** The newest first. @type {Signal<readonly GoalStatusView[]>} */
const goalStatuses = signal([]);
const refused = signal("");
let action = "";

const follow = askedWhenChanged(async () => {
  const name = action;
  const answer = await askOrKeepWhy({ type: "get_goal_statuses", name }, refused);
  if (answer?.type === "goal_statuses" && name === action) goalStatuses.value = answer.goals;
}, "goal_statuses");

/** @param {string} name of the action @returns {() => void} the end of looking */
function followStatuses(name) {
  action = name;
  goalStatuses.value = [];
  return follow();
}

const SHARE =
  /(^|_)(progress|percent|percentage|pct|completion|completed|complete|fraction|ratio)(_|$)/i;
const OF_HUNDRED = /(^|_)(percent|percentage|pct)(_|$)/i;
const LEFT = /(^|_)(remaining|left|to_go)(_|$)/i;
const DEPTH_MAX = 3;

/**
 * How far a goal is, as its feedback tells: a share of the whole, or what is left of it.
 *
 * @param {readonly unknown[]} log feedback as plain values, the oldest first
 * @returns {{name: string, share: number} | null} 0 to 1; null: no field tells it
 */
export function progressOf(log) {
  const newest = leavesOf(log.at(-1), "", 0);
  const answer = newest.find(({ name }) => SHARE.test(name));
  if (answer) return { name: answer.name, share: within(answer.value / scaleOf(log, answer.name)) };
  const left = newest.find(({ name }) => LEFT.test(name));
  if (!left) return null;
  const most = Math.max(...valuesOf(log, left.name));
  return most > 0 ? { name: left.name, share: within(1 - left.value / most) } : null;
}

/** @param {readonly unknown[]} log @param {string} name 100 where it is told in percent */
function scaleOf(log, name) {
  return OF_HUNDRED.test(name) || valuesOf(log, name).some((value) => value > 1) ? 100 : 1;
}

/** @param {readonly unknown[]} log @param {string} name @returns {number[]} */
function valuesOf(log, name) {
  return log.flatMap((one) =>
    leavesOf(one, "", 0)
      .filter((leaf) => leaf.name === name)
      .map(({ value }) => value),
  );
}

/** @param {unknown} value @param {string} name @param {number} depth @returns {{name: string, value: number}[]} numbers by the names of their fields */
function leavesOf(value, name, depth) {
  if (typeof value === "number") return [{ name, value }];
  if (typeof value !== "object" || value === null || Array.isArray(value) || depth > DEPTH_MAX)
    return [];
  return Object.entries(value).flatMap(([key, inner]) => leavesOf(inner, key, depth + 1));
}

/** @param {number} share */
const within = (share) => Math.min(Math.max(share, 0), 1);
