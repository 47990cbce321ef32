/** The window on ROS 2: how the studio is connected, where it looks, and why nobody may be seen. */

/** @import { WireReport } from "../types/wire.d.ts" */
/** @import { Place } from "../model/ros.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { connectAt, disconnectRos, examineAt, isDomain, isSamePlace, ros } from "../model/ros.js";
import { PlaceFields, RecentPlaces } from "./ros-place.js";
import { Recipes } from "./ros-recipes.js";
import { Report } from "./ros-report.js";

/** @returns {Place} where the studio is, or looks */
const placeNow = () => ({
  address: ros.value.endpoint,
  domain: ros.value.domain,
  distro: /** @type {Place["distro"]} */ (ros.value.distro),
});

/** What the window keeps, and what can be done in it. */
function useDesk() {
  const draft = useSignal(placeNow());
  const busy = useSignal(/** @type {"" | "look" | "connect"} */ (""));
  const error = useSignal("");
  const report = useSignal(/** @type {WireReport | null} */ (null));
  const look = async () => {
    if (!mayEdit.value) return;
    busy.value = "look";
    const told = await examineAt(draft.value);
    busy.value = "";
    error.value = typeof told === "string" ? told : "";
    report.value = typeof told === "string" ? null : told;
  };
  const connect = async (/** @type {Place} */ place) => {
    draft.value = place;
    busy.value = "connect";
    const refused = await connectAt(place);
    if (refused === "") draft.value = placeNow();
    await look();
    error.value ||= refused;
  };
  const leave = async () => {
    busy.value = "connect";
    await disconnectRos();
    busy.value = "";
  };
  useEffect(() => {
    look();
  }, []);
  return { draft, busy, error, report, look, connect, leave };
}

/** @param {{onClose: () => void}} props */
export function RosDialog({ onClose }) {
  const desk = useDesk();
  const trouble = desk.error.value || ros.value.trouble;
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    desk.connect(desk.draft.value);
  };
  return html`<${Dialog} title=${t("ros")} closeLabel=${t("close")} class="ros-dialog" onClose=${onClose}>
    <form class="open-form" onSubmit=${submit}>
      <div class="form-scroll">
        <${Standing} />
        <${PlaceFields} place=${desk.draft} />
        <${RecentPlaces} onChoose=${(/** @type {Place} */ place) => {
          desk.draft.value = place;
          desk.look();
        }} />
        ${trouble && html`<p class="dialog-text bad" role="alert">${trouble}</p>`}
        ${desk.report.value && html`<${Report} report=${desk.report.value} onConnect=${desk.connect} />`}
        <${Recipes} />
      </div>
      <${Foot} desk=${desk} />
    </form>
  <//>`;
}

/** @param {{desk: ReturnType<typeof useDesk>}} props */
function Foot({ desk: { draft, busy, look, leave } }) {
  const { state } = ros.value;
  const stands = state === "connected" || state === "lost";
  const isElsewhere = !isSamePlace(draft.value, placeNow());
  const off = !mayEdit.value || busy.value !== "";
  const isNowhere = !isDomain(draft.value.domain);
  return html`<footer>
    <span class="form-note">${mayEdit.value ? "" : t("ros.viewer")}</span><span class="push"></span>
    <button type="button" class="button" disabled=${off || isNowhere} onClick=${look}>
      ${busy.value === "look" && html`<span class="spinner"></span>`}${t("ros.test")}</button>
    ${stands && html`<button key="leave" type="button" class="button" title=${t("ros.disconnect.note")} disabled=${off} onClick=${leave}>${t("ros.disconnect")}</button>`}
    ${(!stands || isElsewhere) && html`<${ConnectButton} busy=${busy.value === "connect"} off=${off || isNowhere} />`}
  </footer>`;
}

/** @param {{busy: boolean, off: boolean}} props */
function ConnectButton({ busy, off }) {
  const isUnderWay = busy || ros.value.state === "connecting";
  return html`<button key="connect" type="submit" class="button primary" disabled=${!mayEdit.value || off || isUnderWay}>
    ${isUnderWay && html`<span class="spinner"></span>`}${t("ros.connect")}</button>`;
}

/** How the connection stands, in words; and where, and who else is there. */
function Standing() {
  const { state, router, endpoint, domain, distro } = ros.value;
  const isThere = state === "connected" || state === "lost";
  return html`<p class="dialog-text ros-lead"><${Icon} name=${state === "connected" ? "check" : state === "off" ? "info" : "alert"} size=${16} /><span>${t(`ros.${state}.text`)}</span></p>
    ${
      isThere &&
      html`<dl class="ros-facts">
      <dt>${t("ros.address")}</dt><dd>${endpoint} <span class="muted">${t(`ros.router.${router}`)}</span></dd>
      <dt>${t("ros.domain")}</dt><dd>${domain}</dd>
      <dt>${t("ros.distro")}</dt><dd>${distro}</dd>
      ${state === "connected" && html`<dt>${t("ros.others")}</dt><dd><${Nodes} /></dd>`}
    </dl>`
    }`;
}

function Nodes() {
  const { nodes, node_count: count } = ros.value;
  if (count === 0) return html`<span class="muted">${t("ros.nobody")}</span>`;
  return html`<ul class="ros-nodes">${nodes.map((name) => html`<li key=${name}>${name}</li>`)}
    ${count > nodes.length && html`<li class="muted">${t("ros.more", { count: count - nodes.length })}</li>`}</ul>`;
}
