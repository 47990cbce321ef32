/** The demos of a lesson: how each fares, its start and stop, and its keys. */

/** @import { DemoView, LessonView, PressKey } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { isUnconnected } from "../app/connect-first.js";
import { t } from "../lib/i18n.js";
import { shortTime } from "../lib/times.js";
import { Icon } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { demos, elsewhere, isUnderWay, pressKey, startDemos, stopDemo } from "../model/lessons.js";
import { connectRos, ros } from "../model/ros.js";

/** @param {{parts: readonly LessonView[]}} props in the order in which they are started */
export function LessonRuns({ parts }) {
  const waiting = parts.map(({ demo }) => demo).filter((demo) => !isThere(demo));
  const canStart = mayEdit.value && !isUnconnected();
  return html`<section class="lesson-runs" aria-label=${t("lessons.demos")}>
    ${isUnconnected() && html`<${Connect} />`}
    <ul>${parts.map((one) => html`<${Run} key=${one.demo} lesson=${one} />`)}</ul>
    ${canStart && parts.length > 1 && waiting.length > 1 && html`<${StartAll} waiting=${waiting} />`}
    ${!mayEdit.value && html`<p class="note">${t("lessons.viewer")}</p>`}
  </section>`;
}

/** @param {string} demo */
const isThere = (demo) => isUnderWay(demo) || elsewhere.value.includes(demo);

/** What is missing for a start, and the click that mends it. */
function Connect() {
  const busy = useSignal(false);
  const connect = async () => {
    busy.value = true;
    await connectRos();
    busy.value = false;
  };
  const isOnTheWay = busy.value || ros.value.state === "connecting";
  return html`<p class="lesson-connect"><span>${t("ros.first")}</span>
    ${
      mayEdit.value &&
      html`<button type="button" class="button primary small" disabled=${isOnTheWay} onClick=${connect}>
      ${isOnTheWay ? html`<span class="spinner"></span>` : html`<${Icon} name="link" size=${13} />`}${t("ros.connect")}</button>`
    }</p>`;
}

/** @param {{waiting: readonly string[]}} props */
function StartAll({ waiting }) {
  return html`<button type="button" class="button" onClick=${() => startDemos(waiting)}>
    <${Icon} name="animate" size=${13} />${t("lessons.start_all", { count: waiting.length })}</button>`;
}

/** @param {{lesson: LessonView}} props */
function Run({ lesson }) {
  const { demo, node, has_keys: hasKeys } = lesson;
  const view = demos.value.get(demo);
  const isStranger = elsewhere.value.includes(demo) && !isUnderWay(demo);
  return html`<li class="lesson-run"><div class="lesson-run-line">
      <div class="lesson-run-names"><strong>${demo}</strong><span class="muted" title=${node}>${node}</span></div>
      ${!isStranger && html`<${Buttons} demo=${demo} />`}</div>
    ${isStranger ? html`<p class="note">${t("lessons.elsewhere", { node })}</p>` : html`<${State} view=${view} />`}
    ${hasKeys && mayEdit.value && view?.state === "running" && html`<${Keys} demo=${demo} />`}</li>`;
}

/** @param {{demo: string}} props */
function Buttons({ demo }) {
  const busy = useSignal(false);
  if (!mayEdit.value) return null;
  const during = (/** @type {() => Promise<unknown>} */ run) => async () => {
    busy.value = true;
    await run();
    busy.value = false;
  };
  if (isUnderWay(demo))
    return html`<button type="button" class="button small" disabled=${busy.value} aria-label=${t("lessons.stop.of", { demo })} onClick=${during(() => stopDemo(demo))}>
      <${Icon} name="stop" size=${12} />${t("lessons.stop")}</button>`;
  return html`<button type="button" class="button small primary" disabled=${busy.value || isUnconnected()} aria-label=${t("lessons.start.of", { demo })} onClick=${during(() => startDemos([demo]))}>
    <${Icon} name="animate" size=${12} />${t("lessons.start")}</button>`;
}

/** @param {{view: DemoView | undefined}} props how it fares; nothing, of one that was never started */
function State({ view }) {
  if (!view) return null;
  const isBusy = view.state === "starting" || view.state === "stopping";
  const isBad = view.state === "ended" && view.code !== 0;
  return html`<p class=${`lesson-state ${isBad ? "bad" : ""}`} role="status">
    ${isBusy ? html`<span class="spinner"></span>` : html`<span class=${`lessons-dot ${view.state}`}></span>`}<span>${stateWords(view)}</span></p>`;
}

/** @param {DemoView} view @returns {string} */
function stateWords({ state, for_s, code, reason }) {
  if (state !== "ended") return t(`lessons.state.${state}`, { time: shortTime(for_s) });
  if (code === 0) return t("lessons.state.ended");
  if (code < 0) return t("lessons.state.killed", { signal: -code });
  return t("lessons.state.failed", { code, reason });
}

/** @type {readonly {pressed: PressKey["pressed"], key: string, face: string}[]} */
const KEYS = [
  { pressed: "up", key: "ArrowUp", face: "↑" },
  { pressed: "down", key: "ArrowDown", face: "↓" },
  { pressed: "left", key: "ArrowLeft", face: "←" },
  { pressed: "right", key: "ArrowRight", face: "→" },
  .../** @type {const} */ (["g", "t", "r", "e", "d", "c", "v", "b", "f"]).map((pressed) => ({
    pressed,
    key: pressed,
    face: pressed.toUpperCase(),
  })),
];

/** The keys that drive it: by clicks, and by themselves while one of these has the focus. @param {{demo: string}} props */
function Keys({ demo }) {
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    const found = KEYS.find(({ key }) => key === event.key || key === event.key.toLowerCase());
    if (!found || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    void pressKey(demo, found.pressed);
  };
  return html`<div class="lesson-keys" role="group" aria-label=${t("lessons.keys", { demo })} title=${t("lessons.keys.hint")} onKeyDown=${onKeyDown}>${KEYS.map(
    ({ pressed, face }) =>
      html`<button key=${pressed} type="button" class="button small" aria-label=${pressed} onClick=${() => pressKey(demo, pressed)}>${face}</button>`,
  )}</div>`;
}
