/** Texts of types that a person gives: dropped files, a package's folder, or pasted. */

/** @import { DroppedFile } from "../lib/dropped.js" */
/** @import { InterfaceFaultView } from "../types/wire.d.ts" */

import { t } from "../lib/i18n.js";
import { definesType, faultPlace, kindOf, typesAmong } from "../lib/interface-texts.js";
import { commandById } from "./commands.js";
import { askInterfaces, draft, showInterface } from "./state/interfaces.js";
import { notify } from "./state/view.js";
import { RefusedError, send } from "./wire.js";

/** The studio reads no longer command. */
const SENT_MAX = 600_000;

/**
 * @param {Record<string, string>} texts by full names
 * @returns {Promise<string>} why they were not taken; empty: they were
 */
export async function addTypes(texts) {
  try {
    const answer = await send({ type: "add_interfaces", texts });
    if (answer.type !== "interfaces_added") return "…";
    await askInterfaces();
    const [first] = answer.types;
    if (first) await showInterface(first.name);
    const waiting = answer.types.find(({ trouble }) => trouble !== "");
    if (answer.faults.length > 0) notify(faultsNotice(answer.faults), { bad: true });
    else if (waiting) notify(waiting.trouble, { bad: true });
    else notify(t("interfaces.added", { count: answer.types.length, name: first?.name ?? "" }));
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : "…";
  }
}

/** @param {readonly InterfaceFaultView[]} faults @returns {string} the first, and how many there are besides: the panel lists them */
function faultsNotice(faults) {
  const [first] = faults;
  const said = first ? `${faultPlace(first)}: ${first.reason}.` : "";
  return faults.length === 1
    ? said
    : t("interfaces.faults.more", { said, count: faults.length - 1 });
}

/** @param {string} text that was pasted @returns {boolean} it defines a type, whose name is to be given */
export function takePastedType(text) {
  if (!definesType(text)) return false;
  commandById("panel.interfaces")?.run();
  draft.value = { name: `my_interfaces/${kindOf(text)}/`, text };
  return true;
}

/** @param {readonly DroppedFile[]} files @returns {Promise<boolean>} they are types, not a robot */
export async function takeDroppedTypes(files) {
  const found = typesAmong(files, await packagesOf(files));
  if (!found) return false;
  commandById("panel.interfaces")?.run();
  const [loose] = found.loose;
  if (loose && found.named.length === 0) {
    draft.value = {
      name: `my_interfaces/${loose.kind}/${loose.type}`,
      text: await loose.file.text(),
    };
    return true;
  }
  for (const texts of await inParts(found.named)) {
    const refused = await addTypes(texts);
    if (refused) notify(refused, { bad: true });
  }
  return true;
}

/** @param {readonly DroppedFile[]} files @returns {Promise<Map<string, string>>} names of packages by their folders */
async function packagesOf(files) {
  const manifests = files.filter(({ path }) => /(^|\/)package\.xml$/.test(path));
  const named = await Promise.all(
    manifests.map(async ({ path, file }) => {
      const text = file.size > SENT_MAX ? "" : await file.text();
      const [, name = ""] = /<name>\s*([a-z][a-z0-9_]*)\s*<\/name>/.exec(text) ?? [];
      return /** @type {const} */ ([path.replace(/\/?package\.xml$/, ""), name]);
    }),
  );
  return new Map(named.filter(([, name]) => name !== ""));
}

/** @param {readonly {name: string, file: File}[]} named @returns {Promise<Record<string, string>[]>} each small enough to be sent at once */
async function inParts(named) {
  /** @type {Record<string, string>[]} */
  const parts = [{}];
  let size = 0;
  for (const { name, file } of named) {
    if (size + file.size > SENT_MAX && size > 0) {
      parts.push({});
      size = 0;
    }
    size += file.size;
    const last = parts.at(-1);
    // A text that is too long for any type is refused by the studio, which says so.
    if (last) last[name] = await file.slice(0, SENT_MAX).text();
  }
  return parts;
}
