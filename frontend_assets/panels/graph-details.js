/** What was chosen in the node graph: a node with all that it has, or a topic with its two ends. */

/** @import { EndView, GraphLinkView, NodeAnswer, TopicRate } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { graph } from "../app/state/graph.js";
import { copyText } from "../lib/clipboard.js";
import { commandById } from "../lib/commands.js";
import { isNamespace, namesWithin } from "../lib/graph-groups.js";
import { t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";
import { askOrKeepWhy } from "../model/asking.js";
import { showInterface } from "../model/interfaces.js";
import { notify } from "../model/view.js";

const GROUPS = /** @type {const} */ ([
  "publishers",
  "subscribers",
  "service_servers",
  "service_clients",
  "action_servers",
  "action_clients",
]);

/** @typedef {{chosen: Signal<string>, focus: Signal<string>, opened: Signal<ReadonlySet<string>>, rates: ReadonlyMap<string, TopicRate>}} Props */

/** @param {Props} props */
export function GraphDetails({ chosen, focus, opened, rates }) {
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
    <header><${Icon} name=${kind === "node" ? "node" : "link"} size=${15} /><h3>${name}</h3>
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
  const told = useSignal(/** @type {NodeAnswer | null} */ (null));
  const refused = useSignal("");
  const { version } = graph.value;
  useEffect(() => {
    let over = false;
    askOrKeepWhy({ type: "get_node", name }, refused).then((answer) => {
      if (!over && answer?.type === "node") told.value = answer;
    });
    return () => {
      over = true;
    };
  }, [name, version]);
  const node = told.value;
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

/** @param {{title: string, names: readonly string[], chosen: Signal<string>}} props of nodes, each a way to it */
function NodeNames({ title, names, chosen }) {
  return html`<h4>${title} <span class="muted">${names.length}</span></h4>
    <ul>${names.map(
      (name) =>
        html`<li key=${name}><button type="button" class="link-button" onClick=${() => {
          chosen.value = `node:${name}`;
        }}>${name}</button></li>`,
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
