/**
 * Forms of messages: what was chosen, its values as fields or as YAML, and why it cannot be sent.
 *
 * In the values of a form a truth value is a boolean, a list of numbers one text between commas,
 * every other single value the text as it was typed; a message is an object of its fields, or a
 * word such as `now`.
 */

/** @import { ConstantView, FieldView, MessageView } from "../types/wire.d.ts" */

import { computed, signal } from "vendor/preact.js";
import { askOrKeepWhy } from "./asking.js";

/** @typedef {boolean | string | FormMessage | FormList} FormValue */
/** @typedef {{[field: string]: FormValue}} FormMessage */
/** @typedef {FormValue[]} FormList */
/** @typedef {ReadonlyMap<string, MessageView>} Types */

/** @type {Record<string, readonly [bigint, bigint]>} */
const RANGES = Object.fromEntries(
  [8, 16, 32, 64].flatMap((bits) => {
    const half = 2n ** BigInt(bits - 1);
    return [
      [`int${bits}`, [-half, half - 1n]],
      [`uint${bits}`, [0n, 2n * half - 1n]],
    ];
  }),
);
RANGES.byte = RANGES.char = [0n, 255n];
const FLOATS = new Set(["float32", "float64"]);
const STRINGS = new Set(["string", "wstring"]);
/** What YAML takes for a truth value or nothing, also as the name of a field. */
const RESERVED = /^(yes|no|on|off|true|false|null)$/i;
const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/;
const WHOLE = /^[+-]?(\d+|0x[\da-fA-F]+)$/;
const NOT_FINITE = /^[+-]?\.?(inf|nan)$/i;
/** Words that stand for a whole message. @type {Record<string, string>} */
export const WORDS = { "builtin_interfaces/msg/Time": "now", "std_msgs/msg/Header": "auto" };

/** @param {FieldView} field */
export const isNested = ({ base }) => base.includes("/");
/** @param {FieldView} field */
export const isNumber = ({ base }) => FLOATS.has(base) || Object.hasOwn(RANGES, base);
/** @param {FieldView} field a list of numbers or truth values, edited as one text */
export const isFlatList = (field) =>
  field.shape !== "single" && (isNumber(field) || field.base === "bool");

/** @param {FieldView} field @returns {string} as it is written in a text of the type */
export function typeText({ base, shape, count, string_bound: bound }) {
  const single = bound > 0 ? `${base}<=${bound}` : base;
  const ends = { single: "", array: `[${count}]`, bounded: `[<=${count}]`, sequence: "[]" };
  return single + ends[shape];
}

/** @param {Types} types @param {string} name @returns {FormMessage} all defaults */
export function blank(types, name) {
  const fields = types.get(name)?.fields ?? [];
  return Object.fromEntries(fields.map((field) => [field.name, blankField(types, field)]));
}

/** @param {Types} types @param {FieldView} field @returns {FormValue} */
function blankField(types, field) {
  if (field.default !== null) return fromPlainField(types, field, field.default);
  if (isFlatList(field)) {
    const count = field.shape === "array" ? field.count : 0;
    return Array.from({ length: count }, () => zero(field)).join(", ");
  }
  if (field.shape === "array") return Array.from({ length: field.count }, () => one(types, field));
  return field.shape === "single" ? one(types, field) : [];
}

/** @param {Types} types @param {FieldView} field @returns {FormValue} one more of a list */
export function one(types, field) {
  if (isNested(field)) return blank(types, field.base);
  return field.base === "bool" ? false : zero(field);
}

/** @param {FieldView} field */
function zero({ base }) {
  if (FLOATS.has(base)) return "0.0";
  if (base === "bool") return "false";
  return STRINGS.has(base) ? "" : "0";
}

/**
 * @param {Types} types
 * @param {string} name
 * @param {unknown} plain what the studio read of a text; what it leaves out is at its default
 * @returns {FormMessage | string}
 */
export function fromPlain(types, name, plain) {
  if (typeof plain === "string") return plain;
  const values = blank(types, name);
  const given = /** @type {Record<string, unknown>} */ (plain ?? {});
  for (const field of types.get(name)?.fields ?? [])
    if (Object.hasOwn(given, field.name))
      values[field.name] = fromPlainField(types, field, given[field.name]);
  return values;
}

/** @param {Types} types @param {FieldView} field @param {unknown} plain @returns {FormValue} */
function fromPlainField(types, field, plain) {
  if (field.shape === "single") return fromPlainSingle(types, field, plain);
  const items = Array.isArray(plain) ? plain : [];
  if (isFlatList(field)) return items.map((item) => typed(field, item)).join(", ");
  return items.map((item) => fromPlainSingle(types, field, item));
}

/** @param {Types} types @param {FieldView} field @param {unknown} plain @returns {FormValue} */
function fromPlainSingle(types, field, plain) {
  if (isNested(field)) return fromPlain(types, field.base, plain);
  return field.base === "bool" ? plain === true : typed(field, plain);
}

