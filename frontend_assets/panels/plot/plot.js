/** Numbers of messages over time, as they come or over a recording: as many lines as are wished. */

/** @import { Span } from "./chart.js" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Series } from "../../model/plotting.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { saveAsFile } from "../../lib/files.js";
import { t } from "../../lib/i18n.js";
import { shownNumber } from "../../lib/numbers.js";
import { useSeen } from "../../lib/seen.js";
import { overdue_s, shortTime } from "../../lib/times.js";
import { EmptyState, Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { dropped, laneOpen } from "../../model/data-lane.js";
import { useNumberPaths } from "../../model/number-paths.js";
import {
  addSeries,
  csvOf,
  followSeries,
  forgetOthers,
  keyOf,
  nowOfSamples,
  plotListening,
  removeSeries,
  samplesOf,
  series,
  span_s,
  topicSubscriptions,
  unreadTopics,
} from "../../model/plotting.js";
import { recordedPicture, tableAddress } from "../../model/recorded-series.js";
import { isPast, timeZoom } from "../../model/time.js";
import { followTopics, topics } from "../../model/topics.js";
import { stepsOf } from "../../workers/message-paths.js";
import { ListeningMenu } from "../listening-menu.js";
import { ConnectFirst, isUnconnected, RouterAway } from "../parts.js";
import { dragged, endDrag, takesDrop } from "../topic-drag.js";
import { PlotChart } from "./chart.js";
import { colorOf } from "./lines.js";
import { CoarseNote, RecordedChart, recordedText, recordedTrouble } from "./recorded.js";

const SPANS_S = [5, 10, 30, 60, 120, 300];

export function PlotPanel() {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (now) => {
    seen.value = now;
  });
  const wished = seen.value && !isUnconnected() && !isPast.value ? series.value : [];
  useEffect(() => {
    for (const one of wished) samplesOf(one);
    followSeries(wished, plotListening.value);
  }, [wished, plotListening.value]);
  useEffect(() => () => followSeries([], plotListening.peek()), []);
  useEffect(() => forgetOthers(series.value), [series.value]);
  const onDrop = (/** @type {DragEvent} */ event) => {
    event.preventDefault();
    const what = dragged.value;
    endDrag();
    if (what?.path) addSeries(what.topic, what.path);
  };
  const isTarget = dragged.value !== null && dragged.value.path !== "";
  return html`<section ref=${panel} class=${`panel-body plot ${isTarget ? "drop-here" : ""}`} aria-label=${t("panel.plot")}
    onDragOver=${(/** @type {DragEvent} */ event) => isTarget && takesDrop(event)} onDrop=${onDrop}>
    <${RouterAway} />
    ${isUnconnected() ? html`<${ConnectFirst} icon="plot" />` : html`<${Content} seen=${seen.value} />`}
  </section>`;
}

/** @param {{seen: boolean}} props */
function Content({ seen }) {
  const picking = useSignal(false);
  const hidden = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const pointed_s = useSignal(/** @type {number | null} */ (null));
  /** What is held still; null: it runs. */
  const held = useSignal(/** @type {Span | null} */ (null));
  const isEmpty = series.value.length === 0;
  return html`<${Bar} picking=${picking} held=${held} />
    ${
      (picking.value || isEmpty) &&
      html`<${PlotPicker} onDone=${() => {
        picking.value = false;
      }} />`
    }
    ${isEmpty && html`<${EmptyState} icon="plot" title=${t("plot.none")} />`}
    ${!isEmpty && html`<${PlotLegend} hidden=${hidden} pointed_s=${pointed_s} />`}
    ${!isEmpty && seen && isPast.value && html`<${RecordedChart} hidden=${hidden.value} pointed_s=${pointed_s} />`}
    ${!isEmpty && seen && !isPast.value && html`<${PlotChart} hidden=${hidden.value} held=${held} pointed_s=${pointed_s} />`}`;
}

