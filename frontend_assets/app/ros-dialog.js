/**
 * The window on ROS 2: how the studio is connected, where it looks, why nobody may be seen, and
 * what to type on a robot.
 */

/** @import { WireReport } from "../types/wire.d.ts" */
/** @import { Place } from "../model/ros.js" */
/** @import { ComponentChildren, Signal } from "vendor/preact.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { DdsTag } from "../lib/dds-tag.js";
import { t } from "../lib/i18n.js";
import { Dialog, Icon } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import {
  connectAt,
  DISTROS,
  DOMAIN_MAX,
  disconnectRos,
  examineAt,
  hostOf,
  isDomain,
  isSamePlace,
  recentPlaces,
  ros,
} from "../model/ros.js";
import { CodeLine } from "./code-line.js";
import { Bridges, WhyEmpty } from "./ros-bridges.js";
import { Recipes } from "./ros-recipes.js";

/** @returns {Place} where the studio is, or looks */
const placeNow = () => ({
  address: ros.value.endpoint,
  domain: ros.value.domain,
  distro: /** @type {Place["distro"]} */ (ros.value.distro),
});

/** What the window keeps, and what can be done in it. */
function useConnecting() {
  const draft = useSignal(placeNow());
  const busy = useSignal(/** @type {"" | "look" | "connect"} */ (""));
  const error = useSignal("");
  const report = useSignal(/** @type {WireReport | null} */ (null));
  const look = async () => {
    if (!mayManage.value) return;
    busy.value = "look";
    const answer = await examineAt(draft.value);
    busy.value = "";
    error.value = typeof answer === "string" ? answer : "";
    report.value = typeof answer === "string" ? null : answer;
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
  const connecting = useConnecting();
  const trouble = connecting.error.value || ros.value.trouble;
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    connecting.connect(connecting.draft.value);
  };
  return html`<${Dialog} title=${t("ros")} closeLabel=${t("close")} class="ros-dialog" onClose=${onClose}>
    <form class="open-form" onSubmit=${submit}>
      <div class="form-scroll">
        <${Standing} onConnect=${connecting.connect} />
        <${PlaceFields} place=${connecting.draft} />
        <${RecentPlaces} onChoose=${(/** @type {Place} */ place) => {
          connecting.draft.value = place;
          connecting.look();
        }} />
        ${trouble && html`<p class="dialog-text bad" role="alert">${trouble}</p>`}
        ${connecting.report.value && html`<${Report} report=${connecting.report.value} onConnect=${connecting.connect} />`}
        <${Recipes} />
      </div>
      <${Foot} connecting=${connecting} />
    </form>
  <//>`;
}

/** @param {{connecting: ReturnType<typeof useConnecting>}} props */
function Foot({ connecting: { draft, busy, look, leave } }) {
  const { state } = ros.value;
  const stands = state === "connected" || state === "lost";
  const isElsewhere = !isSamePlace(draft.value, placeNow());
  const off = !mayManage.value || busy.value !== "";
  const isNowhere = !isDomain(draft.value.domain);
  return html`<footer>
    <span class="form-note">${mayManage.value ? "" : t("ros.viewer")}</span><span class="push"></span>
    <button type="button" class="button" disabled=${off || isNowhere} onClick=${look}>
      ${busy.value === "look" && html`<span class="spinner"></span>`}${t("ros.test")}</button>
    ${stands && html`<button key="leave" type="button" class="button" title=${t("ros.disconnect.note")} disabled=${off} onClick=${leave}>${t("ros.disconnect")}</button>`}
    ${(!stands || isElsewhere) && html`<${ConnectButton} busy=${busy.value === "connect"} off=${off || isNowhere} />`}
  </footer>`;
}

/** @param {{busy: boolean, off: boolean}} props */
function ConnectButton({ busy, off }) {
  const isUnderWay = busy || ros.value.state === "connecting";
  return html`<button key="connect" type="submit" class="button primary" disabled=${!mayManage.value || off || isUnderWay}>
    ${isUnderWay && html`<span class="spinner"></span>`}${t("ros.connect")}</button>`;
}

