/** Bags: what is shown of one, recording the live system into the next, and those that there are. */

/** @import { Bookmark, RecordedTopicView, TimeState } from "../../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { language, t } from "../../lib/i18n.js";
import { LongList } from "../../lib/long-list.js";
import { shownNumber } from "../../lib/numbers.js";
import { TextBox } from "../../lib/slider.js";
import { sinceStart, sizeWords } from "../../lib/timeline.js";
import { Icon, IconButton, LongName, MenuButton, SearchBox, Segments } from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayEdit, mayManage } from "../../model/connection.js";
import { addDisplay } from "../../model/live-displays.js";
import { useNumberPaths } from "../../model/number-paths.js";
import { plot } from "../../model/plotting.js";
import { bagPart, bags, cutBag, followBags, isRecording } from "../../model/recording.js";
import {
  bookmarks,
  bookmarkTrouble,
  followNow,
  markTopic,
  mayMoveTime,
  removeBookmark,
  renameBookmark,
  seekTime,
  timeState,
  timeTopics,
  wholeTime,
} from "../../model/time.js";
import { chosenTopic, followTopics, topics } from "../../model/topics.js";
import { ConnectFirst, isUnconnected, NothingThere } from "../parts.js";
import { beginDrag, endDrag } from "../topic-drag.js";
import { BagList } from "./bag-list.js";
import { RecordPart, SavePast, Writing } from "./record.js";

export function BagPanel() {
  const { panel, looking } = useLooking(followTopics);
  const badge =
    isRecording.value && html` <span class="bag-running" aria-label=${t("bag.running")}></span>`;
  const of = /** @type {const} */ ([
    ["contents", t("bag.part.contents")],
    ["record", html`${t("bag.part.record")}${badge}`],
    ["bags", t("bag.part.bags")],
  ]);
  return html`<section ref=${panel} class="panel-body bag" aria-label=${t("panel.bag")}>
    <div class="panel-bar row"><${Segments} label=${t("panel.bag")} chosen=${bagPart} of=${of} /></div>
    <${Writing} />
    ${bagPart.value === "contents" && html`<${Contents} looking=${looking} />`}
    ${bagPart.value === "record" && html`<${RecordPart} />`}
    ${bagPart.value === "bags" && html`<${BagList} />`}
  </section>`;
}

/** @param {{looking: boolean}} props */
function Contents({ looking }) {
  const state = timeState.value;
  if (!state)
    return html`<${NothingThere} icon="bag" title=${t("bag.no_document")}><${OpenButton} /><//>`;
  if (state.mode === "live" && isUnconnected())
    return html`<div class="scroll"><${ConnectFirst} icon="bag" /><p class="bag-or"><${OpenButton} /></p></div>`;
  return html`<div class="scroll bag-contents">
    <${Facts} state=${state} looking=${looking} />
    <${Troubles} of=${state.troubles} />
    ${state.mode !== "bag" && html`<${SavePast} />`}
    <${Clip} state=${state} />
    <${BookmarkList} state=${state} />
    <${Topics} state=${state} />
  </div>`;
}

function OpenButton() {
  const open = commandById("open_bag");
  if (!open?.enabled?.()) return null;
  return html`<button type="button" class="button" onClick=${open.run}><${Icon} name="bag" />${t("command.open_bag")}…</button>`;
}

/** As `ros2 bag info` says it. @param {{state: TimeState, looking: boolean}} props */
function Facts({ state, looking }) {
  useEffect(() => (looking ? followNow() : undefined), [looking]);
  useEffect(
    () => (looking && state.mode === "bag" ? followBags() : undefined),
    [looking, state.path],
  );
  const { from_s, to_s } = wholeTime.value;
  const count = timeTopics.value.reduce((sum, one) => sum + one.count, 0);
  const listed = bags.value?.bags.find(({ path }) => path === state.path);
  const begin = new Date((state.zero_s + from_s) * 1000);
  const kept = t("bag.kept", {
    done: Math.round(state.kept_bytes / MEGABYTE),
    total: Math.round(state.kept_bytes_max / MEGABYTE),
  });
  return html`<dl class="bag-facts">
    <div><dt>${t("bag.shown")}</dt><dd class="bag-path">${state.mode === "bag" ? html`<b>${state.title}</b> <bdi class="muted">${state.path}</bdi>` : html`<b>${t("bag.last_minutes")}</b> <span class="muted">${kept}</span>`}</dd></div>
    <div><dt>${t("bag.duration")}</dt><dd class="numbers">${sinceStart(Math.max(to_s - from_s, 0), 3)}</dd></div>
    ${state.zero_s > EPOCH_FROM_S && html`<div><dt>${t("bag.begin")}</dt><dd class="numbers">${begin.toLocaleString(language.value)}</dd></div>`}
    ${listed && html`<div><dt>${t("bag.size")}</dt><dd class="numbers">${sizeWords(listed.bytes)}</dd></div>`}
    <div><dt>${t("bag.messages")}</dt><dd class="numbers">${count.toLocaleString(language.value)}</dd></div>
  </dl>`;
}

