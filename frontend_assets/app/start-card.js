/** What the page shows while no robot is open: everything that one can begin with. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { connection, documentId, role } from "../model/connection.js";
import { dialog } from "../model/view.js";
import { FileButtons } from "./open-dialog.js";
import { ExampleCards, RecentList } from "./start-lists.js";

export function StartCard() {
  if (documentId.value !== "" || connection.value !== "connected") return null;
  if (role.value !== "presenter") {
    return html`<div class="start-layer"><section class="start-card" aria-label=${t("start.title")}>
      <p class="open-text">${t("start.viewer")}</p></section></div>`;
  }
  return html`<div class="start-layer"><section class="start-card" aria-labelledby="start-title">
    <h1 id="start-title">${t("start.title")}</h1>
    <div class="start-buttons">
      <${StartButton} tab="browse" icon="open" label="command.open" primary=${true} />
      <${StartButton} tab="new" icon="filePlus" label="command.new_robot" primary=${false} />
      <${StartButton} tab="paste" icon="clipboard" label="command.new_pasted" primary=${false} />
      <${ConnectButton} />
    </div>
    <${FileButtons} />
    <h2>${t("open.tab.recent")}</h2>
    <${RecentList} limit=${5} />
    <h2>${t("open.tab.examples")}</h2>
    <${ExampleCards} />
  </section></div>`;
}

/** @param {{tab: import("../model/view.js").OpenTab, icon: string, label: string, primary: boolean}} props */
function StartButton({ tab, icon, label, primary }) {
  const show = () => {
    dialog.value = { kind: "open", tab };
  };
  return html`<button type="button" class=${`button ${primary ? "primary" : ""}`} onClick=${show}>
    <${Icon} name=${icon} />${t(label)}…</button>`;
}

/** A robot that runs may be met before any is open. */
function ConnectButton() {
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class="button" onClick=${show}><${Icon} name="link" />${t("start.connect")}…</button>`;
}
