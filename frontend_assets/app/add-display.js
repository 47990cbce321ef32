/** The window to add a display: by a topic that somebody publishes, or by its kind. */

/** @import { DisplayKindView, TopicRate, TopicView } from "../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { foundTopics, includesAll } from "../lib/live-displays.js";
import { LongList } from "../lib/long-list.js";
import { remembered } from "../lib/remembered.js";
import { Dialog, Icon, SearchBox } from "../lib/ui.js";
import { askedWhenChanged, useTold } from "../model/asking.js";
import { mayEdit, mayManage } from "../model/connection.js";
import { addDisplay, kinds, needKinds, pluginFaults, topicsNow } from "../model/live-displays.js";
import { ask } from "../model/requests.js";
import { connectRos, ros } from "../model/ros.js";
import { ageWords, flowWords, useTopicRates } from "../model/topics.js";

/** @typedef {"topic" | "kind"} By */
/** @typedef {{key: string, icon: string, kind: string, topic: string, types: string, doc: string, publishers: number, off: string, file: string}} Offer `off`: why it cannot be added; `file`: of the owner's own display */

const TABS = /** @type {const} */ (["topic", "kind"]);
/** The demo that publishes what displays show. */
const ROVER = "rover";
/** Nodes come and go while the window is open. */
const lastTab = remembered("live.add.tab", /** @type {By} */ ("topic"), (value) =>
  TABS.includes(/** @type {By} */ (value)),
);

/** @param {{onClose: () => void}} props */
export function AddDisplayDialog({ onClose }) {
  const by = useSignal(lastTab.value);
  const words = useSignal("");
  const at = useSignal(0);
  const busy = useSignal(false);
  const topics = useTopics();
  const search = useRef(/** @type {HTMLElement | null} */ (null));
  const seek = () => search.current?.querySelector("input")?.focus();
  useEffect(() => void needKinds(), []);
  const offers =
    by.value === "topic"
      ? foundTopics(topics.value ?? [], words.value).flatMap(topicOffers)
      : kindOffers(words.value);
  const chosen = Math.min(at.value, offers.length - 1);
  const add = async (/** @type {Offer | undefined} */ offer) => {
    if (offer?.off !== "" || busy.value || !mayEdit.value) return;
    busy.value = true;
    const done = await addDisplay(offer.kind, offer.topic);
    busy.value = false;
    if (done) onClose();
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && offers.length > 0) at.value = (chosen + step + offers.length) % offers.length;
    else if (event.key === "Enter") add(offers[chosen]);
    else return;
    event.preventDefault();
  };
  const choose = (/** @type {By} */ tab) => {
    by.value = tab;
    lastTab.value = tab;
    at.value = 0;
  };
  return html`<${Dialog} title=${t("live.add.title")} closeLabel=${t("close")} class="add-display-dialog" onClose=${onClose}>
    <${Tabs} chosen=${by.value} onChoose=${choose} />
    <div class="add-display-page" role="tabpanel" id="add-display-page" aria-labelledby=${`add-display-${by.value}`}>
      <div class="add-display-search" ref=${search} onKeyDown=${onKeyDown}>
        <${SearchBox} first label=${t(`live.add.search.${by.value}`)} value=${words.value} onInput=${(
          /** @type {string} */ text,
        ) => {
          words.value = text;
          at.value = 0;
        }} />
      </div>
      ${by.value === "topic" && html`<${Connection} count=${topics.value?.length ?? 0} onDone=${seek} />`}
      <${OfferHead} by=${by.value} />
      <${Offers} offers=${offers} by=${by.value} chosen=${chosen} label=${t("live.add.title")} onPoint=${(
        /** @type {number} */ n,
      ) => {
        at.value = n;
      }} onAdd=${add} />
      ${offers.length === 0 && words.value !== "" && html`<p class="nothing">${t("filter.nothing", { words: words.value })}</p>`}
      <p class="offer-description" aria-live="polite">${descriptionOf(offers[chosen])}</p>
    </div>
    <footer><span class="push"></span>
      <button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" disabled=${!mayEdit.value || busy.value || !offers[chosen] || offers[chosen]?.off !== ""}
        onClick=${() => add(offers[chosen])}>${t("live.add")}</button></footer>
  <//>`;
}

