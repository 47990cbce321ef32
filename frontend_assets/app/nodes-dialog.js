/** The window of one's own ROS nodes: the line by which they join, and what is in one's own domain. */

/** @import { NodeAccess } from "../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { Dialog, EmptyState, Icon, ProgressBar } from "../lib/ui.js";
import { isAtRelay } from "../model/relays.js";
import {
  accessRefused,
  askForAccess,
  mayJoin,
  myGraph,
  nodeAccess,
  studentNodes,
} from "../model/student-nodes.js";
import { notify } from "../model/view.js";
import { OwnGraph } from "./own-graph.js";

/** What is typed where nodes cannot do TLS. */
const OWN_ROUTER = "studio router --join";

/** @param {{onClose: () => void}} props */
export function NodesDialog({ onClose }) {
  const endpoint = studentNodes.value?.endpoint ?? "";
  useEffect(() => {
    nodeAccess.value = null;
    myGraph.value = null;
    if (mayJoin.peek()) askForAccess();
  }, [endpoint]);
  return html`<${Dialog} title=${t("nodes.title")} closeLabel=${t("close")} class="nodes-dialog" onClose=${onClose}><${Content} /><//>`;
}

function Content() {
  if (!mayJoin.value)
    return html`<${EmptyState} icon="node" title=${t("nodes.closed")}><p>${t("nodes.closed.hint")}</p><//>`;
  if (accessRefused.value) return html`<p class="note bad" role="alert">${accessRefused.value}</p>`;
  if (!nodeAccess.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<${Access} access=${nodeAccess.value} /><${OwnGraph} />`;
}

/** @param {{access: NodeAccess}} props */
function Access({ access }) {
  const shell = useSignal(isWindows() ? "powershell" : "shell");
  const line = shell.value === "powershell" ? access.powershell : access.shell;
  const copy = async () => {
    if (await copyText(line)) notify(t("nodes.copied"));
  };
  return html`<p class="dialog-text">${t("nodes.text", { domain: access.domain })}</p>
    ${isAtRelay.value && html`<p class="dialog-text">${t("nodes.at_relay", { endpoint: access.endpoint })}</p>`}
    <div class="nodes-line"><label class="field"><span>${t("nodes.shell")}</span>
        <select class="box" value=${shell.value} onChange=${(/** @type {any} */ event) => {
          shell.value = event.currentTarget.value;
        }}>
          ${["shell", "powershell"].map((one) => html`<option key=${one} value=${one} selected=${one === shell.value}>${t(`nodes.shell.${one}`)}</option>`)}
        </select></label>
      <label class="field grow"><span>${t("nodes.line")}</span>
        <input type="text" class="box wide" readonly value=${line} onFocus=${(/** @type {any} */ event) => event.currentTarget.select()} /></label>
      <button type="button" class="button primary" data-first onClick=${copy}><${Icon} name="copy" size=${14} />${t("nodes.copy")}</button></div>
    <p class="dialog-text muted">${t("nodes.router", { domain: access.domain })} <code>${OWN_ROUTER}</code></p>`;
}

/** @returns {boolean} */
const isWindows = () => navigator.userAgent.includes("Windows");
