/**
 * Types of ROS: which the studio knows, what they are made of, and texts of new ones that a
 * person drops, pastes or writes.
 */

/** @import { ConstantView, FieldView, InterfaceAnswer, InterfaceFaultView, InterfacesAnswer, MessageView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { DroppedFile } from "../lib/files.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { askOrKeepWhy } from "./asking.js";
import { documentId, session } from "./connection.js";
import { isBag, recordingKey } from "./time.js";
import { notify } from "./view.js";
import { RefusedError, send } from "./wire.js";

/** @type {Signal<InterfacesAnswer | null>} */
export const interfaces = signal(null);
export const interfacesRefused = signal("");
/** Full name of the type that is looked at; empty: none. */
export const interfaceName = signal("");
/** @type {Signal<InterfaceAnswer | null>} */
export const interfaceShown = signal(null);
export const interfaceRefused = signal("");
/** A text that a person is about to give; null: nobody is. @type {Signal<{name: string, text: string} | null>} */
export const draft = signal(null);

/** Ask which types there are. */
export async function askInterfaces() {
  const reply = await askOrKeepWhy({ type: "list_interfaces" }, interfacesRefused);
  if (reply?.type === "interfaces") interfaces.value = reply;
}

/** Look at a type. @param {string} name */
export async function showInterface(name) {
  interfaceName.value = name;
  interfaceShown.value = null;
  if (name === "") return;
  const reply = await askOrKeepWhy(
    { type: "get_interface", name, with_text: true },
    interfaceRefused,
  );
  // Another one may be looked at since.
  if (reply?.type !== "interface" || reply.name !== interfaceName.value) return;
  interfaceShown.value = reply;
  // A node may just have told it.
  if (interfaces.value && !interfaces.value.names.includes(name)) await askInterfaces();
}

// A studio that was started anew has forgotten what was added.
effect(() => {
  session.value;
  interfaces.value = null;
});

/** @typedef {{messages: readonly MessageView[] | null, reason: string}} Told null: it is not known, and why */

/** @type {Map<string, Promise<Told>>} */
const types = new Map();
/** Names that nobody knew when they were asked for. @type {Set<string>} */
const unknown = new Set();

/** @param {string} name @returns {Promise<Told>} what a type is made of, or why that is not known */
export function typeOf(name) {
  const known = types.get(name) ?? askType(name);
  types.set(name, known);
  return known;
}

/** @param {string} name @returns {Promise<Told>} */
async function askType(name) {
  try {
    const answer = await send({ type: "get_interface", name });
    unknown.delete(name);
    return { messages: answer.type === "interface" ? answer.messages : null, reason: "" };
  } catch (error) {
    types.delete(name); // somebody may tell it later
    unknown.add(name);
    return { messages: null, reason: error instanceof RefusedError ? error.message : "…" };
  }
}

/** Whose types are told: a bag has its own, which may have other forms. */
const teller = computed(() => `${documentId.value} ${isBag.value && recordingKey.value}`);

/**
 * Say which types may be others than they were: whenever somebody gives texts of types, those that
 * were not known, and those that are no ROS distribution's; with another bag, all.
 *
 * @param {(name: string) => void} tell
 */
export function whenTypesChange(tell) {
  effect(() => {
    teller.value;
    const names = [...types.keys(), ...unknown];
    types.clear();
    unknown.clear();
    for (const name of names) untracked(() => tell(name));
  });
  effect(() => {
    const doubtful = new Set([...unknown, ...(interfaces.value?.own ?? [])]);
    for (const name of [...types.keys(), ...unknown]) {
      if (!doubtful.delete(name)) continue;
      types.delete(name);
      untracked(() => tell(name));
    }
  });
}

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

/** @typedef {"msg" | "srv" | "action"} Kind */

export const KINDS = /** @type {const} */ (["msg", "srv", "action"]);
const FILE =
  /(?:^|\/)(?:(?<folder>[^/]+)\/)?(?:msg|srv|action)\/(?<name>[^/]+)\.(?<kind>msg|srv|action)$/;
