/** Messages that a person publishes: by a form, once or so often a second, each seen and stopped by everybody. */

/** @import { OfferView, PublicationView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { PastedLine } from "../../lib/ros2-lines.js" */

import { html, signal, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { parseNumber } from "../../lib/numbers.js";
import { TextBox } from "../../lib/slider.js";
import { Icon } from "../../lib/ui.js";
import { askedWhenChanged, askOrKeepWhy } from "../../model/asking.js";
import { mayAct } from "../../model/connection.js";
import { publishForm, publishing } from "../../model/message-forms.js";
import {
  followOperations,
  publications,
  publish,
  repeatedPublications,
  stopPublishing,
} from "../../model/operations.js";
import {
  Offers,
  OperationForm,
  OperationPanel,
  OperationState,
  openLine,
} from "../operation-panel.js";

/** Null: not known yet. @type {Signal<readonly OfferView[] | null>} */
const publishable = signal(null);
const publishableRefused = signal("");

/** Ask now. */
async function askPublishable() {
  const answer = await askOrKeepWhy({ type: "list_topics" }, publishableRefused);
  if (answer?.type === "topic_table")
    publishable.value = answer.topics.map(({ name, types }) => ({ name, types, nodes: [] }));
}
const followPublishable = askedWhenChanged(askPublishable, "graph");

const FOLLOW = [followPublishable, () => followOperations("publications")];
const RATE_MAX_HZ = 1000;
const SHOWN = 8;
const EXAMPLE = "geometry_msgs/msg/Twist";
const UNIT = "Hz";

/** @param {PastedLine} line */
function onLine(line) {
  const { reliability, durability, depth } = line.qos;
  openLine(publishForm)(line);
  publishing.value = {
    rate_hz: line.rate_hz || publishing.value.rate_hz,
    reliable: reliability !== "best_effort",
    latched: durability === "transient_local",
    depth: depth ?? 10,
  };
}

export function PublishPanel() {
  return html`<${OperationPanel} id="publish" icon="send" kind="topic" follow=${FOLLOW} onLine=${onLine}>
    ${(
      /** @type {(text: string) => boolean} */ paste,
    ) => html`<div class=${`operations-parts ${publishForm.chosen.value ? "chosen" : ""}`}>
      <${Offers} id="publish" icon="send" offers=${publishable.value} refused=${publishableRefused.value} again=${askPublishable} form=${publishForm} paste=${paste}>
        <${AnotherTopic} /><${Publications} all /><//>
      ${publishForm.chosen.value && html`<${Chosen} />`}
    </div>`}
  <//>`;
}

/** A topic that nobody has yet. */
function AnotherTopic() {
  const name = useSignal("");
  const type = useSignal("");
  const isWhole = name.value !== "" && type.value !== "";
  const open = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (isWhole)
      onLine({ kind: "topic", name: name.value, type: type.value, text: "", rate_hz: 0, qos: {} });
  };
  return html`<form class="another-topic" aria-label=${t("publish.another")} onSubmit=${open}>
    <input class="box wide" aria-label=${t("publish.topic")} placeholder=${t("publish.topic")} value=${name.value} disabled=${!mayAct.value} spellcheck=${false} autocomplete="off" onInput=${(
      /** @type {any} */ event,
    ) => {
      name.value = event.currentTarget.value.trim();
    }} />
    <input class="box wide" aria-label=${t("publish.type")} placeholder=${EXAMPLE} value=${type.value} disabled=${!mayAct.value} spellcheck=${false} autocomplete="off" onInput=${(
      /** @type {any} */ event,
    ) => {
      type.value = event.currentTarget.value.trim();
    }} />
    <button type="submit" class="button small" disabled=${!isWhole || !mayAct.value}>${t("publish.take")}</button></form>`;
}

