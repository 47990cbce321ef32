/**
 * What panels that draw the world of one demo are made of: which world, or how there comes to be
 * one, and calls of its services.
 */

/** @import { CallView, OfferView, TopicRow } from "../types/wire.d.ts" */

import { computed, effect, html, signal, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon, MenuButton, ProgressBar } from "../lib/ui.js";
import { askOrKeepWhy, useLooking } from "../model/asking.js";
import { mayAct, mayManage } from "../model/connection.js";
import { calls, followOperations, followServices, plainOf, services } from "../model/operations.js";
import { followTopics, topics } from "../model/topics.js";
import { ConnectFirst, isRouterAway, isWireAway, PastNote, RouterAway } from "./parts.js";

/**
 * @typedef {object} FieldPanelProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {string} demo that has such a world
 * @property {() => () => void} follow what it needs while it is looked at
 * @property {ReturnType<typeof inNamespaces<any>>} worlds
 * @property {(world: any) => string} nameOf a world
 * @property {(props: {world: any}) => import("vendor/preact.js").VNode} world draws the one that is looked at
 */

/** @param {FieldPanelProps} props */
export function FieldPanel(props) {
  const { id, icon, follow } = props;
  const { panel, looking } = useLooking(follow);
  return html`<section ref=${panel} class=${`panel-body with-field ${id}`} aria-label=${t(`panel.${id}`)}>
    <${PastNote} />
    ${isWireAway() ? html`<${ConnectFirst} icon=${icon} />` : looking && html`<${Content} ...${props} />`}
  </section>`;
}

/** @param {FieldPanelProps} props */
function Content({ id, icon, demo, worlds: { all, shown, chosen }, nameOf, world: World }) {
  if (!all.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const one = shown.value;
  if (!one && isRouterAway()) return html`<${RouterAway} />`;
  if (!one) return html`<${DemoFirst} icon=${icon} title=${t(`${id}.none`)} demo=${demo} />`;
  const items = () =>
    (all.value ?? []).map((other) => ({
      label: nameOf(other),
      checked: other.prefix === one.prefix,
      run: () => {
        chosen.value = other.prefix;
      },
    }));
  return html`<${RouterAway} />${
    all.value.length > 1 &&
    html`<div class="panel-bar row"><${MenuButton} label=${t(`${id}.choose`)} value=${nameOf(one)} class="button" items=${items}>
      <span class="field-name">${nameOf(one)}</span><${Icon} name="chevronDown" size=${12} /><//></div>`
  }
    ${!mayAct.value && html`<p class="note padded">${t(`${id}.viewer`)}</p>`}
    <${World} key=${one.prefix} world=${one} />`;
}

/** @param {{troubles: readonly string[]}} props why things were not done; empty ones are none */
export function Troubles({ troubles }) {
  return troubles.map(
    (sentence) =>
      sentence && html`<p key=${sentence} class="note bad padded" role="alert">${sentence}</p>`,
  );
}

/**
 * @template {{prefix: string}} T
 * @param {(topics: readonly TopicRow[], services: readonly OfferView[]) => readonly T[]} find
 */
export function inNamespaces(find) {
  /** The namespace that a person chose. */
  const chosen = signal("");
  /** Null: not known yet. */
  const all = computed(() =>
    topics.value && services.value ? find(topics.value, services.value) : null,
  );
  /** The one that is looked at; null: there is none. */
  const shown = computed(
    () => all.value?.find(({ prefix }) => prefix === chosen.value) ?? all.value?.[0] ?? null,
  );
  return { chosen, all, shown };
}

/** Know which there are, while somebody looks; gives the end of it. */
export function followNamespaces() {
  const ends = [followTopics(), followServices()];
  return () => {
    for (const end of ends) end();
  };
}

/**
 * What was seen of each world so far, the one looked at last being the last.
 *
 * @template T
 * @param {() => T} begin
 * @param {number} most that are kept
 * @returns {(prefix: string) => T}
 */
export function keptFor(begin, most) {
  /** @type {Map<string, T>} */
  const kept = new Map();
  return (prefix) => {
    const found = kept.get(prefix) ?? begin();
    kept.delete(prefix);
    kept.set(prefix, found);
    for (const oldest of [...kept.keys()].slice(0, -most)) kept.delete(oldest);
    return found;
  };
}

const TIMEOUT_S = 5;

/**
 * @param {{name: string, type: string}} service
 * @param {object} values of the request
 * @returns {Promise<{reply: any, trouble: string}>} `trouble`: why there is no reply, in a sentence; else empty
 */
export async function called({ name, type }, values) {
  const end = followOperations("calls");
  try {
    const call = await outcome(name, type, JSON.stringify(values));
    if (typeof call === "string") return { reply: null, trouble: call };
    if (call.state === "cancelled") return { reply: null, trouble: t("calling.cancelled") };
    return { reply: plainOf(call.reply), trouble: call.trouble };
  } finally {
    end();
  }
}

/** @param {string} name @param {string} type @param {string} text @returns {Promise<CallView | string>} the call at its end, or why it was not begun */
async function outcome(name, type, text) {
  const refused = signal("");
  const answer = await askOrKeepWhy(
    { type: "call_service", name, service_type: type, text, timeout_s: TIMEOUT_S },
    refused,
  );
  if (answer?.type !== "begun") return refused.value || t("calling.lost");
  return ended(answer.operation);
}

/** @param {number} operation @returns {Promise<CallView>} */
function ended(operation) {
  return new Promise((resolve) => {
    /** @type {() => void} */
    let stop = () => {};
    stop = effect(() => {
      const call = calls.value.find((one) => one.operation === operation);
      if (!call || call.state === "calling") return;
      resolve(call);
      queueMicrotask(() => stop());
    });
  });
}

/** @param {{icon: string, title: string, demo: string}} props `demo`: as `studio demos` lists it */
function DemoFirst({ icon, title, demo }) {
  const isBusy = useSignal(false);
  const refused = useSignal("");
  const start = async () => {
    isBusy.value = true;
    await askOrKeepWhy({ type: "start_demo", demo }, refused);
    isBusy.value = false;
  };
  return html`<${EmptyState} icon=${icon} title=${title}>
    ${
      mayManage.value &&
      html`<p><button type="button" class="button primary" disabled=${isBusy.value} onClick=${start}>
        ${isBusy.value ? html`<span class="spinner"></span>` : html`<${Icon} name="animate" />`}${t("demo_first.start", { demo })}</button></p>`
    }
    ${refused.value && html`<p class="note bad" role="alert">${refused.value}</p>`}
    <p class="note">${t("demo_first.command")} <code>${`studio demos ${demo}`}</code></p>
  <//>`;
}
