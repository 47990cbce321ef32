/** What a person can do in the ROS 2 system: why it was refused is kept where it was asked. */

/** @import { Command } from "../types/wire.d.ts" */
/** @import { Asked } from "./wire.js" */
/** @import { MessageForm } from "./state/message-forms.js" */

import { ask } from "./actions.js";
import { callTimeout, serviceForm } from "./state/message-forms.js";
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