const LOOSE = /(?:^|\/)(?<name>[^/]+)\.(?<kind>msg|srv|action)$/;
const ROBOT = /\.(xacro|urdf|sdf|zip|rviz)$/i;
/** A line of a text, and one that stands nowhere else. */
const FIELD =
  /^[A-Za-z]\w*(\/[A-Za-z]\w*){0,2}(<=\d+)?(\[(<=)?\d*\])?\s+[A-Za-z]\w*(\s*=.+|\s+(-?[\d.][\w.+-]*|"[^"]*"|'[^']*'|\[.*\]|true|false))?$/i;
const SURE =
  /^(bool|byte|char|float32|float64|u?int(8|16|32|64)|w?string|[a-z]\w*(\/msg)?\/[A-Z]\w*)(<=\d+)?(\[(<=)?\d*\])?\s+[A-Za-z]\w*/;
const NAME = /^(?<package>[a-z][a-z0-9_]*)\/(?<kind>msg|srv|action)\/(?<type>[A-Z][A-Za-z0-9]*)$/;

/** @param {string} name @returns {{package: string, kind: Kind, type: string} | null} parts of a full name */
export function nameParts(name) {
  const found = NAME.exec(name)?.groups;
  return found ? /** @type {any} */ ({ ...found }) : null;
}

/** @param {readonly string[]} names full ones @returns {Map<string, string[]>} by package, in their order */
export function byPackage(names) {
  /** @type {Map<string, string[]>} */
  const packages = new Map();
  for (const name of names) {
    const [owner = ""] = name.split("/", 1);
    const known = packages.get(owner);
    if (known) known.push(name);
    else packages.set(owner, [name]);
  }
  return packages;
}

/** @param {readonly string[]} names @param {string} words each of them in the name @returns {string[]} those whose own name begins so come first */
export function foundNames(names, words) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const found = names.filter((name) => wanted.every((one) => name.toLowerCase().includes(one)));
  const rank = (/** @type {string} */ name) =>
    (name.split("/").at(-1) ?? "").toLowerCase().startsWith(wanted[0] ?? "") ? 0 : 1;
  return found.sort((a, b) => rank(a) - rank(b));
}

/** @param {FieldView} field @returns {string} its type as it is written in a text */
export function fieldType({ base, shape, count, string_bound: bound }) {
  const short = base.replace("/msg/", "/");
  const single = bound > 0 ? `${short}<=${bound}` : short;
  if (shape === "single") return single;
  if (shape === "array") return `${single}[${count}]`;
  return shape === "bounded" ? `${single}[<=${count}]` : `${single}[]`;
}

/** @param {ConstantView["value"] | FieldView["default"]} value @returns {string} as it is written in a text */
export function valueText(value) {
  if (value === null || value === undefined) return "";
  return Array.isArray(value) ? `[${value.map(valueText).join(", ")}]` : JSON.stringify(value);
}

/** @param {{place: string, line: number}} fault @returns {string} its file without the folders above the package, and the line */
export function faultPlace({ place, line }) {
  const short = place.split(/[/\\]/).slice(-3).join("/");
  return line > 0 ? `${short}:${line}` : short;
}

/** @param {string} text @returns {Kind} what a text defines, by the lines of dashes in it */
export function kindOf(text) {
  const rules = text.split("\n").filter((line) => /^---\s*$/.test(line)).length;
  return KINDS[Math.min(rules, 2)] ?? "msg";
}

/** @param {string} text @returns {boolean} it defines a type: each of its lines does, and one names what no other text does */
export function definesType(text) {
  const lines = text.split("\n").map((line) => line.replace(/#.*/, "").trim());
  const said = lines.filter((line) => line !== "" && line !== "---");
  return said.every((line) => FIELD.test(line)) && said.some((line) => SURE.test(line));
}

/**
 * @template T
 * @param {readonly {path: string, file: T}[]} files that were dropped
 * @param {ReadonlyMap<string, string>} [packages] names of packages by the folder that holds their package.xml
 * @returns {{named: {name: string, file: T}[], loose: {type: string, kind: Kind, file: T}[]} | null} null: there is none, or a robot is among them; `loose`: those that do not tell their package
 */
export function typesAmong(files, packages = new Map()) {
  if (files.some(({ path }) => ROBOT.test(path))) return null;
  /** @type {{name: string, file: T}[]} */
  const named = [];
  /** @type {{type: string, kind: Kind, file: T}[]} */
  const loose = [];
  for (const { path, file } of files) {
    const found = FILE.exec(path)?.groups;
    const other = LOOSE.exec(path)?.groups;
    const above = path.replace(/\/?(msg|srv|action)\/[^/]+$/, "");
    const owner = packages.get(above) ?? found?.folder;
    if (found && owner) named.push({ name: `${owner}/${found.kind}/${found.name}`, file });
    else if (other)
      loose.push({ type: other.name ?? "", kind: /** @type {Kind} */ (other.kind), file });
  }
  return named.length + loose.length > 0 ? { named, loose } : null;
}
