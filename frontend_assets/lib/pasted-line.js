/** A command line of `ros2` that somebody pastes: what it calls, sends, publishes or sets. */

/**
 * @typedef {object} PastedLine
 * @property {"service" | "action" | "topic" | "param"} kind
 * @property {string} name of the service, action or topic; of the node
 * @property {string} type in full; of a parameter its name
 * @property {string} text YAML of the values
 * @property {number} rate_hz 0: once
 * @property {{reliability?: string, durability?: string, depth?: number}} qos
 */

/** @type {Record<string, {verb: string, folder: string}>} */
const KINDS = {
  service: { verb: "call", folder: "srv" },
  action: { verb: "send_goal", folder: "action" },
  topic: { verb: "pub", folder: "msg" },
  param: { verb: "set", folder: "" },
};
/** Options that take a value of their own. */
const VALUED =
  /^(-r|--rate|-t|--times|-p|--print|-w|--wait-matching-subscriptions|-n|--node-name|--keep-alive|--timeout|--max-wait-time-secs|--qos-\w[\w-]*|--spin-time|--connect|--domain|--router|--distro)$/;
const FLAG = /^-(-[a-z]|[a-z1]$)/;
const RATE_HZ = 1;

/** @param {string} text @returns {PastedLine | null} null: it is no such line */
export function readLine(text) {
  const words = shellWords(text.trim().replace(/^[$>]\s+/, ""));
  if (!words || !/^(ros2|studio)$/.test(words[0] ?? "")) return null;
  const kind = words[1] ?? "";
  const known = Object.hasOwn(KINDS, kind) ? KINDS[kind] : undefined;
  if (!known || words[2] !== known.verb) return null;
  const { plain, options } = split(words.slice(3));
  const [name, type, ...values] = plain;
  if (!name || !type) return null;
  return {
    kind: /** @type {PastedLine["kind"]} */ (kind),
    name,
    type: fullType(type, known.folder),
    text: values.join(" "),
    rate_hz: rateOf(options),
    qos: qosOf(options),
  };
}

/** @param {string[]} words */
function split(words) {
  const plain = [];
  /** @type {Map<string, string>} */
  const options = new Map();
  const left = [...words];
  for (let word = left.shift(); word !== undefined; word = left.shift()) {
    const [name = "", value] = word.startsWith("--") ? word.split(/=(.*)/s) : [word];
    if (VALUED.test(name)) options.set(name, value ?? left.shift() ?? "");
    else if (FLAG.test(word)) options.set(word, "");
    else plain.push(word);
  }
  return { plain, options };
}

/** @param {Map<string, string>} options */
function rateOf(options) {
  if (options.has("-1") || options.has("--once")) return 0;
  const rate = Number(options.get("-r") ?? options.get("--rate") ?? RATE_HZ);
  return rate > 0 ? rate : RATE_HZ;
}

/** @param {Map<string, string>} options @returns {PastedLine["qos"]} */
function qosOf(options) {
  const [reliability, durability] = [
    options.get("--qos-reliability"),
    options.get("--qos-durability"),
  ];
  const depth = Number(options.get("--qos-depth"));
  return {
    ...(reliability && { reliability }),
    ...(durability && { durability }),
    ...(depth > 0 && { depth }),
  };
}

/** @param {string} type @param {string} folder */
function fullType(type, folder) {
  const parts = type.split(/[./]/);
  if (parts.length === 2 && folder) parts.splice(1, 0, folder);
  return folder ? parts.join("/") : type;
}

const WORD = /(?:\\[\s\S]|'[^']*'|"(?:[^"\\]|\\[\s\S])*"|[^\s\\'"])+/g;
const PART = /\\([\s\S])|'([^']*)'|"((?:[^"\\]|\\[\s\S])*)"/g;

/** @param {string} text @returns {string[] | null} its words as a shell reads them; null: quotes do not close */
export function shellWords(text) {
  const line = text.replace(/\\\r?\n/g, " ");
  if (line.replace(WORD, "").trim() !== "") return null;
  return (line.match(WORD) ?? []).map((word) =>
    word.replace(
      PART,
      (_, escaped, single, double) =>
        escaped ?? single ?? double?.replace(/\\(["\\$`])/g, "$1") ?? "",
    ),
  );
}
