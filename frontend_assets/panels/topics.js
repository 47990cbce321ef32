/** The topics of a ROS 2 system: how each comes, who is at its ends, and what it says now. */

/** @import { TopicRow } from "../types/wire.d.ts" */
/** @import { TopicOrder } from "../model/topics.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../app/connect-first.js";
import { t } from "../lib/i18n.js";
import { useSeen } from "../lib/seen.js";
import { IconButton, ProgressBar, SearchBox } from "../lib/ui.js";
import { ros } from "../model/ros.js";
import {
  chosenTopic,
  followTopics,
  isNoise,
  shownTopics,
  showsNoise,
  topics,
  useTopicRates,
} from "../model/topics.js";
import { TopicEcho } from "./topics-echo.js";
import { TopicTable } from "./topics-table.js";

export function TopicsPanel() {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (now) => {
    seen.value = now;
  });
  const looks = seen.value && !isUnconnected();
  useEffect(() => (looks ? followTopics() : undefined), [looks]);
  return html`<section ref=${panel} class="panel-body topics" aria-label=${t("panel.topics")}>
    <${RouterAway} />
    ${isUnconnected() ? html`<${ConnectFirst} icon="topics" />` : html`<${Content} seen=${looks} />`}
  </section>`;
}

/** @param {{seen: boolean}} props a panel that nobody sees hears nothing */
function Content({ seen }) {
  const words = useSignal("");
  const order = useSignal(/** @type {TopicOrder} */ ("name"));
  const all = topics.value;
  const names = useRef(/** @type {readonly string[]} */ ([]));
  const rates = useTopicRates(() => names.current);
  const wished = { words: words.value, noise: showsNoise.value, order: order.value };
  const rows = shownTopics(all ?? [], { ...wished, rates: rates.value });
  names.current = seen ? rows.map(({ name }) => name) : [];
  return html`<div class="topics-parts">
    <div class="topics-list">
      <div class="panel-bar"><${SearchBox} label=${t("topics.filter")} value=${words.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        words.value = text;
      }} /><${NoiseButton} all=${all ?? []} /></div>
      ${all === null && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
      ${all !== null && rows.length > 0 && html`<${TopicTable} rows=${rows} rates=${rates.value} order=${order} />`}
      ${all !== null && rows.length === 0 && html`<${Nothing} all=${all} words=${words.value} />`}
    </div>
    ${chosenTopic.value && seen && html`<${TopicEcho} key=${chosenTopic.value} topic=${chosenTopic.value} row=${all?.find(({ name }) => name === chosenTopic.value)} />`}
  </div>`;
}

/** @param {{all: readonly TopicRow[]}} props */
function NoiseButton({ all }) {
  const count = all.filter(({ name }) => isNoise(name)).length;
  const shown = showsNoise.value;
  return html`<${IconButton} icon=${shown ? "eye" : "eyeOff"} label=${t("topics.noise")} hint=${t("topics.noise.hint", { count })} pressed=${shown} onClick=${() => {
    showsNoise.value = !shown;
  }} />`;
}

/** @param {{all: readonly TopicRow[], words: string}} props why there is no row, and what to do */
function Nothing({ all, words }) {
  if (words !== "") return html`<p class="nothing">${t("filter.nothing", { words })}</p>`;
  if (all.length === 0)
    return html`<${NothingThere} icon="topics" title=${t("live.add.no_topics", { endpoint: ros.value.endpoint })}><p>${t("live.add.demo")}</p><//>`;
  const show = () => {
    showsNoise.value = true;
  };
  return html`<${NothingThere} icon="topics" title=${t("topics.only_noise", { count: all.length })}><button type="button" class="button" onClick=${show}>${t("topics.noise")}</button><//>`;
}
