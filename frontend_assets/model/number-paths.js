/** Which numbers a type of message holds, for who draws one of them. */

/** @import { MessageView } from "../types/wire.d.ts" */

import { useEffect, useSignal } from "vendor/preact.js";
import { typeOf } from "./interfaces.js";

/** @param {string} type empty: none @returns {readonly string[]} its numbers, once the type is known; those of a header last */
export function useNumberPaths(type) {
  const paths = useSignal(/** @type {readonly string[]} */ ([]));
  useEffect(() => {
    let closed = false;
    paths.value = [];
    if (type)
      typeOf(type).then(({ messages }) => {
        if (closed || !messages) return;
        const found = numberPaths(messages, type);
        const isOfHeader = (/** @type {string} */ path) => path.startsWith(".header.");
        paths.value = [
          ...found.filter((one) => !isOfHeader(one)),
          ...found.filter((one) => isOfHeader(one)),
        ];
      });
    return () => {
      closed = true;
    };
  }, [type]);
  return paths.value;
}

const DEPTH_MAX = 12;
const PATHS_MAX = 400;
const TEXTS = new Set(["string", "wstring"]);

/**
 * Which numbers a type of message holds, as paths that a plot takes.
 *
 * @param {readonly MessageView[]} messages
 * @param {string} name
 * @returns {string[]} of a list its first
 */
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
