/** Numbers of messages over time: every one of them, as many lines as are wished. */

/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, RouterAway } from "../app/connect-first.js";
import { ListeningMenu } from "../app/listening-menu.js";
import { dragged, endDrag, takesDrop } from "../app/topic-drag.js";
import { saveAsFile } from "../lib/files.js";
import { t } from "../lib/i18n.js";
import { useSeen } from "../lib/seen.js";
import { EmptyState, Icon, IconButton, MenuButton } from "../lib/ui.js";
import { dropped } from "../model/data-lane.js";
import {
  addSeries,
  csvOf,
  followSeries,
  forgetOthers,
  nowOfSamples,
  plotListening,
  samplesOf,
  series,
  span_s,
} from "../model/plotting.js";
import { PlotChart } from "./plot-chart.js";
import { PlotLegend } from "./plot-legend.js";
import { PlotPicker } from "./plot-picker.js";

/** @typedef {{from_s: number, to_s: number, now_s: number}} Span of time that is seen, and the moment from which its axis counts */

const SPANS_S = [5, 10, 30, 60, 120, 300];

export function PlotPanel() {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (now) => {
    seen.value = now;
  });
  const wished = seen.value && !isUnconnected() ? series.value : [];
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
    ${!isEmpty && seen && html`<${PlotChart} hidden=${hidden.value} held=${held} pointed_s=${pointed_s} />`}`;
}

/** @param {{picking: Signal<boolean>, held: Signal<Span | null>}} props */
function Bar({ picking, held }) {
  const isEmpty = series.value.length === 0;
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
  return html`<div class="panel-bar plot-bar">
    <button type="button" class="button" aria-label=${t("plot.add")} aria-expanded=${picking.value} disabled=${isEmpty} onClick=${() => {
      picking.value = !picking.value;
    }}><${Icon} name="plus" size=${14} /><span class="plot-add-words">${t("plot.add")}</span></button>
    <${MenuButton} label=${t("plot.span")} value=${seconds} class="button" items=${items}>${seconds}<${Icon} name="chevronDown" size=${12} /><//>
    <${IconButton} icon=${held.value ? "animate" : "pause"} label=${t(held.value ? "topics.go_on" : "topics.pause")} pressed=${held.value !== null} disabled=${isEmpty} onClick=${toggle} />
    <${ListeningMenu} label=${t("plot.listen")} listening=${plotListening} disabled=${isEmpty} />
    <span class="push"></span>
    ${dropped.value > 0 && html`<span class="plot-trouble" role="status">${t("plot.dropped", { count: dropped.value })}</span>`}
    <${IconButton} icon="download" label=${t("plot.csv")} disabled=${isEmpty} onClick=${() => download(held.value ?? spanNow())} />
    <${IconButton} icon="trash" label=${t("plot.clear")} disabled=${isEmpty} onClick=${() => {
      series.value = [];
    }} />
  </div>`;
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
