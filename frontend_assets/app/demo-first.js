/** What a panel shows whose node is not there: the demo that is one, started by a click or by hand. */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon } from "../lib/ui.js";
import { mayEdit } from "./state/connection.js";
import { askOrKeepWhy } from "./state/refusals.js";

/** @param {{icon: string, title: string, demo: string}} props `demo`: as `studio demos` lists it */
export function DemoFirst({ icon, title, demo }) {
  const isBusy = useSignal(false);
  const refused = useSignal("");
  const start = async () => {
    isBusy.value = true;
    await askOrKeepWhy({ type: "start_demo", demo }, refused);
    isBusy.value = false;
  };
  return html`<${EmptyState} icon=${icon} title=${title}>
    ${
      mayEdit.value &&
      html`<p><button type="button" class="button primary" disabled=${isBusy.value} onClick=${start}>
        ${isBusy.value ? html`<span class="spinner"></span>` : html`<${Icon} name="animate" />`}${t("demo_first.start", { demo })}</button></p>`
    }
    ${refused.value && html`<p class="note bad" role="alert">${refused.value}</p>`}
    <p class="note">${t("demo_first.command")} <code>${`studio demos ${demo}`}</code></p>
  <//>`;
}