/** @param {{picking: Signal<boolean>, held: Signal<Span | null>}} props */
function Bar({ picking, held }) {
  const isEmpty = series.value.length === 0;
  return html`<div class="panel-bar plot-bar">
    <button type="button" class="button" aria-label=${t("plot.add")} aria-expanded=${picking.value} disabled=${isEmpty} onClick=${() => {
      picking.value = !picking.value;
    }}><${Icon} name="plus" size=${14} /><span class="plot-add-words">${t("plot.add")}</span></button>
    ${isPast.value ? html`<${RecordedTools} isEmpty=${isEmpty} />` : html`<${LiveTools} held=${held} isEmpty=${isEmpty} />`}
    <${IconButton} icon="trash" label=${t("plot.clear")} disabled=${isEmpty} onClick=${() => {
      series.value = [];
    }} />
  </div>`;
}

/** @param {{isEmpty: boolean}} props */
function RecordedTools({ isEmpty }) {
  const table = isEmpty ? "" : tableAddress(recordedPicture.value, series.value);
  const save = () => {
    const link = document.createElement("a");
    link.href = table;
    link.download = "plot.csv";
    link.click();
  };
  return html`<${IconButton} icon="fit" label=${t("plot.whole")} disabled=${timeZoom.value === null} onClick=${() => {
    timeZoom.value = null;
  }} />
    <span class="push"></span>
    ${!isEmpty && html`<${CoarseNote} />`}
    <${IconButton} icon="download" label=${t("plot.csv.whole")} disabled=${table === ""} onClick=${save} />`;
}

/** @param {{held: Signal<Span | null>, isEmpty: boolean}} props */
function LiveTools({ held, isEmpty }) {
  const seconds = t("plot.seconds", { count: span_s.value });
  const toggle = () => {
    held.value = held.value ? null : spanNow();
  };
  const items = () =>
    SPANS_S.map((span) => ({
      label: t("plot.seconds", { count: span }),
      checked: span_s.value === span,
      run: () => {
        span_s.value = span;
        if (held.value) held.value = { ...held.value, from_s: held.value.to_s - span };
      },
    }));
  return html`<${MenuButton} label=${t("plot.span")} value=${seconds} class="button" items=${items}>${seconds}<${Icon} name="chevronDown" size=${12} /><//>
    <${IconButton} icon=${held.value ? "animate" : "pause"} label=${t(held.value ? "topics.go_on" : "topics.pause")} pressed=${held.value !== null} disabled=${isEmpty} onClick=${toggle} />
    <${ListeningMenu} label=${t("plot.listen")} listening=${plotListening} disabled=${isEmpty} />
    <span class="push"></span>
    ${dropped.value > 0 && html`<span class="plot-trouble" role="status">${t("plot.dropped", { count: dropped.value })}</span>`}
    <${IconButton} icon="download" label=${t("plot.csv")} disabled=${isEmpty} onClick=${() => download(held.value ?? spanNow())} />`;
}

/** @returns {Span} */
function spanNow() {
  const to_s = nowOfSamples();
  return { from_s: to_s - span_s.value, to_s, now_s: to_s };
}

/** @param {Span} span */
function download({ from_s, to_s }) {
  const all = series.value.map((one) => ({ ...one, samples: samplesOf(one) }));
  saveAsFile("plot.csv", csvOf(all, from_s, to_s), "text/csv");
}

const REFRESH_MS = 200;
/** So many of the last tell how often they come. */
const LOOKED_BACK = 10;

/**
 * The names of the lines of a plot, with their values: now, or where the pointer is.
 *
 * @param {{hidden: Signal<ReadonlySet<string>>, pointed_s: Signal<number | null>}} props
 */
function PlotLegend({ hidden, pointed_s }) {
  const round = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => {
      round.value += 1;
    }, REFRESH_MS);
    return () => clearInterval(timer);
  }, []);
  // Read, so that values are told anew as time goes by.
  const at = round.value;
  return html`<ul class="plot-legend" aria-label=${t("plot.lines")}>${series.value.map(
    (one, n) =>
      html`<${Line} key=${keyOf(one)} one=${one} color=${colorOf(n)} hidden=${hidden} at_s=${pointed_s.value} round=${at} />`,
  )}</ul>`;
}

