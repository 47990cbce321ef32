/** Which numbers a type of message holds, as paths that a plot takes. */

/** @import { FieldView, MessageView } from "../types/wire.d.ts" */

const DEPTH_MAX = 12;
const PATHS_MAX = 400;
const TEXTS = new Set(["string", "wstring"]);

/** @param {readonly MessageView[]} messages @param {string} name @returns {string[]} of a list its first */
export function numberPaths(messages, name) {
  const known = new Map(messages.map((one) => [one.name, one]));
  /** @type {string[]} */
  const found = [];
  walk(known, name, "", 0, found);
  return found.slice(0, PATHS_MAX);
}

/** @param {Map<string, MessageView>} known @param {string} name @param {string} path @param {number} depth @param {string[]} found */
function walk(known, name, path, depth, found) {
  if (depth > DEPTH_MAX || found.length > PATHS_MAX) return;
  for (const field of known.get(name)?.fields ?? []) {
    const at = `${path}.${field.name}${field.shape === "single" ? "" : "[0]"}`;
    if (known.has(field.base)) walk(known, field.base, at, depth + 1, found);
    else if (!TEXTS.has(field.base)) found.push(at);
  }
  if (path && isVector(known.get(name))) found.push(`${path}.@norm`);
}

/** @param {MessageView | undefined} message */
const isVector = (message) => message?.fields.length === 3 && message.fields.every(isAxis);

/** @param {FieldView} field @param {number} n */
const isAxis = ({ name, base }, n) => name === "xyz"[n] && base.startsWith("float");
