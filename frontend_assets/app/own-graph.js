/** What there is in the domain of one's own ROS nodes. */

/** @import { MyGraph } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";
import { followMyGraph, graphRefused, myGraph } from "../model/student-nodes.js";

export function OwnGraph() {
  const { panel } = useLooking(followMyGraph);
  const graph = myGraph.value;
  const title = graph ? t("nodes.graph", { domain: graph.domain }) : t("nodes.title");
  return html`<section ref=${panel} class="nodes-graph" aria-label=${title}>
    <h3>${title}</h3>
    ${graphRefused.value ? html`<p class="note bad" role="alert">${graphRefused.value}</p>` : graph && html`<${Graph} graph=${graph} />`}</section>`;
}

/** @param {{graph: MyGraph}} props */
function Graph({ graph }) {
  if (graph.nodes.length === 0)
    return html`<${EmptyState} icon="node" title=${t("nodes.none")}><p>${t("nodes.none.hint")}</p><//>`;
  return html`<ul class="nodes-names">${graph.nodes.map((name) => html`<li key=${name}><${Icon} name="node" size=${14} />${name}</li>`)}</ul>
    <div class="nodes-topics" tabindex="0" role="region" aria-label=${t("nodes.topic")}><table><thead><tr><th scope="col">${t("nodes.topic")}</th>
      <th scope="col" class="number">${t("nodes.publishers")}</th><th scope="col" class="number">${t("nodes.subscriptions")}</th></tr></thead>
      <tbody>${graph.topics.map(
        (one) => html`<tr key=${one.name}><td>${one.name}<small>${one.types.join(", ")}</small></td>
          <td class="number">${one.publishers}</td><td class="number">${one.subscriptions}</td></tr>`,
      )}</tbody></table></div>
    ${graph.more > 0 && html`<p class="note">${t("nodes.more", { count: graph.more })}</p>`}`;
}
