/** Managed nodes: the state of each, and what it can be asked to do now. */

/** @import { ManagedNodeView, ManagedNodes, TransitionView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { Icon, ProgressBar } from "../../lib/ui.js";
import { askOrKeepWhy, polled, useLooking } from "../../model/asking.js";
import { mayAct } from "../../model/connection.js";
import { ask } from "../../model/requests.js";
import { ConnectFirst, isWireAway, NothingThere, PastNote, Refusal, RouterAway } from "../parts.js";

/** The states that a node stays in, in the order of its life. */
const PRIMARY = /** @type {const} */ (["unconfigured", "inactive", "active", "finalized"]);

export function LifecyclePanel() {
  const { panel } = useLooking(followManaged);
  return html`<section ref=${panel} class="panel-body lifecycle" aria-label=${t("panel.lifecycle")}>
    <${RouterAway} />
    <${PastNote} />
    ${isWireAway() ? html`<${ConnectFirst} icon="lifecycle" />` : html`<${Content} />`}
  </section>`;
}

function Content() {
  const answer = managed.value;
  if (managedRefused.value)
    return html`<${Refusal} sentence=${managedRefused.value} again=${askManaged} />`;
  if (!answer) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (answer.nodes.length === 0)
    return html`<${NothingThere} icon="lifecycle" title=${t("lifecycle.none")}><p>${t("lifecycle.none.hint")}</p><//>`;
  return html`<div class="scroll lifecycle-list">
    ${answer.nodes.map((node) => html`<${ManagedNode} key=${node.name} node=${node} />`)}
    ${answer.more > 0 && html`<p class="note padded">${t("lifecycle.more", { count: answer.more })}</p>`}
    ${!mayAct.value && html`<p class="note padded">${t("lifecycle.viewer")}</p>`}
  </div>`;
}

/** @param {{node: ManagedNodeView}} props */
function ManagedNode({ node }) {
  const busy = useSignal("");
  const take = async (/** @type {TransitionView} */ { id, label }) => {
    busy.value = label;
    await ask({ type: "change_state", node: node.name, transition: id });
    await askManaged();
    busy.value = "";
  };
  const off = !mayAct.value || busy.value !== "";
  return html`<section class="lifecycle-node" aria-label=${node.name}>
    <header><${Icon} name="node" size=${15} /><h3>${node.name}</h3></header>
    ${node.trouble ? html`<p class="note bad">${node.trouble}</p>` : html`<${States} state=${node.state} />`}
    <div class="lifecycle-ways">
      ${node.transitions.map(
        (way) =>
          html`<button key=${way.id} type="button" class="button" disabled=${off} title=${t("lifecycle.way", { goal: way.goal })} onClick=${() => take(way)}>
          ${busy.value === way.label && html`<span class="spinner"></span>`}${way.label}</button>`,
      )}
      ${!node.trouble && node.transitions.length === 0 && html`<span class="muted">${t("lifecycle.end")}</span>`}
    </div>
  </section>`;
}

/** @param {{state: string}} props the four states, and which it is in; or the one between two */
function States({ state }) {
  const isBetween = !PRIMARY.includes(/** @type {typeof PRIMARY[number]} */ (state));
  return html`<ol class="lifecycle-states" aria-label=${t("lifecycle.state", { state })}>
    ${PRIMARY.map((one) => html`<li key=${one} class=${one === state ? `now ${one}` : ""} aria-current=${one === state ? "step" : null}>${one}</li>`)}
    ${isBetween && html`<li class="now between" aria-current="step">${state}</li>`}</ol>`;
}

const EVERY_MS = 1000;

/** @type {Signal<ManagedNodes | null>} null: not known yet */
export const managed = signal(null);
const managedRefused = signal("");

async function askManaged() {
  const answer = await askOrKeepWhy({ type: "get_managed" }, managedRefused);
  if (answer?.type === "managed_nodes") managed.value = answer;
}

/**
 * Keep them true while somebody looks; gives the end of looking. Asked again and again: what a node
 * may do next it tells only when it is asked, and transitions of others are no change of the graph.
 */
const followManaged = polled(askManaged, EVERY_MS);