const MEGABYTE = 1 << 20;
const EPOCH_FROM_S = 1e9;

/** @param {{of: readonly string[]}} props what of a damaged file cannot be shown */
function Troubles({ of }) {
  if (of.length === 0) return null;
  return html`<section class="bag-troubles" role="status"><h3><${Icon} name="alert" size=${14} />${t("bag.troubles", { count: of.length })}</h3>
    <ul>${of.map((one) => html`<li key=${one}>${one}</li>`)}</ul></section>`;
}

/** The part between the ends of the loop, as a bag of its own. @param {{state: TimeState}} props */
function Clip({ state }) {
  const busy = useSignal(false);
  const name = useSignal("");
  const [from_s, to_s] = state.loop ?? [];
  if (from_s === undefined || to_s === undefined)
    return html`<p class="note bag-note"><${Icon} name="scissors" size=${13} />${t("bag.clip.hint")}</p>`;
  const cut = async (/** @type {Event} */ event) => {
    event.preventDefault();
    busy.value = true;
    if (await cutBag({ from_s, to_s }, [], name.value.trim())) name.value = "";
    busy.value = false;
  };
  const span = `${sinceStart(from_s - state.begin_s, 2)} – ${sinceStart(to_s - state.begin_s, 2)}`;
  return html`<form class="bag-clip" onSubmit=${cut}>
    <span class="bag-clip-span"><${Icon} name="scissors" size=${14} />${t("bag.clip", { span })}</span>
    <input class="box" aria-label=${t("bag.name")} placeholder=${t("bag.name.auto")} maxlength="200" spellcheck=${false} value=${name.value} onInput=${(
      /** @type {any} */ event,
    ) => {
      name.value = event.currentTarget.value;
    }} />
    <button type="submit" class="button small" disabled=${busy.value || !mayManage.value} title=${mayManage.value ? null : t("bag.viewer")}>${busy.value && html`<span class="spinner"></span>`}${t("bag.clip.save")}</button>
  </form>`;
}

/** @param {{state: TimeState}} props */
function BookmarkList({ state }) {
  const all = bookmarks.value;
  if (all.length === 0)
    return html`<p class="note bag-note"><${Icon} name="bookmark" size=${13} />${t("bag.bookmarks.hint")}</p>`;
  return html`<section class="bag-bookmarks"><h3>${t("bag.bookmarks")}</h3>
    ${bookmarkTrouble.value && html`<p class="note bad">${bookmarkTrouble.value}</p>`}
    <ul>${all.map((one, n) => html`<${BookmarkRow} key=${`${one.at_s} ${n}`} one=${one} begin_s=${state.begin_s} />`)}</ul></section>`;
}

/** @param {{one: Bookmark, begin_s: number}} props */
function BookmarkRow({ one, begin_s }) {
  const may = mayMoveTime.value;
  const time = sinceStart(one.at_s - begin_s, 1);
  return html`<li>
    <button type="button" class="text-button numbers" disabled=${!may} title=${t("bag.bookmark.go", { name: one.name })} onClick=${() => seekTime(one.at_s)}>${time}</button>
    <${TextBox} label=${t("bag.bookmark.name", { time })} text=${one.name} class="wide" disabled=${!may} onWrite=${(
      /** @type {string} */ name,
    ) => renameBookmark(one, name.trim().slice(0, NAME_MAX))} />
    <${IconButton} icon="trash" size=${14} label=${t("bag.bookmark.remove", { name: one.name })} disabled=${!may} onClick=${() => removeBookmark(one)} />
  </li>`;
}

const NAME_MAX = 200;
const UNIT = "Hz";

