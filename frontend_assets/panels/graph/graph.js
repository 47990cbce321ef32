/** Who speaks with whom in a ROS 2 system, drawn as rqt_graph does; with what each node has. */

/** @import { EndView, GraphAnswer, GraphLinkView, NodeAnswer, TopicRate } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Box, GraphOptions } from "./nodes.js" */

import {
  computed,
  effect,
  html,
  signal,
  useEffect,
  useMemo,
  useRef,
  useSignal,
} from "vendor/preact.js";
import { OwnGraph } from "../../app/own-graph.js";
import { copyText } from "../../lib/clipboard.js";
import { commandById } from "../../lib/commands.js";
import { DdsTag } from "../../lib/dds-tag.js";
import { t } from "../../lib/i18n.js";
import { remembered } from "../../lib/remembered.js";
import { EmptyState, Icon, IconButton, ProgressBar, SearchBox } from "../../lib/ui.js";
import { askedWhenChanged, askOrKeepWhy, useLooking } from "../../model/asking.js";
import { session } from "../../model/connection.js";
import { isOwnCopy } from "../../model/copies.js";
import { showInterface } from "../../model/interfaces.js";
import { mayJoin } from "../../model/student-nodes.js";
import { useTopicRates } from "../../model/topics.js";
import { notify, soughtNode } from "../../model/view.js";
import { ConnectFirst, isWireAway, NothingThere, RouterAway } from "../parts.js";
import { GraphDrawing } from "./drawing.js";
import { drawnGraph, isNamespace, namesWithin, READABLE_NODES, USUAL } from "./nodes.js";

const GROUPS = /** @type {const} */ ([
  "publishers",
  "subscribers",
  "service_servers",
  "service_clients",
  "action_servers",
  "action_clients",
]);

/** @typedef {{chosen: Signal<string>, focus: Signal<string>, opened: Signal<ReadonlySet<string>>, rates: ReadonlyMap<string, TopicRate>}} Props */

/**
 * What was chosen in the node graph: a node with all that it has, or a topic with its two ends.
 *
 * @param {Props} props
 */
