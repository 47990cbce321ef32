/** The topics of a ROS 2 system: how each comes, who is at its ends, and what it says now. */

/** @import { TopicRate, TopicRow } from "../../types/wire.d.ts" */
/** @import { TopicOrder } from "../../model/topics.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { rateWords } from "../../lib/live-displays.js";
import { LongList } from "../../lib/long-list.js";
import { useSeen } from "../../lib/seen.js";
import { Icon, IconButton, LongName, ProgressBar, SearchBox } from "../../lib/ui.js";
import { ros } from "../../model/ros.js";
import {
  ageWords,
  bandWords,
  chosenTopic,
  followTopics,
  isNoise,
  listening,
  shortTypes,
  shownTopics,
  showsNoise,
  topics,
  useTopicRates,
} from "../../model/topics.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../parts.js";
import { beginDrag, endDrag } from "../topic-drag.js";
import { TopicEcho } from "./echo.js";

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

/** @param {string} name */
const rowId = (name) => `topic-${name}`;

/** @param {string} topic look at it; how it is listened to fits its publishers again */
function chooseTopic(topic) {
  if (chosenTopic.value === topic) return;
  listening.value = { reliable: null, latched: null };
  chosenTopic.value = topic;
}

/** @param {{rows: readonly TopicRow[], rates: ReadonlyMap<string, TopicRate>, order: Signal<TopicOrder>}} props */
function TopicTable({ rows, rates, order }) {
  const chosen = chosenTopic.value;
  // What it says now takes the half of the room in which its row may have been.
  useEffect(() => {
    const frame = requestAnimationFrame(() =>
      document.getElementById(rowId(chosen ?? ""))?.scrollIntoView({ block: "nearest" }),
    );
    return () => cancelAnimationFrame(frame);
  }, [chosen]);
  const focusable = rows.some(({ name }) => name === chosen) ? chosen : rows[0]?.name;
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const at = rows.findIndex(({ name }) => rowId(name) === document.activeElement?.id);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: rows.length - 1 }[event.key];
    if (at < 0) return;
    if (event.key === "Enter" || event.key === " ") chooseTopic(rows[at]?.name ?? "");
    else if (to === undefined) return;
    else document.getElementById(rowId(rows[to]?.name ?? ""))?.focus();
    event.preventDefault();
  };
  return html`<div class="scroll" onKeyDown=${onKeyDown}><table class="topics-table" aria-label=${t("panel.topics")} aria-rowcount=${rows.length + 1}>
    <thead><tr>
      <${Head} order=${order} by="name" words=${t("topics.name")} />
      <${Head} order=${order} by="type" words=${t("topics.type")} class="type" />
      <th scope="col" class="number ends" title=${t("topics.ends.hint")}>${t("topics.ends")}</th>
      <${Head} order=${order} by="rate" words="Hz" class="number" />
      <${Head} order=${order} by="band" words=${t("topics.band")} class="number band" />
      <th scope="col" class="number age">${t("topics.age")}</th>
    </tr></thead>
    <${LongList} items=${rows} keyOf=${(/** @type {TopicRow} */ { name }) => name} row="var(--row)" inTable
      isKept=${(/** @type {TopicRow} */ { name }) => name === focusable}
      draw=${(/** @type {TopicRow} */ row) =>
        html`<${Row} key=${row.name} row=${row} rate=${rates.get(row.name)} focusable=${row.name === focusable} />`} />
  </table></div>`;
}

/** @param {{order: Signal<TopicOrder>, by: TopicOrder, words: string, class?: string}} props */
function Head({ order, by, words, class: names = "" }) {
  const isChosen = order.value === by;
  const sorted = by === "rate" || by === "band" ? "descending" : "ascending";
  return html`<th scope="col" class=${names} aria-sort=${isChosen ? sorted : "none"}><button type="button" class="sort" onClick=${() => {
    order.value = by;
  }}>${words}${isChosen && html`<${Icon} name="chevronDown" size=${12} />`}</button></th>`;
}

/** @param {{row: TopicRow, rate: TopicRate | undefined, focusable: boolean}} props */
function Row({ row, rate, focusable }) {
  const { name, types, publishers, subscribers, kind } = row;
  const isChosen = chosenTopic.value === name;
  const what = { topic: name, type: types[0] ?? "", kind, path: "" };
  return html`<tr id=${rowId(name)} class=${isChosen ? "chosen" : ""} tabindex=${focusable ? 0 : -1} aria-selected=${isChosen} draggable=${true}
    title=${[name, ...types].join("\n")} onClick=${() => chooseTopic(name)}
    onDragStart=${(/** @type {DragEvent} */ event) => beginDrag(event, what)} onDragEnd=${endDrag}>
    <th scope="row"><${LongName} text=${name} /></th>
    <td class="type"><${LongName} text=${shortTypes(types)} /></td>
    <td class="number ends" title=${t("topics.ends.text", { publishers, subscribers })}>${publishers} → ${subscribers}</td>
    <td class="number"><${Rate} publishers=${publishers} rate=${rate} /></td>
    <td class="number band">${bandWords(rate?.bytes_per_s ?? 0) || "–"}</td>
    <td class="number age">${ageWords(rate) || "–"}</td>
  </tr>`;
}

/** @param {{publishers: number, rate: TopicRate | undefined}} props a word where nothing comes, for a dash alone tells nobody why */
function Rate({ publishers, rate }) {
  if (publishers === 0) return html`<span class="muted">${t("topics.unpublished")}</span>`;
  if (rate?.state === "silent")
    return html`<span class="topics-silent">${t("topics.silent")}</span>`;
  if (rate?.state === "latched") return html`<span class="muted">${t("topics.latched")}</span>`;
  return rateWords(rate?.rate_hz ?? 0) || "–";
}
