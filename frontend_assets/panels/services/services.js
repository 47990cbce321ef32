/** The services that somebody serves: each called by a form or YAML, with the reply, its time and those before. */

/** @import { CallView } from "../../types/wire.d.ts" */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { parseNumber } from "../../lib/numbers.js";
import { TextBox } from "../../lib/slider.js";
import { Icon } from "../../lib/ui.js";
import { mayAct } from "../../model/connection.js";
import { callTimeout, serviceForm } from "../../model/message-forms.js";
import {
  askServices,
  callService,
  calls,
  cancelCall,
  followOperations,
  followServices,
  offersRefused,
  plainOf,
  services,
  tookText,
} from "../../model/operations.js";
import {
  Offers,
  OperationForm,
  OperationPanel,
  OperationState,
  openLine,
  ValueTree,
} from "../operation-panel.js";

const LONGEST_S = 3600;
const FOLLOW = [followServices, () => followOperations("calls")];

/** @param {CallView} call its request, into the form */
const again = ({ name, service_type: type, text }) => void serviceForm.open({ name, type }, text);

export function ServicesPanel() {
  return html`<${OperationPanel} id="services" icon="services" kind="service" follow=${FOLLOW} onLine=${openLine(serviceForm)}>
    ${(
      /** @type {(text: string) => boolean} */ paste,
    ) => html`<div class=${`operations-parts ${serviceForm.chosen.value ? "chosen" : ""}`}>
      <${Offers} id="services" icon="services" offers=${services.value} refused=${offersRefused.value} again=${askServices} form=${serviceForm} paste=${paste} noisy />
      ${serviceForm.chosen.value && html`<${Chosen} />`}
    </div>`}
  <//>`;
}

/** The service that is chosen, and the calls of it. */
function Chosen() {
  const name = serviceForm.chosen.value?.name;
  const own = calls.value.filter((one) => one.name === name).reverse();
  /** Which of the calls is shown; 0: the newest. */
  const shown = useSignal(0);
  const call = own.find(({ operation }) => operation === shown.value) ?? own[0];
  const run = async () => {
    shown.value = await callService();
  };
  const running = call?.state === "calling" ? call : null;
  return html`<div class="operations-chosen scroll">
    <${OperationForm} form=${serviceForm} onSubmit=${run} actions=${html`
      <button type="submit" class="button primary" disabled=${!mayAct.value || serviceForm.wrong.value}><${Icon} name="send" />${t("services.call")}</button>
      ${running && html`<button type="button" class="button" disabled=${!mayAct.value} onClick=${() => cancelCall(running.operation)}>${t("cancel")}</button>`}
      <label class="operation-timeout">${t("services.timeout")}<${TextBox} label=${t("services.timeout.seconds")} class="number narrow" text=${String(callTimeout.value)}
        disabled=${!mayAct.value} number=${callTimeout.value} step=${1} onWrite=${writeTimeout} />s</label>`} />
    ${call && html`<${Reply} call=${call} />`}
    ${
      own.length > 1 &&
      html`<${Before} calls=${own} shown=${call?.operation ?? 0} onShow=${(
        /** @type {number} */ operation,
      ) => {
        shown.value = operation;
      }} />`
    }
  </div>`;
}

/** @param {string} typed */
function writeTimeout(typed) {
  const seconds = parseNumber(typed);
  if (seconds && seconds > 0) callTimeout.value = Math.min(seconds, LONGEST_S);
}

/** @param {CallView} call */
const stateWords = ({ state, took_s }) => t(`services.${state}`, { time: tookText(took_s) });

/** @param {{call: CallView}} props */
function Reply({ call }) {
  const bad = call.state === "failed";
  const value = plainOf(call.reply);
  return html`<section class="operation-reply" aria-label=${t("services.reply")}>
    <${OperationState} state=${call.state} busy=${call.state === "calling"} bad=${bad} words=${stateWords(call)} />
    ${call.trouble && html`<p class="note bad" role="alert">${call.trouble}</p>`}
    ${value !== undefined && html`<${ValueTree} value=${value} label=${t("services.reply")} />`}
  </section>`;
}

/** @param {{calls: readonly CallView[], shown: number, onShow: (operation: number) => void}} props of this service, the newest first */
function Before({ calls: own, shown, onShow }) {
  return html`<details class="operation-history"><summary>${t("operations.history", { count: own.length })}</summary>
    <ul>${own.map(
      (
        call,
      ) => html`<li key=${call.operation}><button type="button" class="offer" aria-pressed=${call.operation === shown} onClick=${() => onShow(call.operation)}>
      <span class="offer-name">${call.text.trim().replace(/\s+/g, " ") || "{}"}</span>
      <${OperationState} state=${call.state} busy=${call.state === "calling"} bad=${call.state === "failed"} words=${stateWords(call)} /></button>
      <button type="button" class="text-button" onClick=${() => again(call)}>${t("operations.again")}</button></li>`,
    )}</ul>
  </details>`;
}