/** @param {FieldView} field @param {unknown} plain */
function typed({ base }, plain) {
  const text = String(plain);
  return FLOATS.has(base) && WHOLE.test(text) ? `${text}.0` : text;
}

/**
 * @param {FieldView} field
 * @param {FormValue} value of a field that is neither a message nor a list of such
 * @returns {string} the key of what is wrong with it; empty: nothing
 */
export function troubleOf(field, value) {
  if (typeof value !== "string") return "";
  if (!isFlatList(field)) return singleTrouble(field, value);
  const items = itemsOf(value);
  if (items.some((item) => singleTrouble({ ...field, shape: "single" }, item))) return "form.items";
  if (field.shape === "array" && items.length !== field.count) return "form.count";
  return field.shape === "bounded" && items.length > field.count ? "form.at_most" : "";
}

/** @param {FieldView} field @param {string} text */
function singleTrouble({ base, string_bound: bound }, text) {
  if (base === "bool") return /^(true|false)$/i.test(text.trim()) ? "" : "form.truth";
  if (STRINGS.has(base)) return bound > 0 && [...text].length > bound ? "form.long" : "";
  if (FLOATS.has(base)) return isFloat(text.trim()) ? "" : "form.number";
  return wholeTrouble(base, text.trim());
}

/** @param {string} text */
const isFloat = (text) => NUMBER.test(text) || NOT_FINITE.test(text);

/** @param {string} base @param {string} text */
function wholeTrouble(base, text) {
  if (!WHOLE.test(text)) return "form.whole";
  const [low, high] = RANGES[base] ?? [0n, 0n];
  const sign = text.startsWith("-") ? -1n : 1n;
  const number = sign * BigInt(text.replace(/^[+-]/, ""));
  return number < low || number > high ? "form.range" : "";
}

/** @param {FieldView} field @returns {{low: string, high: string, count: number}} what a sentence about it names */
export function boundsOf({ base, count, string_bound: bound }) {
  const [low, high] = RANGES[base] ?? ["", ""];
  return { low: String(low), high: String(high), count: bound || count };
}

/** @param {string} text */
const itemsOf = (text) => {
  const inner = text.trim().replace(/^\[|\]$/g, "");
  return inner.trim() === "" ? [] : inner.split(",").map((item) => item.trim());
};

/** @param {Types} types @param {string} name @param {FormMessage | string} value @returns {boolean} some field does not take its value */
export function isWrong(types, name, value) {
  if (typeof value === "string") return false;
  return (types.get(name)?.fields ?? []).some((field) => {
    const own = value[field.name] ?? "";
    if (!isNested(field)) return singles(field, own).some((item) => troubleOf(field, item) !== "");
    const items = /** @type {(FormMessage | string)[]} */ (Array.isArray(own) ? own : [own]);
    return items.some((item) => isWrong(types, field.base, item));
  });
}

/** @param {FieldView} field @param {FormValue} value @returns {FormList} */
const singles = (field, value) => (Array.isArray(value) && !isFlatList(field) ? value : [value]);

/**
 * @param {MessageView} message
 * @param {FieldView} field
 * @returns {ConstantView[]} those that are meant for it: named after it, or of its type where none are
 */
export function choicesOf(message, field) {
  if (field.shape !== "single" || isNested(field) || field.base === "bool") return [];
  const fitting = message.constants.filter(({ base }) => base === field.base);
  const start = `${field.name.toUpperCase()}_`;
  const named = fitting.filter(({ name }) => name.startsWith(start));
  const claimed = (/** @type {ConstantView} */ constant) =>
    message.fields.some(({ name }) => constant.name.startsWith(`${name.toUpperCase()}_`));
  return named.length > 0 ? named : fitting.filter((constant) => !claimed(constant));
}

/** @param {Types} types @param {string} name @param {FormMessage | string} value @returns {string} YAML, a line for each field */
export function yamlOf(types, name, value) {
  const lines = messageLines(types, name, value);
  return lines.join("\n");
}

/** @param {Types} types @param {string} name @param {FormMessage | string} value @returns {string[]} */
function messageLines(types, name, value) {
  const fields = types.get(name)?.fields ?? [];
  if (typeof value === "string") return [quoted(value)];
  if (fields.length === 0) return ["{}"];
  return fields.flatMap((field) => fieldLines(types, field, value[field.name] ?? ""));
}

/** @param {Types} types @param {FieldView} field @param {FormValue} value @returns {string[]} */
function fieldLines(types, field, value) {
  const key = `${RESERVED.test(field.name) ? quoted(field.name) : field.name}:`;
  if (!Array.isArray(value)) return under(key, valueLines(types, field, value), "  ");
  if (value.length === 0) return [`${key} []`];
  const items = value.flatMap((item) => under("-", valueLines(types, field, item), "  ", true));
  return [key, ...items];
}

