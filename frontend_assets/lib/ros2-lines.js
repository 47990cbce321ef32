/** Command lines that people know from ROS 2, and the panel in which each of them is done here. */

import { shellWords } from "./pasted-line.js";

/**
 * @typedef {object} Ros2Line
 * @property {string} line as it is typed, up to its first argument
 * @property {string} panel where it is done
 * @property {"topic" | "node" | "demo" | "interface"} [about] what its next word names
 * @property {"topic" | "service" | "action"} [form] its words are the name and the type of a message to be filled in
 */

/** @param {string} panel @param {string} command @param {string} verbs @param {Ros2Line["about"]} [about] @returns {Ros2Line[]} */
const verbsOf = (panel, command, verbs, about) =>
  verbs
    .split(" ")
    .map((verb) => ({ line: `ros2 ${command} ${verb}`, panel, ...(about && { about }) }));

/** @type {readonly Ros2Line[]} */
export const ROS2_LINES = [
  ...verbsOf("topics", "topic", "list echo hz bw delay info type find", "topic"),
  { line: "ros2 topic pub", panel: "publish", form: "topic" },
  ...verbsOf("services", "service", "list type find"),
  { line: "ros2 service call", panel: "services", form: "service" },
  ...verbsOf("actions", "action", "list info"),
  { line: "ros2 action send_goal", panel: "actions", form: "action" },
  ...verbsOf("parameters", "param", "list get set describe dump load delete", "node"),
  ...verbsOf("graph", "node", "list info"),
  ...verbsOf("interfaces", "interface", "list show package packages proto", "interface"),
  ...verbsOf("lifecycle", "lifecycle", "nodes get set list"),
  { line: "ros2 run", panel: "lessons", about: "demo" },
  { line: "ros2 run tf2_tools view_frames", panel: "frames" },
  { line: "ros2 run tf2_ros tf2_echo", panel: "frames" },
  { line: "ros2 launch", panel: "arguments" },
  { line: "ros2 doctor", panel: "ros" },
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
  const typed = (shellWords(text.trim().replace(/^[$>]\s+/, "")) ?? text.trim().split(/\s+/)).map(
    (word, at) => (at === 0 && word === "studio" ? "ros2" : word),
  );
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
