/** The way to the window of one's own ROS nodes, while nodes may join. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { mayJoin } from "../model/student-nodes.js";
import { dialog } from "../model/view.js";

export function NodesButton() {
  if (!mayJoin.value) return null;
  return html`<button type="button" class="button small" title=${t("nodes.open.hint")} onClick=${showNodes}><${Icon} name="node" size=${14} />${t("nodes.open")}</button>`;
}

export function showNodes() {
  dialog.value = { kind: "nodes" };
}
