/** What was found at a place, and what to do when nobody can be met there. */

/** @import { ComponentChildren } from "vendor/preact.js" */
/** @import { WireReport } from "../types/wire.d.ts" */
/** @import { Place } from "../model/ros.js" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { DISTROS, hostOf } from "../model/ros.js";
import { CodeLine } from "./code-line.js";

const NAMED = 3;

/** @param {{report: WireReport, onConnect: (place: Place) => void}} props */
export function Report({ report, onConnect }) {
  const isFine = report.verdict === "fine";
  return html`<section class=${`ros-report ${isFine ? "good" : "amber"}`} role="status" aria-label=${t("ros.report")}>
    <p><${Icon} name=${isFine ? "check" : "alert"} size=${15} /><span>${sentence(report)}</span></p>
    <${Remedy} report=${report} onConnect=${onConnect} />
  </section>`;
}

/** @param {WireReport} report @returns {string} */
function sentence(report) {
  const { verdict, endpoint, domain, distro, nodes, unseen } = report;
  const named = report.types.slice(0, NAMED).join(", ");
  const more = report.types.length - NAMED;
  return t(`ros.report.${verdict}`, {
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