/** The topic that is chosen, and what is published on it. */
function Chosen() {
  const { rate_hz: rate } = publishing.value;
  const blocked = !mayAct.value || publishForm.wrong.value;
  const name = publishForm.chosen.value?.name;
  const repeated = repeatedPublications.value.filter((one) => one.name === name);
  return html`<div class="operations-chosen scroll">
    <${OperationForm} form=${publishForm} onSubmit=${() => publish({ once: true })} actions=${html`
      <button type="submit" class="button primary" disabled=${blocked}><${Icon} name="send" />${t("publish.once")}</button>
      ${
        repeated.length > 0
          ? html`<button type="button" class="button danger" disabled=${!mayAct.value} onClick=${() => stopAll(repeated)}><${Icon} name="stop" />${t("publish.stop.rate", { rate: repeated[0]?.rate_hz ?? 0 })}</button>`
          : html`<button type="button" class="button" disabled=${blocked} onClick=${() => publish({ once: false })}><${Icon} name="animate" />${t("publish.at", { rate, count: rate })}</button>`
      }
      <${Rate} rate=${rate} />`}><${Quality} /><//>
    <${Publications} all=${false} />
  </div>`;
}

/** @param {readonly PublicationView[]} running */
function stopAll(running) {
  for (const { operation } of running) void stopPublishing(operation);
}

/** @param {{rate: number}} props */
function Rate({ rate }) {
  const write = (/** @type {string} */ typed) => {
    const hz = parseNumber(typed);
    if (hz && hz > 0)
      publishing.value = { ...publishing.value, rate_hz: Math.min(hz, RATE_MAX_HZ) };
  };
  return html`<label class="operation-timeout">${t("publish.rate")}<${TextBox} label=${t("publish.rate.hz")} class="number narrow" text=${String(rate)} disabled=${!mayAct.value}
    number=${rate} step=${1} onWrite=${write} />${UNIT}</label>`;
}

/** Quality of service. */
function Quality() {
  const { reliable, latched } = publishing.value;
  const change = (/** @type {object} */ news) => {
    publishing.value = { ...publishing.value, ...news };
  };
  return html`<details class="operation-history"><summary>${t("publish.quality")}</summary><div class="quality">
    <label><input type="checkbox" checked=${reliable} disabled=${!mayAct.value} onChange=${() => change({ reliable: !reliable })} />${t("publish.reliable")}</label>
    <label><input type="checkbox" checked=${latched} disabled=${!mayAct.value} onChange=${() => change({ latched: !latched })} />${t("publish.latched")}</label></div></details>`;
}

/** @param {{all: boolean}} props all that run, or the last ones of the topic that is chosen */
function Publications({ all }) {
  const name = publishForm.chosen.value?.name;
  const own = publications.value.filter((one) => one.name === name);
  const running = repeatedPublications.value;
  const shown = all ? running : own.slice(-SHOWN).reverse();
  if (shown.length === 0) return null;
  return html`<section class="goals-running" aria-label=${t(all ? "publish.now" : "publish.last")}>
    <h4>${t(all ? "publish.now" : "publish.last")}
      ${all && running.length > 1 && html`<button type="button" class="button small" disabled=${!mayAct.value} onClick=${() => stopPublishing()}>${t("publish.stop_all")}</button>`}</h4>
    ${shown.map((one) => html`<${Publication} key=${one.operation} publication=${one} />`)}</section>`;
}

/** @param {{publication: PublicationView}} props */
function Publication({ publication: one }) {
  const runs = one.state === "running";
  const words = t(`publish.${one.state}`, {
    count: one.sent,
    listeners: one.listeners,
    rate: one.rate_hz,
  });
  return html`<div class="goal-line"><span class="offer-name" title=${one.text}>${one.name}</span>
    <${OperationState} state=${one.state} busy=${runs} bad=${one.state === "failed"} words=${words} />
    ${runs && html`<button type="button" class="button small" disabled=${!mayAct.value} onClick=${() => stopPublishing(one.operation)}>${t("publish.stop")}</button>`}
    ${one.trouble && html`<p class="note bad">${one.trouble}</p>`}</div>`;
}
