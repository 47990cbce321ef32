/** Asking the studio for what a panel shows, and keeping why it told nothing. */

/** @import { Command } from "../../types/wire.d.ts" */
/** @import { Answer, Asked } from "../wire.js" */
/** @import { Signal } from "vendor/preact.js" */

import { RefusedError, send } from "../wire.js";

/**
 * Ask; a refusal is kept until the next answer. When the lane is lost, nothing is said: whoever looks
 * asks again with the next one.
 *
 * @param {Asked<Command>} command
 * @param {Signal<string>} refused is given the studio's sentence; empty when it answered
 * @returns {Promise<Answer | null>}
 */
export async function askOrKeepWhy(command, refused) {
  try {
    const answer = await send(command);
    refused.value = "";
    return answer;
  } catch (error) {
    if (error instanceof RefusedError) refused.value = error.message;
    return null;
  }
}
