/** Which numbers a type of message holds, as paths that a plot takes. */

/** @import { MessageView } from "../types/wire.d.ts" */

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
  if (path) found.push(...worked(known.get(name)).map((work) => path + work));
}

/** @param {MessageView | undefined} message @returns {string[]} what is worked out of a vector, or a quaternion */
function worked(message) {
  if (hasAxes(message, "xyz")) return [".@norm"];
  return hasAxes(message, "xyzw") ? [".@yaw.@deg"] : [];
}

/** @param {MessageView | undefined} message @param {string} axes */
const hasAxes = (message, axes) =>
  message?.fields.length === axes.length &&
  message.fields.every(({ name, base }, n) => name === axes[n] && base.startsWith("float"));
