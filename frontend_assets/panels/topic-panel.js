/**
 * A panel that shows what comes on one topic: the choice of the topic, its newest message, and why
 * there is none.
 */

/** @import { TopicRow } from "../types/wire.d.ts" */
/** @import { Echo, Ways } from "../model/data-lane.js" */
/** @import { Echoed, SubscriptionView } from "../workers/subscriptions.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shortTime, useSilence } from "../lib/times.js";
import { Icon, MenuButton, ProgressBar } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";
import { echo, laneOpen } from "../model/data-lane.js";
import { isPast } from "../model/time.js";
import { followTopics, topics } from "../model/topics.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "./parts.js";

/**
 * @typedef {object} TopicPanelProps
 * @property {string} title of the panel
 * @property {string} icon
 * @property {string} name of its class
 * @property {readonly string[]} types of the messages that it can show
 * @property {string} label of the button that chooses the topic
 * @property {string} none that there is no such topic
 * @property {string} hint what to do then
 * @property {Signal<string>} [chosen] the topic that a person chose, where the page remembers it; empty: the first that there is
 * @property {(props: Chosen) => import("vendor/preact.js").VNode} shown draws the topic; made anew for another topic
 */

/** @typedef {{topic: string, type: string, menu: import("vendor/preact.js").VNode}} Chosen `menu`: the button that chooses the topic, for the panel's bar; `type`: empty while nobody has the topic */

/** @param {TopicPanelProps} props what is missing is said in place of the topic */
export function TopicPanel({ title, icon, name, chosen, ...props }) {
  const { panel, looking } = useLooking(followTopics);
  const own = useSignal("");
  return html`<section ref=${panel} class=${`panel-body ${name}`} aria-label=${title}>
    <${RouterAway} />
    ${isUnconnected() ? html`<${ConnectFirst} icon=${icon} />` : looking && html`<${Content} ...${props} icon=${icon} chosen=${chosen ?? own} />`}
  </section>`;
}

/** @param {Omit<TopicPanelProps, "title" | "name"> & {chosen: Signal<string>}} props */
function Content({ icon, types, chosen, label, none, hint, shown: Shown }) {
  if (!topics.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const choices = topics.value.filter((one) => one.types.some((type) => types.includes(type)));
  const topic = chosen.value || (choices[0]?.name ?? "");
  if (!topic) return html`<${NothingThere} icon=${icon} title=${none}><p>${hint}</p><//>`;
  const row = choices.find(({ name }) => name === topic);
  const type = row?.types.find((one) => types.includes(one)) ?? "";
  const menu = html`<${TopicMenu} topic=${topic} choices=${choices} chosen=${chosen} label=${label} />`;
  return html`<${Shown} key=${`${topic} ${type}`} topic=${topic} type=${type} menu=${menu} />`;
}

/** @param {{topic: string, choices: readonly TopicRow[], chosen: Signal<string>, label: string}} props */
function TopicMenu({ topic, choices, chosen, label }) {
  const items = () =>
    choices.map(({ name }) => ({
      label: name,
      checked: name === topic,
      run: () => {
        chosen.value = name;
      },
    }));
  return html`<${MenuButton} label=${label} value=${topic} hint=${topic} class="button topic-menu" items=${items}><span class="topic-name">${topic}</span><${Icon} name="chevronDown" size=${12} /><//>`;
}

/** @typedef {{subscription: SubscriptionView | null, message: Echoed | null, why: string, lane: {current: Echo | null}}} Newest null: it has not come yet; `why` there is no message, or no new one, and what to do: empty when all is well */

/**
 * Subscribe to a topic as long as the component stands.
 *
 * @param {string} topic
 * @param {Ways} ways
 * @param {() => boolean} [isTaken] whether a message that comes now is to be shown
 * @returns {Newest}
 */
export function useNewest(topic, ways, isTaken = () => true) {
  const subscription = useSignal(/** @type {SubscriptionView | null} */ (null));
  const message = useSignal(/** @type {Echoed | null} */ (null));
  const lane = useRef(/** @type {Echo | null} */ (null));
  const newest_s = useRef(0);
  const silence = useSilence();
  useEffect(() => {
    lane.current = echo(topic, ways, {
      onState: (view) => {
        subscription.value = view;
      },
      onMessage: (came) => {
        // What is unfolded comes again, as part of the same message.
        if (came.received_s !== newest_s.current) silence.came();
        newest_s.current = came.received_s;
        if (isTaken()) message.value = came;
      },
    });
    return lane.current.leave;
  }, [topic, JSON.stringify(ways)]);
  return {
    subscription: subscription.value,
    message: message.value,
    why:
      whyNothing(subscription.value) ||
      whyNoMessage(message.value, silence.silent_s, subscription.value),
    lane,
  };
}

/** @param {SubscriptionView | null} subscription @returns {string} empty: it receives what is published */
export function whyNothing(subscription) {
  if (!laneOpen.value) return t("topics.state.lane");
  if (!subscription) return t("loading");
  if (subscription.state === "receiving") return "";
  return (
    subscription.reason ||
    t(`topics.state.${subscription.state}`, { types: subscription.types.join(", ") })
  );
}

/** @param {Echoed | null} message @param {number} silent_s @param {SubscriptionView | null} subscription @returns {string} */
function whyNoMessage(message, silent_s, subscription) {
  if (message?.trouble) return t("topics.unread", { reason: message.trouble.replace(/\.$/, "") });
  if (!message) return t("topics.state.waiting");
  // What is latched is published once and holds, and the past may stand still.
  return silent_s > 0 && !subscription?.latched && !isPast.value
    ? t("topics.state.silent", { time: shortTime(silent_s) })
    : "";
}
