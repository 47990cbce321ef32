/** Command lines of `ros2 bag`, read: what is recorded and how, and which bag is played or told of. */

import { baseName } from "./paths.js";
import { bareCommand, shellWords } from "./ros2-lines.js";

/**
 * @typedef {object} RecordLine what `ros2 bag record` is told
 * @property {boolean} all
 * @property {string[]} topics
 * @property {string} regex
 * @property {string} exclude a regular expression
 * @property {string} name of the bag's folder; empty: by date and time
 * @property {"mcap" | "sqlite3"} storage
 * @property {"none" | "zstd" | "lz4"} compression
 * @property {number} maxBytes of a file; 0: never another one
 * @property {number} maxSeconds
 */

/** @typedef {{verb: "record", form: RecordLine} | {verb: "play" | "info", path: string}} BagLine */

const TOPIC = /^\/?[A-Za-z_][\w/]*$/;
/** Options with a value, by each of their names. @type {Record<string, string>} */
const VALUED = {
  "-e": "regex",
  "--regex": "regex",
  "-x": "exclude",
  "--exclude": "exclude",
  "--exclude-regex": "exclude",
  "-o": "output",
  "--output": "output",
  "-s": "storage",
  "--storage": "storage",
  "-b": "bytes",
  "--max-bag-size": "bytes",
  "-d": "seconds",
  "--max-bag-duration": "seconds",
  "--compression-format": "compression",
  "--compression-mode": "compression_mode",
  "--max-cache-size": "",
  "--node-name": "",
  "-p": "",
  "--polling-interval": "",
  "--qos-profile-overrides-path": "",
  "--storage-config-file": "",
  "--storage-preset-profile": "",
};

/** @param {string} text @returns {BagLine | null} null: it is no such line */
export function readBagLine(text) {
  const [ros2, bag, verb, ...words] = shellWords(bareCommand(text)) ?? [];
  if (ros2 !== "ros2" || bag !== "bag") return null;
  if (verb === "record") return { verb, form: recordLine(words) };
  if (verb !== "play" && verb !== "info") return null;
  const [path = ""] = words.filter((word) => !/^[-<]/.test(word));
  return { verb, path };
}

/** @param {readonly string[]} words @returns {RecordLine} */
function recordLine(words) {
  const { plain, given, flags } = parted(words);
  const output = given.get("output") ?? "";
  const format = given.get("compression") ?? "";
  return {
    all: flags.has("-a") || flags.has("--all") || flags.has("--all-topics"),
    topics: plain.filter((word) => TOPIC.test(word)).map(rooted),
    regex: given.get("regex") ?? "",
    exclude: given.get("exclude") ?? "",
    name: output.startsWith("<") ? "" : baseName(output.replace(/\/+$/, "")),
    storage: given.get("storage") === "sqlite3" ? "sqlite3" : "mcap",
    compression: format === "zstd" || format === "lz4" ? format : "none",
    maxBytes: count(given.get("bytes")),
    maxSeconds: count(given.get("seconds")),
  };
}

/** @param {readonly string[]} words */
function parted(words) {
  /** @type {Map<string, string>} */
  const given = new Map();
  /** @type {Set<string>} */
  const flags = new Set();
  const plain = [];
  const left = [...words];
  for (let word = left.shift(); word !== undefined; word = left.shift()) {
    const [name = "", value] = word.startsWith("--") ? word.split(/=(.*)/s) : [word];
    const option = VALUED[name];
    if (option !== undefined) given.set(option, value ?? left.shift() ?? "");
    else if (word.startsWith("-")) flags.add(word);
    else plain.push(word);
  }
  return { given, flags, plain };
}

/** @param {string | undefined} text @returns {number} a whole number; 0: it is none */
const count = (text) => (/^\d{1,15}$/.test(text ?? "") ? Number(text) : 0);

/** @param {string} name @returns {string} */
const rooted = (name) => (name.startsWith("/") ? name : `/${name}`);
