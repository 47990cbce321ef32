/** What an editor asks the studio about a text; an answer that does not come is no answer. */

/** @import { Command, Completions, Meaning, References } from "../types/wire.d.ts" */
/** @import { Answer, Asked } from "../model/wire.js" */
/** @import { TextLink } from "./texts.js" */

import { send } from "../model/wire.js";

/** @param {Asked<Command>} command @returns {Promise<Answer | null>} */
const asked = (command) => send(command).catch(() => null);

/** @param {TextLink} link @param {number} offset @returns {Promise<Meaning | null>} what stands there */
export async function lookUp(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "look_up", file: link.file, offset });
  return answer?.type === "meaning" ? answer.meaning : null;
}

/** @param {TextLink} link @param {number} offset @returns {Promise<References | null>} who names it */
export async function referencesTo(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "get_references", file: link.file, offset });
  return answer?.type === "references" ? answer.references : null;
}

/** @param {TextLink} link @param {number} offset @returns {Promise<Completions | null>} what may be typed */
export async function complete(link, offset) {
  await link.shared.settled();
  const answer = await asked({ type: "complete", file: link.file, offset });
  return answer?.type === "completions" ? answer.completions : null;
}
