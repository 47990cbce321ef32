/** Who publishes a topic and who subscribes to it, how, and what keeps them apart. */

/** @import { Misfit, TopicEnd, TopicEnds as Ends } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { useTold } from "../model/asking.js";
import { topicEnds } from "../model/topics.js";

const LOOK_EVERY_MS = 2000;

/** @param {{topic: string, listed: boolean}} props what keeps them apart is said in any case */
export function TopicEnds({ topic, listed }) {
  const first = /** @type {Ends | null} */ (null);
  const told = useTold(first, () => topicEnds(topic), LOOK_EVERY_MS, [topic]).value;
  if (!told) return listed && html`<p class="note padded">${t("loading")}</p>`;
  if (!listed && told.misfits.length === 0) return null;
  return html`<div class="topics-ends scroll">
    ${listed && html`<${Side} title=${t("topics.publishers", { count: told.publishers.length })} ends=${told.publishers} />`}
    ${listed && html`<${Side} title=${t("topics.subscribers", { count: told.subscribers.length })} ends=${told.subscribers} />`}
    ${told.misfits.map((one) => html`<${Apart} key=${one.publisher + one.subscriber} misfit=${one} />`)}
  </div>`;
}

/** @param {{title: string, ends: readonly TopicEnd[]}} props */
function Side({ title, ends }) {
  return html`<h3>${title}</h3><ul>${ends.map(
    (end, n) =>
      html`<li key=${n}><span>${end.node}${end.own && html` <small class="muted">${t("topics.own")}</small>`}</span><small class="muted">${qosOf(end)}</small></li>`,
  )}</ul>`;
}

/** @param {TopicEnd} end @returns {string} */
function qosOf(end) {
  const words = [
    end.reliability,
    end.durability,
    `${end.history} ${end.depth}`,
    end.deadline_s === null ? "" : t("topics.deadline", { time: end.deadline_s }),
    end.lifespan_s === null ? "" : t("topics.lifespan", { time: end.lifespan_s }),
    end.liveliness === "automatic" ? "" : end.liveliness,
  ];
  return words.filter(Boolean).join(" · ");
}

/** @param {{misfit: Misfit}} props what DDS would do, and what Zenoh does */
function Apart({ misfit }) {
  const { publisher, subscriber, reasons, heard } = misfit;
  return html`<p class="topics-apart"><${Icon} name="alert" size=${13} /><span>${t(
    heard ? "topics.apart.dds" : "topics.apart.all",
    { publisher, subscriber, reasons: reasons.join("; ") },
  )}</span></p>`;
}
