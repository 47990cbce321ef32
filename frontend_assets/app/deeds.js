/** What a person can do in the ROS 2 system: why it was refused is kept where it was asked. */

/** @import { Command } from "../types/wire.d.ts" */
/** @import { Asked } from "./wire.js" */
/** @import { MessageForm } from "./state/message-forms.js" */

import { ask } from "./actions.js";
import {
  callTimeout,
  goalForm,
  publishForm,
  publishing,
  serviceForm,
} from "./state/message-forms.js";
import { askOrKeepWhy } from "./state/refusals.js";

/** @param {MessageForm} form @param {Asked<Command>} command @returns {Promise<number>} the deed's number; 0: it was refused */
async function begin(form, command) {
  const told = await askOrKeepWhy(command, form.trouble);
  return told?.type === "begun" ? told.deed : 0;
}

/** Call the service that is chosen, with what its form says. */
export function callService() {
  const { name = "", type = "" } = serviceForm.chosen.value ?? {};
  return begin(serviceForm, {
    type: "call_service",
    name,
    service_type: type,
    text: serviceForm.yaml(),
    timeout_s: callTimeout.value,
  });
}

/** @param {number} deed */
export const cancelCall = (deed) => ask({ type: "cancel_call", deed });

/** Send a goal to the action that is chosen. */
export function sendGoal() {
  const { name = "", type = "" } = goalForm.chosen.value ?? {};
  return begin(goalForm, { type: "send_goal", name, action_type: type, text: goalForm.yaml() });
}

/** @param {number} deed */
export const cancelGoal = (deed) => ask({ type: "cancel_goal", deed });

/** @param {{once: boolean}} how publish on the topic that is chosen */
export function publish({ once }) {
  const { name = "", type = "" } = publishForm.chosen.value ?? {};
  const { rate_hz: rate, ...quality } = publishing.value;
  return begin(publishForm, {
    ...{ type: "publish", name, message_type: type, text: publishForm.yaml() },
    ...{ ...quality, rate_hz: once ? 0 : rate },
  });
}

/** @param {number} [deed] without one: all */
export const stopPublishing = (deed = 0) => ask({ type: "stop_publishing", deed });
