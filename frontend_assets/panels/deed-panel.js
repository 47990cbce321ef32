/** What panels that do something in ROS 2 are made of: a list to choose from, a form, what became of it. */

/** @import { ComponentChildren } from "vendor/preact.js" */
/** @import { OfferView } from "../types/wire.d.ts" */
/** @import { PastedLine } from "../lib/ros2-lines.js" */
/** @import { MessageForm } from "../model/message-forms.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected, NothingThere, RouterAway } from "../app/connect-first.js";
import { Refusal } from "../app/refusal.js";
import { t } from "../lib/i18n.js";
import { readLine } from "../lib/ros2-lines.js";
import { useSeen } from "../lib/seen.js";
import { Icon, IconButton, SearchBox } from "../lib/ui.js";
import { mayEdit, role } from "../model/connection.js";
import { matchingOffers } from "../model/operations.js";
import { FormOfMessage } from "./message-form.js";

/** @type {Record<string, string>} */
const ICONS = { bad: "error", cancelled: "stop", canceled: "stop", stopped: "stop" };

/**
 * @typedef {object} DeedPanelProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {PastedLine["kind"]} kind of command lines that it takes
 * @property {(() => () => void)[]} follow what it needs while it is looked at
 * @property {(line: PastedLine) => void} onLine
 * @property {(paste: (text: string) => boolean) => ComponentChildren} children
 */

/** @param {MessageForm} form @returns {(line: PastedLine) => void} takes a command line into a form */
export const openLine =
  (form) =>
  ({ name, type, text }) =>
    void form.open({ name: name.startsWith("/") ? name : `/${name}`, type }, text);

/** @param {DeedPanelProps} props the panel itself: a command line may be pasted anywhere into it */
export function DeedPanel({ id, icon, kind, follow, onLine, children }) {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (is) => {
    seen.value = is;
  });
  const looking = seen.value;
  useEffect(() => {
    const ends = looking ? follow.map((begin) => begin()) : [];
    return () => {
      for (const end of ends) end();
    };
  }, [looking]);
  const take = (/** @type {string} */ text) => {
    const line = readLine(text);
    if (line?.kind !== kind) return false;
    onLine(line);
    return true;
  };
  const onPaste = (/** @type {ClipboardEvent} */ event) => {
    if (mayEdit.value && take(event.clipboardData?.getData("text/plain") ?? ""))
      event.preventDefault();
  };
  return html`<section ref=${panel} class="panel-body deeds" aria-label=${t(`panel.${id}`)} onPaste=${onPaste}>
    <${RouterAway} />
    ${role.value === "viewer" && html`<p class="note panel-said">${t("deeds.viewer")}</p>`}
    ${isUnconnected() ? html`<${ConnectFirst} icon=${icon} />` : children(take)}
  </section>`;
}

/**
 * @typedef {object} OffersProps
 * @property {string} id of the panel
 * @property {string} icon
 * @property {readonly OfferView[] | null} offers null: not told yet
 * @property {string} refused why they are not told
 * @property {() => void} again
 * @property {MessageForm} form
 * @property {(text: string) => boolean} paste takes a command line
 * @property {boolean} [noisy] there are some that every node has
 * @property {ComponentChildren} [next] what to do where there is nothing at all
 * @property {ComponentChildren} [children] what stands below the list
 */

/** @param {OffersProps} props */
export function Offers({
  id,
  icon,
  offers,
  refused,
  again,
  form,
  paste,
  noisy = false,
  next,
  children,
}) {
  const filter = useSignal("");
  const all = useSignal(false);
  const onInput = (/** @type {string} */ text) => {
    filter.value = mayEdit.value && paste(text) ? "" : text;
  };
  const toggle = () => {
    all.value = !all.value;
  };
  const shown = matchingOffers(offers ?? [], filter.value, all.value);
  return html`<div class="deeds-list">
    <div class="panel-bar"><${SearchBox} label=${t(`${id}.filter`)} value=${filter.value} onInput=${onInput} />
      ${noisy && html`<${IconButton} icon=${all.value ? "eye" : "eyeOff"} label=${t(`${id}.all`)} pressed=${all.value} onClick=${toggle} />`}</div>
    ${refused && html`<${Refusal} sentence=${refused} again=${again} />`}
    ${
      offers &&
      shown.length === 0 &&
      html`<${NothingThere} icon=${icon} title=${whyNothing(id, offers.length, filter.value)}>
      ${offers.length === 0 && next}
      ${offers.length > 0 && filter.value === "" && html`<button type="button" class="button" onClick=${toggle}>${t(`${id}.all`)}</button>`}<//>`
    }
    ${shown.length > 0 && html`<ul class="scroll offers" aria-label=${t(`panel.${id}`)}>${shown.map((one) => html`<${OfferRow} key=${one.name} offer=${one} form=${form} />`)}</ul>`}
    ${children}
  </div>`;
}

/** @param {string} id of the panel @param {number} count of all offers @param {string} filter @returns {string} why none of them is shown */
function whyNothing(id, count, filter) {
  if (count === 0) return t(`${id}.none`);
  return filter === "" ? t("deeds.only_noise", { count }) : t("deeds.filtered");
}

/** @param {{offer: OfferView, form: MessageForm}} props */
function OfferRow({ offer: { name, types, nodes }, form }) {
  const type = types[0] ?? "";
  const isChosen = form.chosen.value?.name === name;
  return html`<li><button type="button" class="offer" aria-pressed=${isChosen} title=${[name, ...types, ...nodes].join("\n")}
    onClick=${() => isChosen || form.open({ name, type })}>
    <span class="offer-name">${name}</span><span class="offer-type">${types.join(", ")}</span><span class="offer-node">${nodes.join(", ")}</span></button></li>`;
}

/** @param {{form: MessageForm, onSubmit: () => void, actions: ComponentChildren, children?: ComponentChildren}} props what is chosen, its form, and what can be done with it */
export function DeedForm({ form, onSubmit, actions, children }) {
  const { name = "", type = "" } = form.chosen.value ?? {};
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (mayEdit.value && !form.wrong.value) onSubmit();
  };
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) submit(event);
  };
  return html`<form class="deed-form" aria-label=${name} onSubmit=${submit} onKeyDown=${onKeyDown} novalidate>
    <header class="deed-head"><${IconButton} icon="chevronRight" class="deed-back" label=${t("deeds.back")} onClick=${form.close} />
      <h3 title=${name}>${name}</h3><span class="offer-type" title=${type}>${type}</span></header>
    <${FormOfMessage} form=${form} disabled=${!mayEdit.value} />
    <div class="deed-actions">${actions}</div>
    ${children}
  </form>`;
}

/** @param {{state: string, busy: boolean, bad: boolean, words: string}} props how a deed stands */
export function DeedState({ state, busy, bad, words }) {
  const isGivenUp = ICONS[state] === "stop";
  const icon = ICONS[bad ? "bad" : state] ?? "check";
  return html`<span class=${`deed-state ${bad ? "bad" : ""} ${isGivenUp ? "given-up" : ""}`} role="status">${busy ? html`<span class="spinner"></span>` : html`<${Icon} name=${icon} size=${13} />`}<span>${words}</span></span>`;
}
