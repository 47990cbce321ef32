/** The mark of nodes on DDS, which are met through a bridge. */

import { html } from "vendor/preact.js";
import { t } from "./i18n.js";

/** @param {string} bridge a name, or several @returns {string} how its nodes are marked in few letters */
export const ddsMark = (bridge) => `DDS · ${bridge.replace(/^\//, "")}`;

/** @param {{bridge: string}} props beside a node: the bridge to DDS that it is behind; empty: it is not on DDS */
export function DdsTag({ bridge }) {
  if (bridge === "") return null;
  return html`${" "}<span class="dds-tag" title=${t("ros.behind", { name: bridge })}>${ddsMark(bridge)}</span>`;
}
