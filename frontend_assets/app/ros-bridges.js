/** Bridges to DDS: what each passes on and what not, and why no node may be seen behind one. */

/** @import { BridgeView } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { mayManage } from "../model/connection.js";

const NAMED = 6;

/** @param {{bridges: readonly BridgeView[], domain: number, onDomain: (domain: number) => void}} props `domain`: the studio's own */
export function Bridges({ bridges, domain, onDomain }) {
  return html`<ul class="ros-bridges">${bridges.map(
    (bridge, at) =>
      html`<${Row} key=${at} bridge=${bridge} domain=${domain} onDomain=${onDomain} />`,
  )}</ul>`;
}

/** @param {{bridge: BridgeView, domain: number, onDomain: (domain: number) => void}} props */
function Row({ bridge, domain, onDomain }) {
  const other = bridge.state === "other_domain" ? bridge.domain : null;
  return html`<li><span>${bridgeLine(bridge)}</span>
    ${bridgeNotes(bridge, domain).map((note) => html`<p key=${note} class="ros-hint">${note}</p>`)}
    ${other !== null && mayManage.value && html`<button type="button" class="button small" onClick=${() => onDomain(other)}>${t("ros.bridge.switch", { domain: other })}</button>`}
  </li>`;
}

/** @param {BridgeView} bridge @returns {string} which it is, and how many nodes are behind it */
export function bridgeLine({ name, version, node_count: count }) {
  const told = version === "" ? t("ros.bridge.no_version") : t("ros.bridge.version", { version });
  return t("ros.bridge", { name, version: told, count });
}

/** @param {BridgeView} bridge @param {number} domain the studio's own @returns {string[]} what is not as one may expect of it */
export function bridgeNotes(bridge, domain) {
  const { state, twin, rules, slowed, localhost_only: isLocal } = bridge;
  const named = slowed.map(({ topics, rate_hz: rate }) => t("ros.bridge.slow", { topics, rate }));
  return [
    state === "other_domain" &&
      t("ros.bridge.other_domain", { domain, other: bridge.domain ?? "" }),
    state === "empty" && t("ros.bridge.empty"),
    twin !== "" && t(`ros.bridge.${state === "twin" ? "twin" : "partly_twin"}`, { twin }),
    bridge.fast_dds_count > 0 && t("ros.bridge.fast_dds", { count: bridge.fast_dds_count }),
    bridge.withheld_count > 0 ? withheldNote(bridge) : rules.length > 0 && rulesNote(bridge),
    slowed.length > 0 && t("ros.bridge.slowed", { topics: named.join(", ") }),
    isLocal && t("ros.bridge.local"),
  ].filter((note) => note !== false);
}

/** @param {BridgeView} bridge */
const rulesNote = ({ allows, rules }) =>
  t(`ros.bridge.${allows ? "allow" : "deny"}`, { rules: rules.join("; ") });

/** @param {BridgeView} bridge @returns {string} what it keeps out, and by which list */
function withheldNote(bridge) {
  const { withheld, withheld_count: all, allows, rules } = bridge;
  const shown = withheld.slice(0, NAMED);
  const more = all - shown.length;
  const names = shown.join(", ") + (more > 0 ? ` ${t("ros.more", { count: more })}` : "");
  if (rules.length === 0) return t("ros.bridge.withheld", { names });
  return t(`ros.bridge.withheld.${allows ? "allow" : "deny"}`, { names, rules: rules.join("; ") });
}

/** @param {{bridges: readonly BridgeView[]}} props why no node may be seen behind these */
export const WhyEmpty = ({ bridges }) =>
  html`<ul class="ros-reasons">${reasonsForEmpty(bridges).map((one) => html`<li key=${one}>${one}</li>`)}</ul>`;

/** @param {readonly BridgeView[]} bridges @returns {string[]} */
export function reasonsForEmpty(bridges) {
  const domains = [...new Set(bridges.map(({ domain }) => domain))].filter((one) => one !== null);
  const isLocal = bridges.some(({ localhost_only: one }) => one);
  return [
    domains.length > 0
      ? t("ros.report.bridge.domain", { domains: domains.sort((a, b) => a - b).join(", ") })
      : t("ros.report.bridge.no_domain"),
    t(isLocal ? "ros.report.bridge.local" : "ros.report.bridge.local_nodes"),
    t("ros.report.bridge.network"),
    t("ros.report.bridge.humble"),
  ];
}
