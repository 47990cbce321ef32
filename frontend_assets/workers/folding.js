/** Messages made small for a look at them: of long lists and texts the beginning, whatever they hold. */

import { isList } from "./message-paths.js";

const ITEMS = 24;
const LETTERS = 2000;
const DEPTH_MAX = 70;
/** Of one message: a thousand markers are a thousand open lists. */
const VALUES_MAX = 6000;
const WHOLE_LETTERS = 1_000_000;

/** @typedef {{"@list": number, items: any[]} | {"@text": number, begin: string}} Cut what is longer than it is shown */

/**
 * @param {any} message as it was read
 * @param {ReadonlyMap<string, number>} wished by path: of so many items more is shown
 * @returns {any} plain values, and a Cut where something is left out
 */
export function folded(message, wished) {
  const room = { left: VALUES_MAX };
  return foldedAt(message, "", wished, room, 0);
}

/** @param {any} value @param {string} path @param {ReadonlyMap<string, number>} wished @param {{left: number}} room @param {number} depth @returns {any} */
function foldedAt(value, path, wished, room, depth) {
  room.left -= 1;
  if (typeof value === "string" && value.length > LETTERS)
    return { "@text": value.length, begin: value.slice(0, LETTERS) };
  if (isList(value)) return foldedList(value, path, wished, room, depth);
  if (typeof value !== "object" || value === null || depth > DEPTH_MAX) return value;
  /** @type {Record<string, any>} */
  const found = {};
  for (const [name, one] of Object.entries(value))
    found[name] = foldedAt(one, `${path}.${name}`, wished, room, depth + 1);
  return found;
}

/** @param {ArrayLike<any>} list @param {string} path @param {ReadonlyMap<string, number>} wished @param {{left: number}} room @param {number} depth */
function foldedList(list, path, wished, room, depth) {
  const most = Math.min(list.length, wished.get(path) ?? ITEMS, Math.max(0, room.left));
  const items = [];
  for (let n = 0; n < most && room.left > 0; n += 1)
    items.push(foldedAt(list[n], `${path}[${n}]`, wished, room, depth + 1));
  return items.length === list.length ? items : { "@list": list.length, items };
}

/** @param {any} value @returns {string} all of it, as JSON; cut where it is very long */
export function wholeText(value) {
  if (typeof value === "string") return value.slice(0, WHOLE_LETTERS);
  const text = JSON.stringify(value, plain, 1) ?? "";
  return text.slice(0, WHOLE_LETTERS);
}

/** @param {string} _key @param {any} value what JSON has no form for */
function plain(_key, value) {
  if (typeof value === "bigint")
    return Number.isSafeInteger(Number(value)) ? Number(value) : `${value}`;
  if (typeof value === "number" && !Number.isFinite(value)) return `${value}`;
  return ArrayBuffer.isView(value) ? Array.from(/** @type {any} */ (value)) : value;
}

/** @param {Uint8Array} bytes @returns {string} so many as are worth a look, in rows of 16 */
export function hexRows(bytes) {
  const rows = [];
  for (let at = 0; at < Math.min(bytes.length, 1024); at += 16) {
    const row = bytes.subarray(at, at + 16);
    const hex = Array.from(row, (one) => one.toString(16).padStart(2, "0")).join(" ");
    const text = Array.from(row, letterOf).join("");
    rows.push(`${at.toString(16).padStart(4, "0")}  ${hex.padEnd(47)}  ${text}`);
  }
  return rows.join("\n");
}

/** @param {number} code */
const letterOf = (code) => (code >= 32 && code < 127 ? String.fromCharCode(code) : "·");
