/** The bar at the foot of the page: the time that the document shows, played, dragged, and led back to now. */

/** @import { MenuItem } from "../lib/ui.js" */
/** @import { RecordedTopicView, TimeState } from "../types/wire.d.ts" */

import { html, useEffect } from "vendor/preact.js";
import { commandById, onMac, shortcutText } from "../lib/commands.js";
import { language, t } from "../lib/i18n.js";
import { RATES, sinceStart } from "../lib/timeline.js";
import { Icon, IconButton, MenuButton, ProgressBar } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import { clockTime } from "../model/log.js";
import {
  bookmarks,
  expandsTimeline,
  followNow,
  goLive,
  hasTimeline,
  markTopic,
  mayMoveTime,
  now_s,
  seekTime,
  setTimeRate,
  timeState,
  timeTicks,
  timeTopics,
  timeZoom,
  wholeTime,
} from "../model/time.js";
import { notify, size } from "../model/view.js";
import { bookmarkNow, showBagPart, toggleLoop } from "./timeline-commands.js";
import { isOfDay, startOf, TimelineRuler } from "./timeline-ruler.js";

const MEGABYTE = 1 << 20;
/** As many as a menu shows without hiding the page. */
const LISTED = 40;

export function Timeline() {
  const state = timeState.value;
  if (!state || !hasTimeline.value) return null;
  return html`<${Damaged} state=${state} /><${ShownTimeline} state=${state} />`;
}

/** What is damaged of a bag is said once, with the way to what is missing. @param {{state: TimeState}} props */
function Damaged({ state }) {
  const { path, title, troubles, progress } = state;
  const count = progress === null ? troubles.length : 0;
  useEffect(() => {
    if (count === 0) return;
    const run = () => showBagPart("contents");
    notify(t("timeline.troubles", { title, count }), {
      bad: true,
      action: { label: t("timeline.troubles.show"), run },
    });
  }, [path, count > 0]);
  return null;
}

/** @param {{state: TimeState}} props */
function ShownTimeline({ state }) {
  const isLive = state.mode === "live";
  if (size.value === "phone") return html`<${PhoneTimeline} state=${state} />`;
  if (isLive && !expandsTimeline.value) return html`<${LiveStrip} state=${state} />`;
  return html`<section class=${`timeline ${state.mode}`} aria-label=${t("timeline")}>
    <div class="timeline-bar">
      <${Moves} state=${state} />
      <${Clock} />
      <span class="push"></span>
      <${Waiting} state=${state} />
      <${Skipping} state=${state} />
      <${TopicChoice} />
      <${TicksMenu} />
      <${BookmarksMenu} />
      ${timeZoom.value && html`<${IconButton} icon="fit" label=${t("timeline.whole")} hint=${`${t("timeline.whole")} (0)`} onClick=${showAll} />`}
      <${TroublesButton} state=${state} />
      <${Shown} state=${state} />
      ${isLive ? html`<${FoldButton} />` : html`<${LiveButton} state=${state} />`}
    </div>
    ${state.progress !== null && html`<${Reading} done=${state.progress} />`}
    <${TimelineRuler} />
  </section>`;
}

const showAll = () => {
  timeZoom.value = null;
};

/** A live document has no more than how far one can go back. @param {{state: TimeState}} props */
function LiveStrip({ state }) {
  return html`<section class="timeline strip" aria-label=${t("timeline")}>
    <span class="timeline-kept" title=${t("timeline.kept.hint")}><${Icon} name="history" size=${14} /><${Kept} state=${state} /></span>
    <${TimelineRuler} thin />
    <${Waiting} state=${state} />
    <span class="timeline-live" title=${t("timeline.live.hint")}><span class="dot"></span>${t("timeline.live")}</span>
    <${FoldButton} />
  </section>`;
}