/** @returns {import("vendor/preact.js").Signal<readonly TopicView[] | null>} kept up to date; null: not known yet */
function useTopics() {
  const first = /** @type {readonly TopicView[] | null} */ (null);
  return useTold(first, topicsNow, (look) => askedWhenChanged(look, "graph"));
}

/** @param {TopicView} topic @returns {Offer[]} one for each display that can show it, the best first */
function topicOffers({ name, types, publishers, kinds: fitting }) {
  const off = fitting.length === 0 ? t("live.add.unshown", { type: types[0] ?? "" }) : "";
  return (fitting.length > 0 ? fitting : [""]).map((kind) => ({
    key: `${name} ${kind}`,
    icon: kind === "" ? "minus" : (kinds.value.get(kind)?.icon ?? "box"),
    kind,
    topic: name,
    types: types.join(", "),
    doc: kinds.value.get(kind)?.doc ?? "",
    publishers,
    off,
    file: kinds.value.get(kind)?.plugin ?? "",
  }));
}

/** @param {string} kind @returns {string} without what the owner's own have before their names */
const kindName = (kind) => kind.slice(kind.lastIndexOf("/") + 1);

/** @param {string} words @returns {Offer[]} those of the owner's own that are switched off come last */
function kindOffers(words) {
  const known = [...kinds.value.values()].map(kindOffer);
  const broken = Object.entries(pluginFaults.value).filter(
    ([file]) => !known.some((one) => one.file === file),
  );
  return [...known, ...broken.map(brokenOffer)].filter(({ kind, doc, types, file }) =>
    includesAll([kind, doc, types, file].join(" "), words),
  );
}

/** @param {readonly [string, string]} fault @returns {Offer} */
const brokenOffer = ([file, fault]) => ({
  key: `off ${file}`,
  icon: "alert",
  kind: "",
  topic: "",
  types: "",
  doc: fault,
  publishers: 0,
  off: `${t("live.add.plugin_off")} ${fault}`,
  file,
});

/** @param {DisplayKindView} kind @returns {Offer} */
const kindOffer = ({ kind, doc, icon, types, plugin }) => ({
  key: kind,
  icon,
  kind,
  topic: "",
  types: types.join(", "),
  doc,
  publishers: 0,
  off: "",
  file: plugin,
});

/** @param {Offer | undefined} offer @returns {string} what the chosen one draws, or why it cannot be added */
function descriptionOf(offer) {
  if (!offer) return "";
  const { kind, doc, off, topic, publishers } = offer;
  const who = topic ? t("live.publishers", { count: publishers }) : "";
  return [off, kind && `${kindName(kind)}: ${doc}`, who].filter(Boolean).join(" · ");
}

/** @param {{by: By}} props the names of the columns; each row says them to screen readers by itself */
function OfferHead({ by }) {
  const columns =
    by === "topic"
      ? ["topic", "type", "display", "rate"].map((one) => [one, one === "type" ? "offer-wide" : ""])
      : ["display", "doc", "type"].map((one) => [one, one === "type" ? "offer-wide" : ""]);
  return html`<div class=${`offer-head of-${by}`} aria-hidden="true"><span></span>
    ${columns.map(([one, name]) => html`<span key=${one} class=${`${name} ${one === "rate" ? "numbers" : ""}`}>${t(`live.add.column.${one}`)}</span>`)}</div>`;
}

/** @param {{chosen: By, onChoose: (tab: By) => void}} props */
function Tabs({ chosen, onChoose }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    event.preventDefault();
    const next = chosen === "topic" ? "kind" : "topic";
    onChoose(next);
    const button = list.current?.querySelector(`#add-display-${next}`);
    if (button instanceof HTMLElement) button.focus();
  };
  return html`<div class="add-display-tabs" role="tablist" aria-label=${t("live.add.title")} ref=${list} onKeyDown=${onKeyDown}>
    ${TABS.map(
      (
        tab,
      ) => html`<button key=${tab} type="button" role="tab" id=${`add-display-${tab}`} aria-selected=${tab === chosen}
        aria-controls="add-display-page" tabindex=${tab === chosen ? 0 : -1} onClick=${() => onChoose(tab)}>${t(`live.add.by_${tab}`)}</button>`,
    )}
  </div>`;
}