/** @param {string} head @param {string[]} lines @param {string} indent @param {boolean} [beside] the first line stands beside the head */
function under(head, lines, indent, beside = false) {
  const [first = "", ...rest] = lines;
  const isSingle = rest.length === 0 && !/^(\w+|"\w+"):( |$)/.test(first);
  if (isSingle || beside) return [`${head} ${first}`, ...rest.map((line) => indent + line)];
  return [head, ...lines.map((line) => indent + line)];
}

/** @param {Types} types @param {FieldView} field @param {FormValue} value @returns {string[]} of one value, or of a flat list */
function valueLines(types, field, value) {
  if (isNested(field))
    return messageLines(types, field.base, /** @type {FormMessage | string} */ (value));
  const text = String(value);
  if (isFlatList(field)) return [`[${itemsOf(text).map(numberText).join(", ")}]`];
  return [STRINGS.has(field.base) ? quoted(text) : numberText(text.trim())];
}

/** @param {string} text */
const numberText = (text) =>
  NOT_FINITE.test(text) ? text.toLowerCase().replace(/^([+-]?)\.?/, "$1.") : text;

/** @param {string} text @returns {string} in quotes, as JSON and YAML both read it */
const quoted = (text) =>
  JSON.stringify(text).replace(
    /[\u007f-\u009f\u2028\u2029\ufeff]/g,
    (letter) => `\\u${letter.charCodeAt(0).toString(16).padStart(4, "0")}`,
  );

/** @param {Types} types @param {string} name @returns {number} how many boxes a form of it has at first */
export function countOf(types, name) {
  const fields = types.get(name)?.fields ?? [];
  return fields.reduce(
    (sum, field) =>
      sum + (isNested(field) && field.shape === "single" ? countOf(types, field.base) : 1),
    0,
  );
}

/** @typedef {{name: string, type: string}} Chosen a service, an action or a topic, and its type */
/** @typedef {ReturnType<typeof messageForm>} MessageForm */

/** A form of its own for each panel: what is typed stays while the panel is behind another one. */
function messageForm() {
  const chosen = signal(/** @type {Chosen | null} */ (null));
  const types = signal(/** @type {Types} */ (new Map()));
  /** The message that is filled in: of a call its request, of an action its goal. */
  const root = signal("");
  const value = signal(/** @type {FormMessage | string} */ ({}));
  const text = signal("");
  const inYaml = signal(false);
  const trouble = signal("");
  const wrong = computed(() => !inYaml.value && isWrong(types.value, root.value, value.value));
  const isKnown = computed(() => types.value.has(root.value));
  /** The values that the text says, which is then shown as it was written. @type {FormMessage | string | null} */
  let written = null;

  /** @param {Chosen} choice */
  const ofType = ({ type }) => askOrKeepWhy({ type: "get_interface", name: type }, trouble);

  /** @param {Chosen} choice @param {string} [yaml] empty: all defaults */
  async function open(choice, yaml = "") {
    chosen.value = choice;
    [types.value, root.value, value.value, text.value] = [new Map(), "", {}, yaml];
    [trouble.value, inYaml.value, written] = ["", false, null];
    const answer = await ofType(choice);
    if (chosen.peek() !== choice) return;
    if (answer?.type !== "interface") {
      inYaml.value = true;
      return;
    }
    types.value = new Map(answer.messages.map((one) => [one.name, one]));
    root.value = answer.parts[0] ?? "";
    value.value = blank(types.value, root.value);
    if (yaml.trim()) await toFields();
  }

  /** See whether the text can be read; gives what it says, null where it cannot or was changed meanwhile. */
  async function check() {
    const choice = chosen.peek();
    const asked = { name: choice?.type ?? "", text: text.peek() };
    const answer = await askOrKeepWhy({ type: "read_values", ...asked }, trouble);
    const isOld = chosen.peek() !== choice || text.peek() !== asked.text;
    return isOld || answer?.type !== "values_read" ? null : answer.values;
  }

  /** Have the fields say what the text says; it stays a text where they cannot. */
  async function toFields() {
    const values = await check();
    inYaml.value = values === null;
    if (values === null) return;
    value.value = fromPlain(types.value, root.value, JSON.parse(values));
    written = value.value;
  }

  function toYaml() {
    if (value.value !== written) text.value = yaml();
    inYaml.value = true;
  }

  const yaml = () => (inYaml.value ? text.value : yamlOf(types.value, root.value, value.value));

  const close = () => {
    chosen.value = null;
  };
  return {
    ...{ chosen, types, root, value, text, inYaml, trouble, wrong, isKnown },
    ...{ open, close, check, toFields, toYaml, yaml },
  };
}

export const serviceForm = messageForm();
export const goalForm = messageForm();
export const publishForm = messageForm();
/** Seconds that a service has for its answer. */
export const callTimeout = signal(10);
/** How a message is published: so often a second, and with which quality of service. */
export const publishing = signal({ rate_hz: 1, reliable: true, latched: false, depth: 10 });
