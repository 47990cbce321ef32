/** The way between an editor here and a file's text at the studio. */

/** @import { ChangeSet } from "vendor/codemirror.js" */
/** @import { EditText } from "../types/wire.d.ts" */
/** @import { Asked } from "../model/wire.js" */
/** @import { Fate } from "../lib/shared-text.js" */

import { effect, untracked } from "vendor/preact.js";
import { settleFirst } from "../lib/latest.js";
import { SharedText } from "../lib/shared-text.js";
import { connection, documentId } from "../model/connection.js";
import { followText } from "../model/source.js";
import { notify } from "../model/view.js";
import { LostError, RefusedError, send } from "../model/wire.js";
import { Text } from "../vendor/codemirror.js";

const OWN = crypto.getRandomValues(new Uint32Array(2)).join("-");
let links = 0;

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
  links += 1;
  // Tells what was typed here from the edits of other tabs and people.
  const origin = `${OWN}-${links}`;
  const doc = Text.of(answer.text.split("\n"));
  const saved = answer.saved === null ? doc : Text.of(answer.saved.split("\n"));
  const refetch = async () => {
    const again = await fetchText(name).catch(() => null);
    if (again) shared.resync(again);
  };
  const shared = new SharedText({
    doc,
    version: answer.version,
    post: (packet) => post({ type: "edit_text", file: name, origin, ...packet }),
    apply,
    refetch,
  });
  const ends = [
    followText(name, (news) => shared.take({ ...news, own: news.origin === origin })),
    whenBack(refetch),
    settleFirst(
      () => shared.settled(),
      () => shared.busy,
    ),
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

/** @param {Asked<EditText>} command @returns {Promise<Fate>} */
async function post(command) {
  try {
    await send(command);
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