/** @param {{count: number, onDone: () => void}} props why there are no topics, and what to do */
function Connection({ count, onDone }) {
  const busy = useSignal(false);
  const { state, endpoint, nearby_count: nearby } = ros.value;
  if (count > 0) return null;
  const connect = async () => {
    busy.value = true;
    await connectRos();
    busy.value = false;
    onDone();
  };
  const startRover = async () => {
    busy.value = true;
    if (await connectRos()) await ask({ type: "start_demo", demo: ROVER });
    busy.value = false;
    onDone();
  };
  if (state === "connected" || state === "connecting")
    return html`<p class="add-display-none" role="status">${t("live.add.no_topics", { endpoint })}</p>`;
  return html`<div class="add-display-none" role="status">
    <p>${nearby > 0 ? t("ros.first.nearby", { count: nearby }) : t("live.add.not_connected")}</p>
    <button type="button" class="button primary" disabled=${busy.value || !mayManage.value} onClick=${connect}>
      ${busy.value ? html`<span class="spinner"></span>` : html`<${Icon} name="link" />`}${t("ros.connect")}</button>
    ${
      nearby === 0 &&
      html`<p class="form-note">${t("live.add.demo")}</p>
    <button type="button" class="button" disabled=${busy.value || !mayManage.value} onClick=${startRover}>
      <${Icon} name="animate" />${t("live.add.start_rover")}</button>`
    }
  </div>`;
}

/** @param {{offers: readonly Offer[], by: By, chosen: number, label: string, onPoint: (n: number) => void, onAdd: (offer: Offer) => void}} props */
function Offers({ offers, by, chosen, label, onPoint, onAdd }) {
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const rates = useTopicRates(() => topicsInView(list.current));
  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }, [chosen]);
  return html`<div class="add-display-list scroll" role="listbox" tabindex="0" aria-label=${label} ref=${list}>
    <${LongList} items=${offers} keyOf=${(/** @type {Offer} */ { key }) =>
      key} row="40px" isKept=${(/** @type {Offer} */ offer) => offer === offers[chosen]}
      draw=${(
        /** @type {Offer} */ offer,
        /** @type {number} */ n,
      ) => html`<${OfferRow} key=${offer.key} offer=${offer} by=${by} chosen=${n === chosen} rate=${rates.value.get(offer.topic)}
        onPoint=${() => onPoint(n)} onAdd=${() => onAdd(offer)} />`} />
  </div>`;
}

/** @param {HTMLElement | null} list @returns {string[]} */
function topicsInView(list) {
  if (!list) return [];
  const view = list.getBoundingClientRect();
  return [...list.querySelectorAll("[data-topic]")]
    .filter((row) => {
      const { top, bottom } = row.getBoundingClientRect();
      return top < view.bottom && bottom > view.top;
    })
    .map((row) => row.getAttribute("data-topic") ?? "");
}

/** @param {{offer: Offer, by: By, chosen: boolean, rate: TopicRate | undefined, onPoint: () => void, onAdd: () => void}} props */
function OfferRow({ offer, by, chosen, rate, onPoint, onAdd }) {
  const { icon, kind, topic, types, doc, off, file } = offer;
  const name = html`<span>${kindName(kind) || file}${file && html` <span class="offer-mark" title=${t("live.add.plugin", { file })}>${t("live.add.own")}</span>`}</span>`;
  return html`<div role="option" class=${`display-offer of-${by}`} aria-selected=${chosen} aria-disabled=${off === "" ? null : "true"} data-topic=${topic || null}
    title=${off || doc} onClick=${onPoint} onDblClick=${onAdd}>
    <${Icon} name=${icon} size=${18} />
    ${
      by === "topic"
        ? html`<span>${topic}</span><span class="offer-more offer-wide" title=${types}>${types}</span>${name}<${Flow} rate=${rate} />`
        : html`${name}<span class="offer-more">${doc}</span><span class="offer-more offer-wide" title=${types}>${types}</span>`
    }
  </div>`;
}

/** @param {{rate: TopicRate | undefined}} props how often it comes, how much that is, and when it came last */
function Flow({ rate }) {
  const state = rate?.state ?? "waiting";
  const age = ageWords(rate);
  const quiet = { silent: t("live.reason.silent"), latched: t("live.latched") }[String(state)];
  return html`<span class=${`offer-flow ${state}`}>
    <span>${quiet ?? flowWords(rate)}</span><small>${age && t("tf.ago", { time: age })}</small></span>`;
}