/** @param {{state: TimeState}} props */
function Topics({ state }) {
  const words = useSignal("");
  const all = timeTopics.value;
  const wanted = words.value.toLowerCase();
  const shown = all.filter(({ name, type_name: type }) =>
    `${name} ${type}`.toLowerCase().includes(wanted),
  );
  const seconds = state.end_s - state.begin_s;
  return html`<section class="bag-topics"><header><h3>${t("bag.topics", { count: all.length })}</h3>
    <${SearchBox} label=${t("topics.filter")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} /></header>
    ${all.length === 0 && html`<p class="note">${t("bag.topics.none")}</p>`}
    ${all.length > 0 && shown.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: words.value })}</p>`}
    ${
      shown.length > 0 &&
      html`<table class="topics-table bag-table" aria-label=${t("bag.topics", { count: all.length })}>
      <thead><tr><th scope="col">${t("topics.name")}</th><th scope="col" class="type">${t("topics.type")}</th>
        <th scope="col" class="number">${t("bag.count")}</th><th scope="col" class="number rate">${UNIT}</th><th scope="col" class="acts"><span class="hidden-words">${t("bag.acts")}</span></th></tr></thead>
      <${LongList} items=${shown} keyOf=${(/** @type {RecordedTopicView} */ { name }) => name} row="var(--row)" inTable
        isKept=${(/** @type {RecordedTopicView} */ { name }) => name === markTopic.value}
        draw=${(/** @type {RecordedTopicView} */ topic) => html`<${TopicRow} key=${topic.name} topic=${topic} seconds=${seconds} />`} /></table>`
    }</section>`;
}

/** As many as a menu shows without hiding the page. */
const PATHS_SHOWN = 40;

/** The numbers of a topic, each drawn over time; nothing where its type has none. @param {{topic: RecordedTopicView}} props */
function PlotMenu({ topic: { name, type_name: type } }) {
  const paths = useNumberPaths(type);
  if (paths.length === 0) return null;
  const items = () =>
    paths
      .slice(0, PATHS_SHOWN)
      .map((path) => ({ label: path.slice(1), icon: "plot", run: () => plot(name, path) }));
  return html`<${MenuButton} class="icon-button narrow" label=${t("bag.plot", { topic: name })} items=${items}><${Icon} name="plot" size=${14} /><//>`;
}

/** @param {{topic: RecordedTopicView, seconds: number}} props */
function TopicRow({ topic, seconds }) {
  const { name, type_name: type, count, latched, trouble, note } = topic;
  const kind = topics.value?.find((one) => one.name === name)?.kind ?? "";
  const isMarked = markTopic.value === name;
  const rate =
    seconds > 0 && count > 1 && !latched
      ? shownNumber(Number((count / seconds).toPrecision(3)))
      : "–";
  const echo = () => {
    chosenTopic.value = name;
    commandById("panel.topics")?.run();
  };
  const mark = () => {
    markTopic.value = isMarked ? "" : name;
  };
  return html`<tr class=${isMarked ? "chosen" : ""} title=${[name, type, trouble, note].filter(Boolean).join("\n")} draggable=${true}
    onDragStart=${(/** @type {DragEvent} */ event) => beginDrag(event, { topic: name, type, kind, path: "" })} onDragEnd=${endDrag}>
    <th scope="row"><span class="bag-topic-name">${(trouble || note) && html`<span class=${trouble ? "bag-bad" : "bag-noted"}><${Icon} name=${trouble ? "alert" : "info"} size=${12} /><span class="hidden-words">${trouble || note}</span></span>`}<${LongName} text=${name} /></span></th>
    <td class="type"><${LongName} text=${type.replace("/msg/", "/")} /></td>
    <td class="number">${count.toLocaleString(language.value)}</td>
    <td class="number rate">${latched ? t("topics.latched") : rate}</td>
    <td class="acts">
      <${IconButton} icon="pin" size=${14} class="narrow" label=${t("bag.mark", { topic: name })} pressed=${isMarked} onClick=${mark} />
      <${IconButton} icon="topics" size=${14} class="narrow" label=${t("bag.echo", { topic: name })} disabled=${trouble !== ""} onClick=${echo} />
      ${trouble === "" && html`<${PlotMenu} topic=${topic} />`}
      ${kind && mayEdit.value && html`<${IconButton} icon="scene" size=${14} class="narrow" label=${t("topics.show", { kind })} onClick=${() => addDisplay(kind, name)} />`}
    </td></tr>`;
}