/** @param {{state: TimeState}} props */
function Kept({ state }) {
  useEffect(() => followNow(), []);
  const { from_s, to_s } = wholeTime.value;
  return html`<span class="numbers">${t("timeline.kept", {
    time: sinceStart(Math.max(to_s - from_s, 0)),
    done: Math.round(state.kept_bytes / MEGABYTE),
    total: Math.round(state.kept_bytes_max / MEGABYTE),
  })}</span>`;
}

function FoldButton() {
  const open = expandsTimeline.value;
  return html`<${IconButton} icon=${open ? "chevronDown" : "expand"} size=${15} label=${t(open ? "timeline.fold" : "timeline.unfold")} class="timeline-fold" onClick=${() => {
    expandsTimeline.value = !open;
  }} />`;
}

/** @param {{id: string, label?: string, icon: string, class?: string}} props a button of a command, with its key */
function CommandButton({ id, label, icon, class: names = "" }) {
  const command = commandById(id);
  const words = label ?? command?.label?.() ?? t(`command.${id}`);
  const [key] = command?.keys ?? [];
  const may = mayMoveTime.value;
  const hint = may
    ? `${words}${key ? ` (${shortcutText(key, onMac)})` : ""}`
    : t("timeline.others");
  return html`<${IconButton} icon=${icon} class=${names} label=${words} hint=${hint} disabled=${!(command?.enabled?.() ?? false)} onClick=${() => command?.run()} />`;
}

/** @param {{state: TimeState}} props */
function Moves({ state }) {
  const topic = markTopic.value || t("timeline.any_topic");
  return html`<div class="timeline-moves" role="group" aria-label=${t("timeline.moves")}>
    <${CommandButton} id="time.begin" icon="skipBack" />
    <${CommandButton} id="time.back" icon="stepBack" label=${t("timeline.back", { topic })} />
    <${CommandButton} id="time.play" icon=${state.playing ? "pause" : "animate"} class="timeline-play" />
    <${CommandButton} id="time.forward" icon="stepForward" label=${t("timeline.forward", { topic })} />
    <${RateMenu} state=${state} />
    <${IconButton} icon="loop" label=${t(state.loop ? "timeline.loop.end" : "timeline.loop")} hint=${mayMoveTime.value ? t("timeline.loop.hint") : t("timeline.others")}
      pressed=${state.loop !== null} disabled=${!mayMoveTime.value || state.mode === "live"} onClick=${toggleLoop} />
  </div>`;
}

/** @param {number} rate @returns {string} */
const rateWords = (rate) => `${rate.toLocaleString(language.value)}×`;

/** @param {TimeState} state @returns {MenuItem[]} */
const rateItems = ({ rate }) =>
  RATES.map((one) => ({
    label: rateWords(one),
    checked: one === rate,
    run: () => void setTimeRate(one),
  }));

/** @param {{state: TimeState}} props */
function RateMenu({ state }) {
  const words = rateWords(state.rate);
  return html`<${MenuButton} class="icon-button timeline-rate" label=${t("timeline.rate")} value=${words} items=${() => rateItems(state)}
    disabled=${!mayMoveTime.value || state.mode === "live"} hint=${mayMoveTime.value ? t("timeline.rate") : t("timeline.others")}><span class="numbers">${words}</span><${Icon} name="chevronDown" size=${11} /><//>`;
}

/** As a clock, and as seconds since the start. */
function Clock() {
  const state = timeState.value;
  if (!state) return null;
  const at_s = now_s.value;
  const start_s = at_s - startOf(state);
  const date = new Date((state.zero_s + at_s) * 1000);
  const isDay = isOfDay(state.zero_s);
  return html`<span class="timeline-clock numbers" title=${isDay ? date.toLocaleString(language.value) : null}>
    <b data-time=${at_s.toFixed(6)}>${isDay ? clockTime(state.zero_s + at_s) : sinceStart(start_s, 3)}</b>
    <span class="muted">${t("timeline.since", { seconds: start_s.toFixed(3) })}</span></span>`;
}

