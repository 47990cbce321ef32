/**
 * Command lines of `ros2`: what a pasted one calls, sends, publishes or sets, and in which panel
 * the known ones are done here.
 */

/**
 * @typedef {object} Ros2Line
 * @property {string} line as it is typed, up to its first argument
 * @property {string} panel where it is done
 * @property {"topic" | "node" | "demo" | "interface" | "bag"} [about] what its next word names
 * @property {"topic" | "service" | "action"} [form] its words are the name and the type of a message to be filled in
 */

/** The commands of `ros2` and their verbs; those without verbs take arguments at once. @type {Record<string, readonly string[]>} */
export const COMMAND_VERBS = {
  topic: ["list", "echo", "hz", "bw", "delay", "info", "type", "find", "pub"],
  service: ["list", "type", "find", "info", "call"],
  action: ["list", "info", "type", "send_goal"],
  param: ["list", "get", "set", "describe", "dump", "load", "delete"],
  node: ["list", "info"],
  interface: ["list", "show", "package", "packages", "proto"],
  lifecycle: ["nodes", "get", "set", "list"],
  pkg: ["create", "executables", "list", "prefix", "xml"],
  bag: ["record", "play", "info", "convert", "reindex", "list"],
  daemon: ["start", "stop", "status"],
  run: [],
  launch: [],
  doctor: [],
  wtf: [],
};

/** The verbs that take values, and the folder of the types of these; none: a parameter's. @type {Record<string, {verb: string, folder: string}>} */
export const KINDS = {
  service: { verb: "call", folder: "srv" },
  action: { verb: "send_goal", folder: "action" },
  topic: { verb: "pub", folder: "msg" },
  param: { verb: "set", folder: "" },
};

/** @param {string} panel @param {string} command @param {Ros2Line["about"]} [about] @returns {Ros2Line[]} of all its verbs but the one with a form */
const verbsOf = (panel, command, about) =>
  (COMMAND_VERBS[command] ?? [])
    .filter((verb) => !KINDS[command]?.folder || verb !== KINDS[command].verb)
    .map((verb) => ({ line: `ros2 ${command} ${verb}`, panel, ...(about && { about }) }));

/** @type {readonly Ros2Line[]} */
export const ROS2_LINES = [
  ...verbsOf("topics", "topic", "topic"),
  { line: "ros2 topic pub", panel: "publish", form: "topic" },
  ...verbsOf("services", "service"),
  { line: "ros2 service call", panel: "services", form: "service" },
  ...verbsOf("actions", "action"),
  { line: "ros2 action send_goal", panel: "actions", form: "action" },
  ...verbsOf("parameters", "param", "node"),
  ...verbsOf("graph", "node"),
  ...verbsOf("interfaces", "interface", "interface"),
  ...verbsOf("lifecycle", "lifecycle"),
  { line: "ros2 bag record", panel: "bag", about: "bag" },
  { line: "ros2 bag play", panel: "bag", about: "bag" },
  { line: "ros2 bag info", panel: "bag", about: "bag" },
  { line: "ros2 run", panel: "lessons", about: "demo" },
  { line: "ros2 run rviz2 rviz2", panel: "scene" },
  { line: "ros2 run rqt_graph rqt_graph", panel: "graph" },
  { line: "ros2 run turtlesim turtlesim_node", panel: "turtlesim" },
  { line: "ros2 run turtlesim turtle_teleop_key", panel: "teleop" },
  { line: "ros2 run joint_state_publisher_gui joint_state_publisher_gui", panel: "joints" },
  { line: "ros2 run tf2_tools view_frames", panel: "frames" },
  { line: "ros2 run tf2_ros tf2_echo", panel: "frames" },
  { line: "ros2 launch", panel: "launch" },
  { line: "ros2 doctor", panel: "doctor" },
  { line: "rqt_graph", panel: "graph" },
  { line: "rqt_plot", panel: "plot" },
  { line: "rqt_console", panel: "log" },
  { line: "rqt_image_view", panel: "image" },
  { line: "rviz2", panel: "scene" },
];

/**
 * The lines that somebody who typed this may mean.
 *
 * @param {string} text `ros2 top`, or a whole line with its arguments; `studio` stands for `ros2`, too
 * @returns {readonly {line: Ros2Line, rest: readonly string[]}[]} `rest`: the words behind the line; longest line first
 */
export function ros2LinesFor(text) {
  const typed = withoutHelp(shellWords(bareCommand(text)) ?? bareCommand(text).split(/\s+/));
  const whole = ROS2_LINES.flatMap((line) => {
    const words = line.line.split(" ");
    const isWhole = words.every((word, at) => typed[at] === word);
    return isWhole ? [{ line, rest: typed.slice(words.length) }] : [];
  });
  if (whole.length > 0)
    return whole.sort((a, b) => b.line.line.length - a.line.line.length).slice(0, 1);
  const begun = typed.join(" ").toLowerCase();
  if (begun.length < 3) return [];
  return ROS2_LINES.filter(({ line }) => line.startsWith(begun)).map((line) => ({
    line,
    rest: [],
  }));
}

/** @param {string} command @returns {string} without prompt, comment sign, `sudo`, and with `ros2` for `studio` */
export function bareCommand(command) {
  return command
    .trim()
    .replace(/^([$>#]\s*)+/, "")
    .replace(/^sudo\s+(-\w\s+)*/, "")
    .replace(/^studio\b/, "ros2")
    .trim();
}

/** @param {string[]} words @returns {string[]} `ros2 topic -h` asks for the verbs: what begins so is offered */
function withoutHelp(words) {
  return /^(-h|--help)$/.test(words.at(-1) ?? "") ? words.slice(0, -1) : words;
}

/**
 * @typedef {object} PastedLine
 * @property {"service" | "action" | "topic" | "param"} kind
 * @property {string} name of the service, action or topic; of the node
 * @property {string} type in full; of a parameter its name
 * @property {string} text YAML of the values
 * @property {number} rate_hz 0: once
 * @property {{reliability?: string, durability?: string, depth?: number}} qos
 */

/** Options that take a value of their own. */
const VALUED =
  /^(-r|--rate|-t|--times|-p|--print|-w|--wait-matching-subscriptions|-n|--node-name|--keep-alive|--timeout|--max-wait-time-secs|--qos-\w[\w-]*|--spin-time|--connect|--domain|--router|--distro)$/;
const FLAG = /^-(-[a-z]|[a-z1]$)/;
const RATE_HZ = 1;

/** @param {string} text @returns {PastedLine | null} null: it is no such line */
export function readLine(text) {
  const words = shellWords(bareCommand(text));
  if (words?.[0] !== "ros2") return null;
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