/** @param {{onConnect: (place: Place) => void}} props how the connection stands, in words; and where, and who else is there */
function Standing({ onConnect }) {
  const { state, router, endpoint, domain, distro, bridges } = ros.value;
  const onDomain = (/** @type {number} */ other) => onConnect({ ...placeNow(), domain: other });
  const isThere = state === "connected" || state === "lost";
  return html`<p class="dialog-text ros-lead"><${Icon} name=${state === "connected" ? "check" : state === "off" ? "info" : "alert"} size=${16} /><span>${t(`ros.${state}.text`)}</span></p>
    ${
      isThere &&
      html`<dl class="ros-facts">
      <dt>${t("ros.address")}</dt><dd>${endpoint} <span class="muted">${t(`ros.router.${router}`)}</span></dd>
      <dt>${t("ros.domain")}</dt><dd>${domain}</dd>
      <dt>${t("ros.distro")}</dt><dd>${distro}</dd>
      ${state === "connected" && html`<dt>${t("ros.others")}</dt><dd><${Nodes} /></dd>`}
      ${bridges.length > 0 && html`<dt>${t("ros.bridges")}</dt><dd><${Bridges} bridges=${bridges} domain=${domain} onDomain=${onDomain} /></dd>`}
    </dl>`
    }`;
}

function Nodes() {
  const { nodes, behind, node_count: count } = ros.value;
  if (count === 0) return html`<span class="muted">${t("ros.nobody")}</span>`;
  return html`<ul class="ros-nodes">${nodes.map((name) => html`<li key=${name}>${name}<${DdsTag} bridge=${behind[name] ?? ""} /></li>`)}
    ${count > nodes.length && html`<li class="muted">${t("ros.more", { count: count - nodes.length })}</li>`}</ul>`;
}

const EXAMPLE = "robot.local:7447";

/** @param {{place: Signal<Place>}} props */
function PlaceFields({ place }) {
  const off = !mayManage.value;
  const { address, domain, distro } = place.value;
  const change = (/** @type {Partial<Place>} */ news) => {
    place.value = { ...place.value, ...news };
  };
  return html`<div class="ros-fields">
    <label class="field ros-address"><span>${t("ros.place.address")}</span>
      <input type="text" class="box wide" data-first maxlength="300" spellcheck=${false} autocapitalize="off" list="ros-places" disabled=${off}
        placeholder=${EXAMPLE} value=${address} onInput=${(/** @type {any} */ event) => change({ address: event.currentTarget.value })} />
      <datalist id="ros-places">${[...new Set(recentPlaces.value.map((one) => one.address))].map((one) => html`<option key=${one} value=${one}></option>`)}</datalist></label>
    <label class="field"><span>${t("ros.domain")}</span>
      <input type="number" class="box" min="0" max=${DOMAIN_MAX} step="1" disabled=${off} value=${Number.isNaN(domain) ? "" : domain}
        onInput=${(/** @type {any} */ event) => change({ domain: event.currentTarget.valueAsNumber })} /></label>
    <label class="field"><span>${t("ros.distro")}</span>
      <select class="box" disabled=${off} value=${distro} onChange=${(/** @type {any} */ event) => change({ distro: event.currentTarget.value })}>
        ${DISTROS.map((one) => html`<option key=${one} value=${one}>${one}</option>`)}</select></label>
  </div>`;
}

/** @param {{onChoose: (place: Place) => void}} props */
function RecentPlaces({ onChoose }) {
  const places = recentPlaces.value;
  if (places.length === 0 || !mayManage.value) return null;
  return html`<div class="ros-recent" role="group" aria-label=${t("ros.recent")}>
    <span class="muted">${t("ros.recent")}</span>
    ${places.map(
      (
        place,
      ) => html`<button key=${`${place.address} ${place.domain} ${place.distro}`} type="button" class="button small" title=${t("ros.recent.hint", { ...place })}
        onClick=${() => onChoose(place)}>${place.address}<span class="muted">${t("ros.recent.domain", { domain: place.domain })}</span></button>`,
    )}
  </div>`;
}

const NAMED = 3;

/**
 * What was found at a place, and what to do when nobody can be met there.
 *
 * @param {{report: WireReport, onConnect: (place: Place) => void}} props
 */
function Report({ report, onConnect }) {
  const isFine = report.verdict === "fine";
  const onDomain = (/** @type {number} */ domain) => onConnect(placeOf(report, { domain }));
  return html`<section class=${`ros-report ${isFine ? "good" : "amber"}`} role="status" aria-label=${t("ros.report")}>
    <p><${Icon} name=${isFine ? "check" : "alert"} size=${15} /><span>${sentence(report)}</span></p>
    <${Remedy} report=${report} onConnect=${onConnect} />
    ${!isMet(report) && report.bridges.length > 0 && html`<${Bridges} bridges=${report.bridges} domain=${report.domain} onDomain=${onDomain} />`}
  </section>`;
}