/** @param {{state: TimeState}} props too many rewind at once */
function Waiting({ state }) {
  if (state.queue === 0) return null;
  return html`<span class="timeline-queue" role="status"><span class="spinner"></span>${t("timeline.queue", { place: state.queue })}
    <${IconButton} icon="close" size=${12} class="narrow" label=${t("timeline.queue.leave")} disabled=${!mayMoveTime.value} onClick=${goLive} /></span>`;
}

/** @param {{state: TimeState}} props it is played faster than it can be read */
function Skipping({ state }) {
  if (!state.skipping) return null;
  const words = t("timeline.skipping", { rate: rateWords(state.rate) });
  return html`<span class="timeline-queue" role="status" title=${words}><${Icon} name="alert" size=${15} /><span class="hidden-words">${words}</span></span>`;
}

/** @param {{done: number}} props the index of a damaged file is made */
function Reading({ done }) {
  const share = Math.round(done * 100);
  const words = t("timeline.reading", { share });
  return html`<div class="timeline-reading" role="status"><span>${words}</span><${ProgressBar} label=${words} done=${share} total=${100} /></div>`;
}

/** Whose messages are marked, and stepped through. */
function TopicChoice() {
  const all = timeTopics.value;
  const choose = (/** @type {any} */ event) => {
    markTopic.value = event.currentTarget.value;
  };
  return html`<select class="box timeline-topic" aria-label=${t("timeline.topic")} title=${t("timeline.topic.hint")} value=${markTopic.value} onChange=${choose}>
    <option value="">${t("timeline.all_topics", { count: all.length })}</option>
    ${all.map((/** @type {RecordedTopicView} */ { name }) => html`<option key=${name} value=${name}>${name}</option>`)}</select>`;
}

/** @param {number} at_s @returns {string} */
const shortTimeOf = (at_s) => {
  const state = timeState.peek();
  return state ? sinceStart(at_s - startOf(state), 1) : "";
};

/** Errors and warnings in a list, for keys and for fingers. */
function TicksMenu() {
  const { ticks, more } = timeTicks.value;
  if (ticks.length === 0) return null;
  const errors = ticks.filter(({ level }) => level === "error").length;
  const tone = errors > 0 ? "red" : "amber";
  // The gravest first, where not all have room.
  const listed = ticks
    .toSorted((a, b) => Number(b.level === "error") - Number(a.level === "error"))
    .slice(0, LISTED);
  const left = ticks.length + more - listed.length;
  const items = () => [
    ...listed
      .toSorted((a, b) => a.at_s - b.at_s)
      .map(({ at_s, level, source, text }) => ({
        label: `${source}: ${text}`.slice(0, 90),
        icon: level === "error" ? "error" : "alert",
        hint: shortTimeOf(at_s),
        disabled: !mayMoveTime.peek(),
        run: () => void seekTime(at_s),
      })),
    ...(left > 0 ? [{ label: t("timeline.ticks.more", { count: left }), heading: true }] : []),
  ];
  const words = t("timeline.ticks", { count: ticks.length + more });
  return html`<${MenuButton} class=${`icon-button timeline-count ${tone}`} label=${words} items=${items}><${Icon} name=${errors > 0 ? "error" : "alert"} size=${14} /><span class="numbers" aria-hidden="true">${ticks.length + more}</span><//>`;
}

/** @returns {MenuItem[]} */
const bookmarkItems = () => [
  {
    label: t("command.time.bookmark"),
    icon: "plus",
    disabled: !mayMoveTime.peek(),
    run: () => void bookmarkNow(),
  },
  ...bookmarks
    .peek()
    .slice(0, LISTED)
    .map((one) => ({
      label: one.name,
      icon: "bookmark",
      hint: shortTimeOf(one.at_s),
      disabled: !mayMoveTime.peek(),
      run: () => void seekTime(one.at_s),
    })),
  ...(bookmarks.peek().length > 0
    ? [{ label: t("timeline.bookmarks.edit"), icon: "pencil", run: () => showBagPart("contents") }]
    : []),
];

