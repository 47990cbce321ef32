/** Command lines of `ros2 bag`, read: what is recorded and how, and which bags are played or told of. */

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

/** @typedef {{name: string, values: string[], text: string}} Option of a line, with its text as it stands there */
/** @typedef {"one" | "many" | "number"} Values of an option: one, all up to the next option, or a number that may be missing */

/**
 * `leftOut` are the words of the line that the page does nothing with, an option with its values.
 *
 * @typedef {{verb: "record", form: RecordLine, leftOut: string[]}
 *   | {verb: "play" | "info", paths: string[], leftOut: string[]}} BagLine
 */

const TOPIC = /^\/?[A-Za-z_][\w/]*$/;
/** What a course writes where a name of one's own belongs, as `<topic_name>`. */
const BLANK = /^</;
/** Options of the form that have a value, by each of their names. @type {Record<string, string>} */
const FIELDS = {
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
  "--compression-mode": "mode",
};
const ALL = ["-a", "--all", "--all-topics"];

/** @param {Values} how @param {string} names @returns {Record<string, Values>} */
const each = (how, names) => Object.fromEntries(names.split(" ").map((name) => [name, how]));

const RECORD = {
  ...each("one", Object.keys(FIELDS).join(" ")),
  ...each("one", "--max-cache-size --max-cache-duration --max-bag-files --node-name -p"),
  ...each("one", "--polling-interval --qos-profile-overrides-path --storage-config-file"),
  ...each("one", "--storage-preset-profile --log-level -f --serialization-format"),
  ...each("one", "--compression-queue-size --compression-threads --compression-threads-priority"),
  ...each("many", "--topics --services --topic-types --exclude-topics --exclude-topic-types"),
  ...each("many", "--exclude-services --custom-data"),
};
const PLAY = {
  ...each("many", "-i --input --topics --services --exclude-topics --exclude-services"),
  ...each("many", "-m --remap --clock-topics"),
  ...each("one", "-e --regex -x --exclude-regex --qos-profile-overrides-path -r --rate -d --delay"),
  ...each("one", "--start-offset --playback-duration --playback-until-sec --playback-until-nsec"),
  ...each("one", "--read-ahead-queue-size --progress-bar-update-rate --wait-for-all-acked"),
  ...each("one", "--log-level -s --storage --storage-config-file --service-requests-source"),
  ...each("number", "--clock"),
};
const INFO = each("one", "-s --storage --sort");

/** @param {string} text @returns {BagLine | null} null: it is no such line */
export function readBagLine(text) {
  const [ros2, bag, verb, ...words] = shellWords(bareCommand(text)) ?? [];
  if (ros2 !== "ros2" || bag !== "bag") return null;
  if (verb === "record") return { verb, ...recordLine(words) };
  if (verb === "play" || verb === "info") return { verb, ...openLine(words, verb) };
  return null;
}

/** @param {readonly string[]} words @returns {{form: RecordLine, leftOut: string[]}} */
function recordLine(words) {
  const { plain, options } = parted(words, RECORD);
  const named = [...plain, ...valuesOf(options, ["--topics"])];
  /** @type {Map<string, Option>} */
  const given = new Map();
  for (const option of options) {
    const field = FIELDS[option.name];
    if (field) given.set(field, option);
  }
  /** @param {string} field */
  const value = (field) => given.get(field)?.values[0] ?? "";
  const output = value("output");
  const format = value("compression");
  /** @type {RecordLine} */
  const form = {
    all: options.some(({ name }) => ALL.includes(name)),
    topics: named.filter((word) => TOPIC.test(word)).map(rooted),
    regex: value("regex"),
    exclude: value("exclude"),
    name: BLANK.test(output) ? "" : baseName(output.replace(/\/+$/, "")),
    storage: value("storage") === "sqlite3" ? "sqlite3" : "mcap",
    compression: format === "zstd" || format === "lz4" ? format : "none",
    maxBytes: count(value("bytes")),
    maxSeconds: count(value("seconds")),
  };
  /** What the form has not become, though it was said. @type {Record<string, boolean>} */
  const isLost = {
    storage: value("storage") !== form.storage,
    compression: !["", "none", form.compression].includes(format),
    // A compression is that of the chunks; where none is chosen, the mode says nothing.
    mode: form.compression === "none" && value("mode") !== "none",
    bytes: value("bytes") !== String(form.maxBytes),
    seconds: value("seconds") !== String(form.maxSeconds),
  };
  const isTaken = (/** @type {Option} */ option) => {
    const field = FIELDS[option.name];
    if (field) return !isLost[field] || BLANK.test(option.values[0] ?? "");
    return ALL.includes(option.name) || option.name === "--topics";
  };
  return {
    form,
    leftOut: [
      ...named.filter((word) => !TOPIC.test(word) && !BLANK.test(word)),
      ...textsOf(options.filter((option) => !isTaken(option))),
    ],
  };
}

/** @param {readonly string[]} words @param {"play" | "info"} verb @returns {{paths: string[], leftOut: string[]}} */
function openLine(words, verb) {
  const { plain, options } = parted(words, verb === "play" ? PLAY : INFO);
  // Each -i has one bag, behind which its storage may stand.
  const inputs = options.filter(({ name }) => name === "-i" || name === "--input");
  const [first, ...others] = plain;
  const paths = [first, ...inputs.map(({ values }) => values[0])].filter(
    (path) => path !== undefined && !BLANK.test(path),
  );
  // How a bag is stored its files tell by themselves.
  const isTaken = (/** @type {Option} */ one) =>
    inputs.includes(one) || one.name === "-s" || one.name === "--storage";
  return {
    paths: /** @type {string[]} */ (paths),
    leftOut: [
      ...others.filter((word) => !BLANK.test(word)),
      ...textsOf(options.filter((one) => !isTaken(one))),
    ],
  };
}

/** @param {readonly Option[]} options @param {readonly string[]} names @returns {string[]} */
const valuesOf = (options, names) =>
  options.filter(({ name }) => names.includes(name)).flatMap(({ values }) => values);

/** @param {readonly Option[]} options @returns {string[]} */
const textsOf = (options) => options.map(({ text }) => text);

/**
 * The options of a line and its other words.
 *
 * @param {readonly string[]} words
 * @param {Record<string, Values>} known which options have values; an option that is not in it has none
 */
function parted(words, known) {
  /** @type {Option[]} */
  const options = [];
  const plain = [];
  const left = [...words];
  for (let word = left.shift(); word !== undefined; word = left.shift()) {
    if (!word.startsWith("-")) {
      plain.push(word);
      continue;
    }
    const [name = "", value] = word.startsWith("--") ? word.split(/=(.*)/s) : [word];
    if (value !== undefined) options.push({ name, values: [value], text: word });
    else {
      const values = left.splice(0, valueCount(left, known[name]));
      options.push({ name, values, text: [word, ...values].join(" ") });
    }
  }
  return { options, plain };
}

/** @param {readonly string[]} left words behind an option @param {Values | undefined} how @returns {number} how many of them are its values */
function valueCount(left, how) {
  if (how === "one") return 1;
  if (how === "number") return /^[\d.]+$/.test(left[0] ?? "") ? 1 : 0;
  if (how === undefined) return 0;
  const end = left.findIndex((word) => word.startsWith("-"));
  return end < 0 ? left.length : end;
}

/** @param {string} text @returns {number} a whole number; 0: it is none */
const count = (text) => (/^\d{1,15}$/.test(text) ? Number(text) : 0);

/** @param {string} name @returns {string} */
const rooted = (name) => (name.startsWith("/") ? name : `/${name}`);
