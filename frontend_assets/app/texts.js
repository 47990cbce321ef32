/** The way between an editor here and a file's text at the studio. */

/**
 * @import { ChangeSet } from "vendor/codemirror.js"
 * @import { Fate, Packet, SharedText } from "../lib/shared-text.js"
 */

import { effect, untracked } from "vendor/preact.js";
import { settleFirst } from "../lib/latest.js";
import { createSharedText } from "../lib/shared-text.js";
import { Text } from "../vendor/codemirror.js";
import { connection } from "./state/connection.js";
import { documentId } from "./state/document.js";
import { followText } from "./state/source.js";
import { notify } from "./state/view.js";
import { LostError, RefusedError, send } from "./wire.js";

/** Tells our own edits from those of other tabs and people. */
const ORIGIN = crypto.getRandomValues(new Uint32Array(2)).join("-");

/**
 * @typedef {object} TextLink
 * @property {string} file as the studio names it
 * @property {Text} doc as the studio has it
 * @property {Text} saved as the disk has it
 * @property {string} readOnly why it may not be edited; empty: it may
 * @property {SharedText} shared
 * @property {() => void} close
 */

/**
 * Fetch a text and keep it as the studio has it until it is closed.
 *
 * @param {string} file
 * @param {(changes: ChangeSet) => void} apply what others did
 * @returns {Promise<TextLink>}
 * @throws {RefusedError} when it is no text that may be shown
 * @throws {LostError} when the studio went away
 */
export async function linkText(file, apply) {
  const answer = await fetchText(file);
  const name = answer.file;
  const doc = Text.of(answer.text.split("\n"));
  const saved = answer.saved === null ? doc : Text.of(answer.saved.split("\n"));
  const refetch = async () => {
    const again = await fetchText(name).catch(() => null);
    if (again) shared.resync(again);
  };
  const shared = createSharedText({
    doc,
    version: answer.version,
    post: (packet) => post(name, packet),
    apply,
    refetch,
  });
  const ends = [
    followText(name, ({ version, changes, origin }) =>
      shared.take({ version, changes, own: origin === ORIGIN }),
    ),
    whenBack(refetch),
    settleFirst(shared.settled, shared.busy),
  ];
  const close = () => {
    for (const end of ends) end();
  };
  return { file: name, doc, saved, readOnly: answer.read_only, shared, close };
}

/** @param {string} file */
async function fetchText(file) {
  const answer = await send({ type: "get_text", file });
  if (answer.type !== "text") throw new LostError();
  return answer;
}

/** @param {string} file @param {Packet} packet @returns {Promise<Fate>} */
async function post(file, packet) {
  try {
    await send({
      type: "edit_text",
      file,
      ...packet,
      changes: [...packet.changes],
      origin: ORIGIN,
    });
    return "taken";
  } catch (error) {
    if (!(error instanceof RefusedError)) return "lost";
    if (error.kind === "StaleTextError") return "stale";
    notify(error.message, { bad: true });
    return "refused";
  }
}

/** @param {() => void} run whenever the studio, or the document in it, has come back @returns {() => void} */
function whenBack(run) {
  let first = true;
  return effect(() => {
    const there = connection.value === "connected" && documentId.value !== "";
    if (there && !first) untracked(run);
    first = false;
  });
}