/** @param {WireReport} report @returns {boolean} it is of where the studio is connected, whose bridges are listed already */
const isMet = ({ endpoint, domain }) =>
  ros.value.state === "connected" && ros.value.endpoint === endpoint && ros.value.domain === domain;

/** @param {WireReport} report @returns {string} */
function sentence(report) {
  const { verdict, endpoint, domain, distro, nodes, unseen } = report;
  const isUntold = verdict === "fine" && report.distros.length === 0;
  const named = report.types.slice(0, NAMED).join(", ");
  const more = report.types.length - NAMED;
  return t(isUntold ? "ros.report.fine.untold" : `ros.report.${verdict}`, {
    endpoint,
    domain,
    distro,
    count: verdict === "unseen" ? unseen : nodes,
    distros: report.distros.join(t("ros.report.or")),
    types: more > 0 ? t("ros.report.types", { named, count: more }) : named,
  });
}

/** @param {{report: WireReport, onConnect: (place: Place) => void}} props */
function Remedy({ report, onConnect }) {
  switch (report.verdict) {
    case "no_router":
      return html`<${StartRouter} report=${report} />`;
    case "other_domain":
      return html`<${Domains} report=${report} onConnect=${onConnect} />`;
    case "fine":
      return isOfOthers(report)
        ? html`<p class="ros-hint">${t("ros.report.fine.distro")}</p><${Distros} report=${report} onConnect=${onConnect} />`
        : null;
    case "bridge":
      return html`<${WhyEmpty} bridges=${report.bridges} />`;
    case "other_distro":
      return html`<${Distros} report=${report} onConnect=${onConnect} />`;
    case "unseen":
      return html`<p class="ros-hint">${t("ros.report.unseen.do")}</p>
        <${CodeLine} code="ros2 run rmw_zenoh_cpp rmw_zenohd" />`;
    case "alone":
      return html`<${CodeLine} code="export RMW_IMPLEMENTATION=rmw_zenoh_cpp" />`;
    default:
      return null;
  }
}

/** @param {WireReport} report @returns {boolean} the nodes are of another distribution, whose types the page knows */
const isOfOthers = ({ distro, distros }) =>
  distros.length > 0 && !distros.includes(distro) && DISTROS.some((one) => distros.includes(one));

/** @param {{report: WireReport}} props the commands that start one, there */
function StartRouter({ report }) {
  const host = hostOf(report.endpoint);
  const where = host === "" ? t("ros.report.start_here") : t("ros.report.start_at", { host });
  const reach = host === "" ? "" : " --listen tcp/0.0.0.0:7447";
  return html`${report.starts_router && html`<p class="ros-hint">${t("ros.report.starts")}</p>`}
    <p class="ros-hint">${where}</p>
    <${CodeLine} code="ros2 run rmw_zenoh_cpp rmw_zenohd" />
    <${CodeLine} code=${`studio router${reach}`} />`;
}

/** @param {{report: WireReport, onConnect: (place: Place) => void}} props */
function Domains({ report, onConnect }) {
  return html`<${Choices}>${report.domains.map(
    ({ domain, nodes }) =>
      html`<button key=${domain} type="button" class="button" onClick=${() => onConnect(placeOf(report, { domain }))}>
        ${t("ros.report.switch_domain", { domain, count: nodes })}</button>`,
  )}<//>`;
}

/** @param {{report: WireReport, onConnect: (place: Place) => void}} props */
function Distros({ report, onConnect }) {
  const known = DISTROS.filter(
    (one) => report.distros.includes(one) && !report.distros.includes(report.distro),
  );
  if (known.length === 0) return html`<p class="ros-hint">${t("ros.report.give_types")}</p>`;
  return html`<${Choices}>${known.map(
    (distro) =>
      html`<button key=${distro} type="button" class="button" onClick=${() => onConnect(placeOf(report, { distro }))}>
        ${t("ros.report.switch_distro", { distro })}</button>`,
  )}<//>`;
}

/** @param {{children: ComponentChildren}} props */
const Choices = ({ children }) => html`<div class="ros-choices">${children}</div>`;

/** @param {WireReport} report @param {Partial<Place>} news @returns {Place} the place that was looked at, with something else */
const placeOf = (report, news) => ({
  address: report.endpoint,
  domain: report.domain,
  distro: /** @type {Place["distro"]} */ (report.distro),
  ...news,
});
