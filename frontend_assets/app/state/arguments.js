/** What the arguments of the open robot can be, as its form offers it: asked while somebody looks. */

import { effect, signal } from "vendor/preact.js";
import { connection, role } from "../../model/connection.js";
import { allSites, robot, siteOrder } from "../../model/document.js";
import { send } from "../../model/wire.js";

/** So long nothing came or went before it is asked for again. */
const SETTLE_MS = 250;

/** Choices by the name of the argument. @type {import("vendor/preact.js").Signal<ReadonlyMap<string, readonly string[]>>} */
export const argumentChoices = signal(new Map());

/** Keep `argumentChoices` true while somebody looks. @returns {() => void} the end of looking */
export function followChoices() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  const end = effect(() => {
    const ids = siteOrder.value;
    const asks =
      connection.value === "connected" && role.value === "presenter" && robot.value !== null;
    clearTimeout(later);
    if (asks && ids.length > 0) later = setTimeout(ask, SETTLE_MS);
  });
  return () => {
    clearTimeout(later);
    end();
  };
}

async function ask() {
  if (![...allSites().values()].some(({ kind }) => kind === "arg")) return;
  const answer = await send({ type: "get_arguments", path: "" }).catch(() => null);
  if (answer?.type !== "arguments") return;
  const offered = answer.arguments.filter(({ widget }) => widget.choices.length > 0);
  argumentChoices.value = new Map(offered.map(({ name, widget }) => [name, widget.choices]));
}
