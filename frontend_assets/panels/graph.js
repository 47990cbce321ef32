/** Who speaks with whom in a ROS 2 system, drawn as rqt_graph does; with what each node has. */

/** @import { TopicRate } from "../types/wire.d.ts" */
/** @import { Box, GraphOptions } from "../lib/node-graph.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected } from "../app/connect-first.js";
import { useLooking } from "../app/looking.js";
import { followGraph, graph, graphRefused } from "../app/state/graph.js";
import { useTopicRates } from "../app/topic-rates.js";
import { t } from "../lib/i18n.js";
import { drawnGraph, USUAL } from "../lib/node-graph.js";
import { remembered } from "../lib/remembered.js";
import { EmptyState, Icon, SearchBox } from "../lib/ui.js";
import { GraphDetails } from "./graph-details.js";
import { GraphDrawing } from "./graph-drawing.js";

/** More topics than this are not heard for the sake of a number on an arrow. */
const RATES_MAX = 60;
const FILTERS = /** @type {const} */ (["services", "sinks", "noise"]);
const kept = remembered("graph.options", /** @type {Partial<GraphOptions>} */ ({}));

export function GraphPanel() {
  const { panel, looking } = useLooking(followGraph);
  return html`<section ref=${panel} class="panel-body graph" aria-label=${t("panel.graph")}>
    ${isUnconnected() ? html`<${ConnectFirst} icon="graph" />` : html`<${Content} looking=${looking} />`}
  </section>`;
}

/** @param {{looking: boolean}} props */
function Content({ looking }) {
  const words = useSignal("");
  const focus = useSignal("");
  const chosen = useSignal("");
  const rates = useSignal(/** @type {ReadonlyMap<string, TopicRate>} */ (new Map()));
  const { form, noise, sinks, services } = { ...USUAL, ...kept.value };
  const whole = graph.value;
  const drawn = useMemo(
    () =>
      drawnGraph(whole, {
        form,
        noise,
        sinks,
        services,
        words: words.value,
        focus: focus.value,
      }),
    [whole, form, noise, sinks, services, words.value, focus.value],
  );
  const topics = drawn.arrows.flatMap(({ names }) => names);
  return html`<${Bar} words=${words} focus=${focus} />
    ${graphRefused.value && html`<p class="note bad padded" role="alert">${graphRefused.value}</p>`}
    <${Warnings} />
    ${looking && html`<${Rates} topics=${[...new Set(topics)].slice(0, RATES_MAX)} rates=${rates} />`}
    ${
      drawn.boxes.length === 0
        ? html`<${Nothing} words=${words.value} />`
        : html`<div class="graph-parts"><${GraphDrawing} drawn=${drawn} rates=${rates.value} chosen=${chosen} onFocus=${(
            /** @type {Box} */ { id },
          ) => {
            focus.value = id;
          }} />
        ${chosen.value && html`<${GraphDetails} chosen=${chosen} focus=${focus} rates=${rates.value} />`}</div>`
    }`;
}

/** @param {{words: Signal<string>, focus: Signal<string>}} props */
function Bar({ words, focus }) {
  const options = { ...USUAL, ...kept.value };
  const change = (/** @type {Partial<GraphOptions>} */ news) => {
    kept.value = { ...kept.value, ...news };
  };
  const { nodes, more } = graph.value;
  const others = nodes.filter(({ own }) => !own).reduce((sum, { count }) => sum + count, 0);
  return html`<div class="panel-bar graph-bar">
    <${SearchBox} label=${t("graph.search")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} />
    <select class="box" aria-label=${t("graph.form")} value=${options.form} onChange=${(/** @type {any} */ event) => change({ form: event.currentTarget.value })}>
      <option value="links">${t("graph.form.links")}</option><option value="nodes">${t("graph.form.nodes")}</option></select>
    <div class="chips" role="group" aria-label=${t("graph.show")}>${FILTERS.map(
      (
        name,
      ) => html`<button key=${name} type="button" class="chip" aria-pressed=${options[name]} title=${t(`graph.show.${name}.hint`)}
        onClick=${() => change({ [name]: !options[name] })}>${t(`graph.show.${name}`)}</button>`,
    )}
    ${focus.value && html`<button type="button" class="chip graph-focus" aria-pressed="true" onClick=${() => unfocus(focus)}>${t("graph.focus", { name: focus.value.replace(/^\w+:/, "") })}<${Icon} name="close" size=${12} /></button>`}</div>
    <span class="push"></span><span class="muted graph-count" role="status">${t("graph.count", { count: others })}${more > 0 && html` · ${t("graph.more", { count: more })}`}</span>
  </div>`;
}

/** @param {Signal<string>} focus */
function unfocus(focus) {
  focus.value = "";
}

/** Two nodes of one name are a fault that is hard to see otherwise. */
function Warnings() {
  const doubled = graph.value.nodes.filter(({ count }) => count > 1);
  return doubled.map(
    ({ name, count }) =>
      html`<p key=${name} class="note graph-warning" role="alert"><${Icon} name="alert" size=${14} /><span>${t("graph.doubled", { count, name })}</span></p>`,
  );
}

/** @param {{topics: readonly string[], rates: Signal<ReadonlyMap<string, TopicRate>>}} props asks while it is there */
function Rates({ topics, rates }) {
  const newest = useRef(topics);
  newest.current = topics;
  const found = useTopicRates(() => newest.current);
  useEffect(() => {
    rates.value = found.value;
  }, [found.value]);
  return null;
}

/** @param {{words: string}} props */
function Nothing({ words }) {
  const show = () => {
    kept.value = { ...kept.value, noise: true, sinks: true };
  };
  if (words !== "") return html`<p class="nothing">${t("filter.nothing", { words })}</p>`;
  return html`<${EmptyState} icon="graph" title=${t("graph.none")}>
    <button type="button" class="button" onClick=${show}>${t("graph.show_all")}</button><//>`;
}
