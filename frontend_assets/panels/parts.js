/**
 * What several panels have: how to connect with ROS 2, why the studio told nothing, a place in a
 * file as a link, and the key of Reset.
 */

/** @import { Place } from "../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { placeText } from "../lib/paths.js";
import { EmptyState, Icon } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import { connectRos, ros } from "../model/ros.js";
import { showSource } from "../model/source.js";
import { isBag, isPast } from "../model/time.js";
import { dialog } from "../model/view.js";

/** @returns {boolean} it was connected, and its router is away: nobody is seen, heard or told anything */
export const isRouterAway = () => ros.value.state === "lost" && !isBag.value;

/** What a panel says while the router is away, above what it shows. */
export function RouterAway() {
  if (!isRouterAway()) return null;
  return html`<p class="note bad panel-said" role="status">${t("ros.lost.at", { endpoint: ros.value.endpoint })}</p>`;
}

/** @param {Parameters<typeof EmptyState>[0]} props what a list says in which nothing is; nothing, while nobody can be seen */
export const NothingThere = (props) => (isRouterAway() ? null : EmptyState(props));

/** @returns {boolean} no ROS 2 system can be told anything now */
export const isWireAway = () => ros.value.state !== "connected" && ros.value.state !== "lost";

/** @returns {boolean} no messages can come: neither of a ROS 2 system, nor of a recording */
export const isUnconnected = () => isWireAway() && !isPast.value;

/** What a panel says that acts while others show another time. */
export function PastNote() {
  if (!isPast.value || isWireAway()) return null;
  return html`<p class="note panel-said"><${Icon} name="history" size=${13} />${t("timeline.acts_now")}</p>`;
}

/** @param {{icon: string}} props */
export function ConnectFirst({ icon }) {
  const busy = useSignal(false);
  const connect = async () => {
    busy.value = true;
    await connectRos();
    busy.value = false;
  };
  const choose = () => {
    dialog.value = { kind: "ros" };
  };
  const isUnderWay = busy.value || ros.value.state === "connecting";
  const { nearby_count: count } = ros.value;
  return html`<${EmptyState} icon=${icon} title=${count > 0 ? t("ros.first.nearby", { count }) : t("ros.first")}>
    ${
      mayManage.value
        ? html`<p class="connect-first">
      <button type="button" class="button primary" disabled=${isUnderWay} onClick=${connect}>
        ${isUnderWay ? html`<span class="spinner"></span>` : html`<${Icon} name="link" />`}${t("ros.connect")}</button>
      <button type="button" class="button" onClick=${choose}>${t("ros.elsewhere")}…</button></p>`
        : html`<p>${t("ros.viewer")}</p>`
    }
  <//>`;
}

/**
 * What stands in a panel that the studio told nothing: its sentence, and another try.
 *
 * @param {{sentence: string, again: () => void}} props
 */
export function Refusal({ sentence, again }) {
  return html`<div class="refusal" role="alert"><${EmptyState} icon="alert" title=${sentence}>
    <button type="button" class="button" onClick=${again}><${Icon} name="reload" />${t("try_again")}</button><//></div>`;
}

/**
 * A place in a file as a link: it leads to the line in the source.
 *
 * @param {{place: Place | null | undefined, words?: string}} props `words` in place of `name.xacro:12`
 */
export function PlaceLink({ place, words }) {
  const text = words ?? placeText(place ?? null);
  if (!place?.line) return text ? html`<span class="place">${text}</span>` : null;
  return html`<span class="place"><button type="button" class="text-button" title=${t("property.show_source")}
    onClick=${() => showSource(place.file, place.line, place.column || 1)}>${text}</button></span>`;
}

/** @param {KeyboardEvent} event Ctrl+R in a panel of what is shown, where no row takes it */
export function onResetKey(event) {
  const { key, ctrlKey, metaKey, shiftKey, altKey, defaultPrevented } = event;
  if (defaultPrevented || key !== "r" || !(ctrlKey || metaKey) || shiftKey || altKey) return;
  const reset = commandById("reset_scene");
  if (!reset || reset.enabled?.() === false) return;
  event.preventDefault();
  reset.run();
}
