/** Calling a service for a panel that knows it, and waiting for what becomes of the call. */

/** @import { CallView } from "../types/wire.d.ts" */

import { effect, signal } from "vendor/preact.js";
import { plainOf } from "../lib/deeds.js";
import { t } from "../lib/i18n.js";
import { followDeeds } from "./state/deed-following.js";
import { calls } from "./state/deeds.js";
import { askOrKeepWhy } from "./state/refusals.js";

const TIMEOUT_S = 5;

/**
 * @param {{name: string, type: string}} service
 * @param {object} values of the request
 * @returns {Promise<{reply: any, trouble: string}>} `trouble`: why there is no reply, in a sentence; else empty
 */
export async function called({ name, type }, values) {
  const end = followDeeds("calls");
  try {
    const call = await outcome(name, type, JSON.stringify(values));
    if (typeof call === "string") return { reply: null, trouble: call };
    if (call.state === "cancelled") return { reply: null, trouble: t("calling.cancelled") };
    return { reply: plainOf(call.reply), trouble: call.trouble };
  } finally {
    end();
  }
}

/** @param {string} name @param {string} type @param {string} text @returns {Promise<CallView | string>} the call at its end, or why it was not begun */
async function outcome(name, type, text) {
  const refused = signal("");
  const told = await askOrKeepWhy(
    { type: "call_service", name, service_type: type, text, timeout_s: TIMEOUT_S },
    refused,
  );
  if (told?.type !== "begun") return refused.value || t("calling.lost");
  return ended(told.deed);
}

/** @param {number} deed @returns {Promise<CallView>} */
function ended(deed) {
  return new Promise((resolve) => {
    /** @type {() => void} */
    let stop = () => {};
    stop = effect(() => {
      const call = calls.value.find((one) => one.deed === deed);
      if (!call || call.state === "calling") return;
      resolve(call);
      queueMicrotask(() => stop());
    });
  });
}