function BookmarksMenu() {
  const count = bookmarks.value.length;
  return html`<${MenuButton} class="icon-button timeline-count" label=${t("timeline.bookmarks")} items=${bookmarkItems}><${Icon} name="bookmark" size=${15} />${count > 0 && html`<span class="numbers" aria-hidden="true">${count}</span>`}<//>`;
}

/** @param {{state: TimeState}} props */
function TroublesButton({ state }) {
  const count = state.troubles.length;
  if (count === 0) return null;
  return html`<button type="button" class="icon-button timeline-count amber" title=${state.troubles.slice(0, 5).join("\n")} aria-label=${t("bag.troubles", { count })}
    onClick=${() => showBagPart("contents")}><${Icon} name="alert" size=${15} /></button>`;
}

/** What is shown: the name of the bag, or how much is kept. @param {{state: TimeState}} props */
function Shown({ state }) {
  if (state.mode !== "bag")
    return html`<span class="timeline-kept" title=${t("timeline.kept.hint")}><${Kept} state=${state} /></span>`;
  return html`<button type="button" class="status-button timeline-title" title=${state.path} onClick=${() => showBagPart("contents")}><${Icon} name="bag" size=${14} /><span>${state.title}</span></button>`;
}

/** @param {{state: TimeState}} props */
function LiveButton({ state }) {
  const may = mayMoveTime.value;
  const words = t(state.mode === "bag" ? "timeline.close_bag" : "timeline.to_live");
  const hint = may ? `${t("command.time.live")} (L)` : t("timeline.others");
  const close = state.mode === "bag";
  return html`<button type="button" class=${`button small ${close ? "" : "primary"}`} disabled=${!may} title=${hint} onClick=${goLive}>
    <${Icon} name=${close ? "close" : "live"} size=${14} /><span class="timeline-words">${words}</span></button>`;
}

/** One row, and the rest in a menu. @param {{state: TimeState}} props */
function PhoneTimeline({ state }) {
  const isLive = state.mode === "live";
  return html`<section class=${`timeline phone-row ${state.mode}`} aria-label=${t("timeline")}>
    ${!isLive && html`<${CommandButton} id="time.play" icon=${state.playing ? "pause" : "animate"} class="timeline-play" />`}
    <${TimelineRuler} thin />
    ${isLive ? html`<span class="timeline-live"><span class="dot"></span>${t("timeline.live")}</span>` : html`<${PhoneClock} />`}
    ${state.queue > 0 && html`<span class="timeline-queue" role="status" title=${t("timeline.queue", { place: state.queue })}>${state.queue}</span>`}
    <${MenuButton} label=${t("timeline.more")} items=${() => phoneItems(state)}><${Icon} name="dots" /><//>
  </section>`;
}

function PhoneClock() {
  const state = timeState.value;
  return html`<span class="timeline-clock numbers"><b data-time=${now_s.value.toFixed(6)}>${state ? sinceStart(now_s.value - startOf(state), 1) : ""}</b></span>`;
}

/** @param {TimeState} state @returns {MenuItem[]} */
function phoneItems(state) {
  /** @param {string} id */
  const item = (id) => {
    const command = commandById(id);
    return {
      label: command?.label?.() ?? t(`command.${id}`),
      icon: command?.icon ?? "bag",
      disabled: !(command?.enabled?.() ?? false),
      run: () => command?.run(),
    };
  };
  const moves = ["time.live", "time.back", "time.forward", "time.begin", "time.loop"];
  const waits = state.queue > 0 ? ["time.live"] : [];
  const played = state.mode === "live" ? [...waits, "time.back"] : moves;
  const rate = {
    label: `${t("timeline.rate")}: ${rateWords(state.rate)}`,
    icon: "joints",
    more: () => rateItems(state),
  };
  return [
    ...played.map(item),
    ...(state.mode === "live" ? [] : [rate]),
    { label: t("timeline.bookmarks"), icon: "bookmark", more: bookmarkItems },
    { label: t("panel.bag"), icon: "bag", run: () => showBagPart("contents") },
    ...(mayManage.value ? [item("open_bag")] : []),
  ];
}
