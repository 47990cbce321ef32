/** Who speaks with whom in a ROS 2 system, drawn as rqt_graph does; with what each node has. */

/** @import { TopicRate } from "../types/wire.d.ts" */
/** @import { Box, GraphOptions } from "../lib/node-graph.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../app/connect-first.js";
import { followGraph, graph, graphRefused } from "../app/state/graph.js";
import { READABLE_NODES } from "../lib/graph-groups.js";
import { t } from "../lib/i18n.js";
import { drawnGraph, USUAL } from "../lib/node-graph.js";
import { remembered } from "../lib/remembered.js";
import { EmptyState, Icon, ProgressBar, SearchBox } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";
import { useTopicRates } from "../model/topics.js";
import { GraphDetails } from "./graph-details.js";
import { GraphDrawing } from "./graph-drawing.js";

/** More topics than this are not heard for the sake of a number on an arrow. */
const RATES_MAX = 60;
/** More boxes than this nobody can read, and the page would stand still to lay them out. */
const BOXES_MAX = 600;
const FILTERS = /** @type {const} */ (["spaces", "services", "sinks", "noise"]);
/** @type {ReadonlySet<string>} */
const NONE = new Set();
const kept = remembered("graph.options", /** @type {Partial<GraphOptions>} */ ({}));
/** How it is drawn: as somebody chose, else as can be read. */
const options = computed(() => {
  const isLarge = graph.value.nodes.length > READABLE_NODES;
  /** @type {Partial<GraphOptions>} */
  const readable = isLarge ? { form: "nodes", spaces: true } : {};
  return { ...USUAL, ...readable, ...kept.value };
});

export function GraphPanel() {
  const { panel, looking } = useLooking(followGraph);
  return html`<section ref=${panel} class="panel-body graph" aria-label=${t("panel.graph")}>
    <${RouterAway} />
    ${isUnconnected() ? html`<${ConnectFirst} icon="graph" />` : html`<${Content} looking=${looking} />`}
  </section>`;
}

/** @param {{looking: boolean}} props */
function Content({ looking }) {
  const words = useSignal("");
  const focus = useSignal("");
  const chosen = useSignal("");
  const opened = useSignal(NONE);
  const rates = useSignal(/** @type {ReadonlyMap<string, TopicRate>} */ (new Map()));
  const whole = graph.value;
  const asked = {
    ...options.value,
    opened: opened.value,
    words: words.value,
    focus: focus.value,
  };
  const key = JSON.stringify({ ...asked, opened: [...opened.value] });
  const drawn = useMemo(() => drawnGraph(whole, asked), [whole, key]);
  const onFocus = (/** @type {Box} */ { kind, id, name }) => {
    if (kind === "space") opened.value = new Set([...opened.value, name]);
    else focus.value = id;
  };
  const topics = drawn.arrows.flatMap(({ names }) => names);
  const ours = new Set(whole.nodes.filter(({ own }) => own).map(({ name }) => name));
  const own = drawn.boxes.filter(({ kind, name }) => kind === "node" && ours.has(name)).length;
  return html`<${Bar} words=${words} focus=${focus} opened=${opened} own=${own} />
    ${graphRefused.value && html`<p class="note bad padded" role="alert">${graphRefused.value}</p>`}
    <${Warnings} />
    ${looking && html`<${Rates} topics=${[...new Set(topics)].slice(0, RATES_MAX)} rates=${rates} />`}
    ${
      drawn.boxes.length === 0 || drawn.boxes.length > BOXES_MAX
        ? html`<${Nothing} words=${words.value} count=${drawn.boxes.length} />`
        : html`<div class="graph-parts"><${GraphDrawing} drawn=${drawn} asked=${key} rates=${rates.value} chosen=${chosen} onFocus=${onFocus} />
        ${chosen.value && html`<${GraphDetails} chosen=${chosen} focus=${focus} opened=${opened} rates=${rates.value} />`}</div>`
    }`;
}

/** @param {{words: Signal<string>, focus: Signal<string>, opened: Signal<ReadonlySet<string>>, own: number}} props `own`: how many of the studio's are drawn */
function Bar({ words, focus, opened, own }) {
  const now = options.value;
  const change = (/** @type {Partial<GraphOptions>} */ news) => {
    kept.value = { ...kept.value, ...news };
  };
  const { other_count: others, more } = graph.value;
  return html`<div class="panel-bar graph-bar">
    <${SearchBox} label=${t("graph.search")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} />
    <select class="box" aria-label=${t("graph.form")} value=${now.form} onChange=${(/** @type {any} */ event) => change({ form: event.currentTarget.value })}>
      <option value="links">${t("graph.form.links")}</option><option value="nodes">${t("graph.form.nodes")}</option></select>
    <div class="chips" role="group" aria-label=${t("graph.show")}>${FILTERS.map(
      (
        name,
      ) => html`<button key=${name} type="button" class="chip" aria-pressed=${now[name]} title=${t(`graph.show.${name}.hint`)}
        onClick=${() => change({ [name]: !now[name] })}>${t(`graph.show.${name}`)}</button>`,
    )}
    ${now.spaces && [...opened.value].map((name) => html`<${Chip} key=${name} words=${name} label=${t("graph.space.close", { name })} onClose=${() => close(opened, name)} />`)}
    ${focus.value && html`<${Chip} words=${t("graph.focus", { name: focus.value.replace(/^\w+:/, "") })} onClose=${() => unfocus(focus)} />`}</div>
    <span class="push"></span><span class="muted graph-count" role="status">${t("graph.count", { count: others })}${own > 0 && html` · ${t("graph.own", { count: own })}`}${more > 0 && html` · ${t("graph.more", { count: more })}`}</span>
  </div>`;
}

/** @param {{words: string, label?: string, onClose: () => void}} props what is seen differently, until it is clicked */
const Chip = ({ words, label, onClose }) =>
  html`<button type="button" class="chip graph-focus" aria-pressed="true" aria-label=${label} onClick=${onClose}>${words}<${Icon} name="close" size=${12} /></button>`;

/** @param {Signal<ReadonlySet<string>>} opened @param {string} namespace with those in it */
function close(opened, namespace) {
  opened.value = new Set([...opened.value].filter((name) => !name.startsWith(namespace)));
}

/** @param {Signal<string>} focus */
function unfocus(focus) {
  focus.value = "";
}

/** Two nodes of one name are a fault that is hard to see otherwise. */
function Warnings() {
  const doubled = graph.value.nodes.filter(({ count }) => count > 1);
  const [first] = doubled;
  if (!first) return null;
  const words =
    doubled.length === 1
      ? t("graph.doubled", { count: first.count, name: first.name })
      : t("graph.doubled.many", { count: doubled.length, name: first.name });
  return html`<p class="graph-warning" role="alert"><${Icon} name="alert" size=${14} /><span>${words}</span></p>`;
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

/** @param {{words: string, count: number}} props of boxes, more than can be drawn */
function Nothing({ words, count }) {
  if (graph.value.version < 0)
    return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (count > 0)
    return html`<${EmptyState} icon="graph" title=${t("graph.too_many", { count })}><p>${t("graph.too_many.hint")}</p><//>`;
  const show = () => {
    kept.value = { ...kept.value, noise: true, sinks: true };
  };
  if (words !== "") return html`<p class="nothing">${t("filter.nothing", { words })}</p>`;
  return html`<${NothingThere} icon="graph" title=${t("graph.none")}>
    <button type="button" class="button" onClick=${show}>${t("graph.show_all")}</button><//>`;
}