function GraphDetails({ chosen, focus, opened, rates }) {
  const [, kind = "", name = ""] = /^(\w+):(.*)$/s.exec(chosen.value) ?? [];
  const isFocus = focus.value === chosen.value;
  const isSpace = isNamespace(name);
  const close = () => {
    chosen.value = "";
  };
  const toggle = () => {
    focus.value = isFocus ? "" : chosen.value;
  };
  const copy = async () => {
    const done = await copyText(name);
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  return html`<section class="graph-details scroll" aria-label=${t("graph.details", { name })}>
    <header><${Icon} name=${kind === "node" ? "node" : "link"} size=${15} /><h3>${name}<${DdsTag} bridge=${bridgeOf(name)} /></h3>
      <${IconButton} icon="copy" label=${t("graph.copy_name")} size=${14} onClick=${copy} />
      ${!isSpace && html`<${IconButton} icon="fit" label=${t("graph.focus_on")} size=${14} pressed=${isFocus} onClick=${toggle} />`}
      <${IconButton} icon="close" label=${t("close")} size=${14} onClick=${close} /></header>
    ${isSpace && html`<${SpaceParts} name=${name} chosen=${chosen} opened=${opened} />`}
    ${kind === "node" && !isSpace && html`<${NodeParts} name=${name} rates=${rates} />`}
    ${kind !== "node" && html`<${LinkParts} kind=${kind} name=${name} rates=${rates} chosen=${chosen} />`}
  </section>`;
}

/** @param {{name: string, chosen: Signal<string>, opened: Signal<ReadonlySet<string>>}} props a namespace, and who is in it */
function SpaceParts({ name, chosen, opened }) {
  const names = namesWithin(graph.value.nodes, name);
  const open = () => {
    opened.value = new Set([...opened.value, name]);
    chosen.value = "";
  };
  return html`<button type="button" class="button small" onClick=${open}>${t("graph.space.open")}</button>
    <${NodeNames} title=${t("graph.space.nodes")} names=${names} chosen=${chosen} />`;
}

/** @param {{name: string, rates: ReadonlyMap<string, TopicRate>}} props */
function NodeParts({ name, rates }) {
  const reply = useSignal(/** @type {NodeAnswer | null} */ (null));
  const refused = useSignal("");
  const { version } = graph.value;
  useEffect(() => {
    let over = false;
    askOrKeepWhy({ type: "get_node", name }, refused).then((answer) => {
      if (!over && answer?.type === "node") reply.value = answer;
    });
    return () => {
      over = true;
    };
  }, [name, version]);
  const node = reply.value;
  if (refused.value) return html`<p class="note bad">${refused.value}</p>`;
  if (node?.name !== name) return html`<p class="note">${t("loading")}</p>`;
  if (node.count === 0) return html`<p class="note">${t("graph.gone")}</p>`;
  return html`${node.count > 1 && html`<p class="note graph-warning">${t("graph.one_of", { count: node.count })}</p>`}
    ${GROUPS.map((group) => html`<${Group} key=${group} title=${t(`graph.group.${group}`)} ends=${node[group]} rates=${rates} />`)}`;
}

/** @param {{title: string, ends: readonly EndView[], rates: ReadonlyMap<string, TopicRate>}} props */
function Group({ title, ends, rates }) {
  if (ends.length === 0) return null;
  return html`<h4>${title} <span class="muted">${ends.length}</span></h4>
    <ul>${ends.map(({ name, type }) => {
      const rate = rates.get(name)?.rate_hz;
      return html`<li key=${`${name} ${type}`}><span class="end-name">${name}</span><${TypeLink} name=${type} />${rate !== undefined && rate > 0 && html`<span class="muted">${t("graph.rate", { rate: rate.toFixed(1) })}</span>`}</li>`;
    })}</ul>`;
}

/** @param {{kind: string, name: string, rates: ReadonlyMap<string, TopicRate>, chosen: Signal<string>}} props */
function LinkParts({ kind, name, rates, chosen }) {
  const link = graph.value.links.find((one) => one.kind === kind && one.name === name);
  if (!link) return html`<p class="note">${t("graph.gone")}</p>`;
  const rate = rates.get(name)?.rate_hz;
  return html`<p>${link.types.map((type) => html`<${TypeLink} key=${type} name=${type} />`)}</p>
    ${link.types.length > 1 && html`<p class="note graph-warning">${t("graph.types", { count: link.types.length })}</p>`}
    ${rate !== undefined && html`<p class="note">${t("graph.rate", { rate: rate.toFixed(1) })}</p>`}
    <${Ends} title=${t(`graph.sources.${link.kind}`)} places=${link.sources} chosen=${chosen} />
    <${Ends} title=${t(`graph.targets.${link.kind}`)} places=${link.targets} chosen=${chosen} />`;
}

/** @param {{title: string, places: GraphLinkView["sources"], chosen: Signal<string>}} props */
function Ends({ title, places, chosen }) {
  const names = places.map((at) => graph.value.nodes[at]?.name ?? "");
  return html`<${NodeNames} title=${title} names=${names} chosen=${chosen} />`;
}

/** @param {string} name of a node @returns {string} the bridge to DDS that it is behind; empty: none */
const bridgeOf = (name) => graph.value.nodes.find((one) => one.name === name)?.bridge ?? "";

/** @param {{title: string, names: readonly string[], chosen: Signal<string>}} props of nodes, each a way to it */
function NodeNames({ title, names, chosen }) {
  return html`<h4>${title} <span class="muted">${names.length}</span></h4>
    <ul>${names.map(
      (name) =>
        html`<li key=${name}><button type="button" class="link-button" onClick=${() => {
          chosen.value = `node:${name}`;
        }}>${name}</button><${DdsTag} bridge=${bridgeOf(name)} /></li>`,
    )}</ul>`;
}

/** @param {{name: string}} props of a type: the way to what it is made of */
function TypeLink({ name }) {
  const show = () => {
    commandById("panel.interfaces")?.run();
    showInterface(name);
  };
  return html`<button type="button" class="link-button end-type" title=${t("interfaces.go", { name })} onClick=${show}>${name}</button>`;
}

/** @typedef {Pick<GraphAnswer, "version" | "nodes" | "links" | "other_count" | "more">} Graph */

/** @type {Graph} */
const NOBODY = { version: -1, nodes: [], links: [], other_count: 0, more: 0 };

/** @type {Signal<Graph>} */
export const graph = signal(NOBODY);
const graphRefused = signal("");

/** Keep it true while somebody looks; gives the end of looking. */
const followGraph = askedWhenChanged(async () => {
  const known = graph.peek().version;
  const reply = await askOrKeepWhy({ type: "get_graph", known }, graphRefused);
  if (reply?.type === "graph" && reply.version !== known) graph.value = reply;
}, "graph");

// A studio that was started anew counts from the beginning.
effect(() => {
  session.value;
  graph.value = NOBODY;
});

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
  return isOwnCopy.value && mayJoin.value ? html`<${OwnPanel} />` : html`<${SharedPanel} />`;
}

/** On a copy of one's own, while own nodes may join: their domain alone. */
function OwnPanel() {
  return html`<section class="panel-body graph scroll" tabindex="0" aria-label=${t("panel.graph")}><${OwnGraph} /></section>`;
}

function SharedPanel() {
  const { panel, looking } = useLooking(followGraph);
  return html`<section ref=${panel} class="panel-body graph" aria-label=${t("panel.graph")}>
    <${RouterAway} />
    ${isWireAway() ? html`<${ConnectFirst} icon="graph" />` : html`<${Content} looking=${looking} />`}
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
  useEffect(() => {
    if (soughtNode.value) chosen.value = `node:${soughtNode.value}`;
    soughtNode.value = "";
  }, [soughtNode.value]);
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
