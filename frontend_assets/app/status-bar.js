/** The bar below: is the studio there, how was the robot made, what is wrong, what is unsaved. */

import { html, useEffect } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { connection, mayManage, role, version } from "../model/connection.js";
import { isCopy } from "../model/copies.js";
import {
  built,
  documentState,
  history,
  problems,
  progress,
  robot,
  showingLastGood,
} from "../model/document.js";
import { followOperations, repeatedPublications } from "../model/operations.js";
import { studioAway } from "../model/relays.js";
import { connectRos, ros } from "../model/ros.js";
import { heldBack } from "../model/source.js";
import { dialog } from "../model/view.js";
import { viewport, viewportConnected } from "../model/viewport.js";

export function StatusBar() {
  return html`<footer class="status-bar" aria-label=${t("status")}>
    <${Link} />
    <${Evaluator} />
    <${Size} />
    <${Work} />
    <span class="push"></span>
    <${PublishingStatus} />
    <${RosStatus} />
    <${Build} />
    <${ProblemsLink} />
    <${Unsaved} />
  </footer>`;
}

function Link() {
  const state = studioAway.value ? "away" : connection.value;
  const words = state === "connected" ? t(`role.${role.value}`) : t(`connection.${state}`);
  const hint = version.value ? t("version", { version: version.value }) : "";
  return html`<span class=${`link-state ${state}`} title=${hint}><span class="dot"></span>${words}</span>`;
}

function Evaluator() {
  const state = documentState.value;
  if (!state || state.evaluator === "" || state.phase !== "ready") return null;
  const fallback = state.fallback_reason !== "";
  return html`<span class=${`wide-only ${fallback ? "amber" : ""}`} title=${state.fallback_reason || t("evaluator.hint")}>
    ${fallback ? t("evaluator.fallback", { name: state.evaluator }) : t("evaluator", { name: state.evaluator })}</span>`;
}

/** How much of a robot it is. */
function Size() {
  if (!robot.value || documentState.value?.is_bare) return null;
  const [links, joints] = [robot.value.links.length, robot.value.joints.length];
  return html`<span class="wide-only"><b>${links}</b> ${t("links", { count: links })} · <b>${joints}</b> ${t("joints", { count: joints })}</span>`;
}

function Work() {
  const work = [...progress.value.values()][0];
  if (!work) {
    const waits =
      connection.value === "connected" && viewport.value !== null && !viewportConnected.value;
    return waits ? html`<span class="wide-only">${t("scene.connecting")}</span>` : null;
  }
  return html`<span class="working"><span class="spinner"></span>${work.label}${work.total > 0 ? ` ${work.done}/${work.total}` : ""}</span>`;
}

function Build() {
  if (heldBack.value) return null;
  if (showingLastGood.value)
    return html`<span class="bad"><${Icon} name="close" size=${13} />${t("build.failed")}</span>`;
  const run = built.value;
  if (!run) return null;
  if (!run.ok)
    return html`<span class="bad"><${Icon} name="close" size=${13} />${t("build.bad")}</span>`;
  return html`<span class="good numbers"><${Icon} name="check" size=${13} />${t("build.ok", { ms: run.duration_ms < 9.95 ? run.duration_ms.toFixed(1) : Math.round(run.duration_ms) })}</span>`;
}

function ProblemsLink() {
  const count = problems.value.length;
  const bad = !heldBack.value && problems.value.some(({ severity }) => severity === "error");
  const hindered = problems.value.some(({ severity }) => severity !== "info");
  return html`<button type="button" class=${`status-button ${bad ? "bad" : hindered ? "amber" : ""}`} onClick=${() => commandById("panel.problems")?.run()}>
    ${t("problems.count", { count })}</button>`;
}

function Unsaved() {
  const { unsaved_count: count, unsaved_files: files } = history.value;
  if (count === 0 || isCopy.value) return null;
  return html`<span class="amber" title=${files.join("\n")}><span class="dot"></span>${t("unsaved.count", { count })}</span>`;
}

/** What this studio publishes at a rate: seen from any panel, and one click from its end. */
function PublishingStatus() {
  const isJoined = ros.value.state === "connected";
  useEffect(() => (isJoined ? followOperations("publications") : undefined), [isJoined]);
  const all = repeatedPublications.value;
  const [first] = all;
  if (!isJoined || !first) return null;
  const shown =
    all.length === 1
      ? t("publishing.topic", { topic: first.name, rate: first.rate_hz })
      : t("publishing.many", { count: all.length });
  const hint = all.map(({ name, rate_hz: rate }) => t("publishing.topic", { topic: name, rate }));
  return html`<button type="button" class="status-button amber" title=${[...hint, t("publishing.hint")].join("\n")}
    onClick=${() => commandById("panel.publish")?.run()}><${Icon} name="send" size=${13} />${shown}</button>`;
}

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
function RosStatus() {
  const isFound = ros.value.nearby_count > 0 && mayManage.value;
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class=${`status-button ros-status ${tone()}`} title=${t("ros.details")} onClick=${show}>
    <${Icon} name="link" size=${13} />${t("ros.bar", { state: inShort() })}</button>
    ${isFound && html`<button type="button" class="status-button connect" aria-label=${t("ros.connect.bar")} onClick=${connectRos}>${t("ros.connect")}</button>`}`;
}