/** @param {{one: Series, color: string, hidden: Signal<ReadonlySet<string>>, at_s: number | null}} props */
function Line({ one, color, hidden, at_s }) {
  const key = keyOf(one);
  const isHidden = hidden.value.has(key);
  const toggle = () => {
    const now = new Set(hidden.value);
    if (!now.delete(key)) now.add(key);
    hidden.value = now;
  };
  const trouble = troubleOf(one);
  return html`<li class=${isHidden ? "off" : ""} title=${[key, trouble].filter(Boolean).join("\n")}>
    <button type="button" class="plot-name" aria-pressed=${!isHidden} onClick=${toggle}><span class="plot-mark" style=${`background:${color}`}></span><span>${nameOf(one)}</span></button>
    <output>${valueText(one, at_s)}</output>
    ${trouble && html`<span class="plot-trouble">${trouble}</span>`}
    <${IconButton} icon="close" label=${t("plot.remove", { name: key })} size=${12} class="narrow" onClick=${() => removeSeries(one)} />
  </li>`;
}

/** @param {Series} one @returns {string} as short as it tells them apart */
function nameOf({ topic, path }) {
  const fields = series.value.filter((other) => other.path === path);
  return fields.length > 1 ? topic + path : path.replace(/^\./, "") || topic;
}

/** @param {Series} one @param {number | null} at_s */
function valueText(one, at_s) {
  if (isPast.value) return recordedText(one, at_s);
  const samples = samplesOf(one);
  const value = at_s === null ? samples.newest() : samples.valueAt(at_s);
  return value === null ? "–" : shownNumber(value);
}

/** @param {Series} one @returns {string} why there is no line, or it goes on no more; empty: all is well */
function troubleOf(one) {
  if (isPast.value) return recordedTrouble(one);
  const subscription = topicSubscriptions.value.get(one.topic);
  const unread = unreadTopics.value.get(one.topic);
  if (!laneOpen.value) return t("plot.state.lane");
  if (subscription?.state === "refused") return subscription.reason;
  if (subscription && subscription.state !== "receiving")
    return t(`plot.state.${subscription.state}`);
  if (unread) return t("plot.unread", { reason: unread });
  return subscription ? troubleOfSamples(samplesOf(one), subscription.latched) : "";
}

/** @param {ReturnType<typeof samplesOf>} samples @param {boolean} latched what is latched is said once and holds */
function troubleOfSamples(samples, latched) {
  if (samples.count === 0) return t(samples.others > 0 ? "plot.no_number" : "plot.state.waiting");
  const silent_s = overdue_s(samples.last(LOOKED_BACK), nowOfSamples());
  return silent_s > 0 && !latched ? t("plot.state.silent", { time: shortTime(silent_s) }) : "";
}

/**
 * Which number is drawn, by hand: a topic, and a path into its messages.
 *
 * @param {{onDone: () => void}} props
 */
function PlotPicker({ onDone }) {
  const topic = useSignal("");
  const path = useSignal("");
  useEffect(followTopics, []);
  const type = topics.value?.find(({ name }) => name === topic.value)?.types[0] ?? "";
  const paths = useNumberPaths(type);
  const steps = stepsOf(path.value);
  const isWrong = path.value !== "" && steps === null;
  const canAdd = topic.value.startsWith("/") && steps !== null && steps.length > 0;
  const add = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (!canAdd) return;
    addSeries(topic.value.trim(), path.value.trim());
    path.value = "";
    onDone();
  };
  return html`<form class="plot-picker" onSubmit=${add}>
    <input list="plot-topics" class="box" aria-label=${t("topics.name")} placeholder=${t("plot.topic")} value=${topic.value} spellcheck=${false} autocomplete="off"
      onInput=${(/** @type {any} */ event) => {
        topic.value = event.currentTarget.value;
      }} />
    <datalist id="plot-topics">${topics.value?.map(({ name }) => html`<option key=${name} value=${name}></option>`)}</datalist>
    <input list="plot-paths" class="box" aria-label=${t("plot.path")} placeholder=${t("plot.path")} value=${path.value} spellcheck=${false} autocomplete="off" aria-invalid=${isWrong}
      onInput=${(/** @type {any} */ event) => {
        path.value = event.currentTarget.value;
      }} />
    <datalist id="plot-paths">${paths.map((one) => html`<option key=${one} value=${one}></option>`)}</datalist>
    <button type="submit" class="button primary" disabled=${!canAdd}>${t("plot.draw")}</button>
    ${isWrong && html`<p class="note">${t("plot.wrong_path")}</p>`}
  </form>`;
}
