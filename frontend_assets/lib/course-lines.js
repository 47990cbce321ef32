/**
 * Lines of a shell as courses of ROS 2 print them: what each is here, and what was meant where one
 * is misspelt.
 */

import { bareCommand, COMMAND_VERBS, KINDS, shellWords } from "./ros2-lines.js";

/**
 * @typedef {object} ToldLine
 * @property {string} command as it was pasted, without prompt, comment sign and `sudo`
 * @property {string} key its sentence is `line.<key>`
 * @property {Record<string, string>} values of that sentence
 * @property {string} [panel] where this is done or seen here
 */

/**
 * What a line begins with, and its sentence; the first that fits is taken.
 *
 * @type {readonly {begins: RegExp, key: string, panel?: string}[]}
 */
const TOLD = [
  { begins: /^(mkdir|cd)\b/, key: "folders" },
  { begins: /^(nano|touch|gedit|vim?|code)\b/, key: "file", panel: "source" },
  { begins: /^(source|\.) .*bin\/activate\b/, key: "venv" },
  { begins: /^(source|\.) \/opt\/ros\//, key: "source_ros" },
  { begins: /^(source|\.) \S*setup\.\w*sh\b/, key: "source_workspace" },
  { begins: /^(source|\.) \S*bashrc\b/, key: "alias" },
  { begins: /^(alias|export)\b/, key: "alias" },
  { begins: /^(conda\b|python3? -m venv\b|virtualenv\b)/, key: "venv" },
  { begins: /^(apt|apt-get|curl|wget|dpkg|add-apt-repository)\b/, key: "install" },
  { begins: /^git clone\b/, key: "git_clone" },
  { begins: /^rosdep\b/, key: "rosdep", panel: "problems" },
  { begins: /^colcon build\b.*--symlink-install\b/, key: "colcon_symlink" },
  { begins: /^colcon build\b.*--packages-select\b/, key: "colcon_select" },
  { begins: /^colcon build\b/, key: "colcon_build" },
  { begins: /^colcon test/, key: "colcon_test" },
  { begins: /^(gz|ign|gazebo|gzserver|gzclient)\b/, key: "gazebo" },
  { begins: /^ros2 daemon\b/, key: "daemon", panel: "graph" },
  { begins: /^ros2 bag (convert|reindex|list|burst)\b/, key: "bag", panel: "bag" },
  { begins: /^ros2 pkg create\b/, key: "pkg_create", panel: "packages" },
  { begins: /^ros2 pkg\b/, key: "pkg", panel: "packages" },
  { begins: /^ros2 run xacro xacro\b/, key: "xacro", panel: "urdf" },
];

/**
 * What is told about pasted lines.
 *
 * @param {string} text one line or several, `&&` between commands
 * @returns {ToldLine[]} of those that are known, in their order; each sentence once
 */
export function toldLines(text) {
  /** @type {Map<string, ToldLine>} */
  const told = new Map();
  for (const command of commandsOf(text)) {
    const found = TOLD.find(({ begins }) => begins.test(command));
    if (!found || told.has(found.key)) continue;
    const { key, panel } = found;
    told.set(key, { command, key, values: { line: command }, ...(panel && { panel }) });
  }
  return [...told.values()];
}

/** @param {string} text @returns {string[]} the commands of pasted text, each as `ros2` or the shell would run it */
export function commandsOf(text) {
  return oneLine(text)
    .split(/\s*(?:&&|;)\s*/)
    .map(bareCommand)
    .filter((command) => command !== "");
}

/**
 * Pasted text as one line: what goes on in the next line is joined, other lines stand behind `&&`.
 *
 * @param {string} text
 * @returns {string}
 */
export function oneLine(text) {
  return text
    .trim()
    .replace(/\s*\\\s*\r?\n\s*/g, " ")
    .replace(/\s*\r?\n\s*(?=(--|&&|\|))/g, " ")
    .replace(/(\r?\n\s*)+/g, " && ")
    .replace(/&&\s*&&/g, "&&");
}

const TYPE_ENDING = /\.(srv|msg|action)$/;
const TYPE = /^[a-zA-Z]\w*([./]\w+){1,2}$/;

/**
 * The line of `ros2` that was meant by a misspelt one.
 *
 * @param {string} text
 * @param {(kind: string, name: string) => string} [typeOf] of a topic, service or action of the graph; empty: not known
 * @returns {string | null} null: nothing is to be mended, or it is no line of `ros2`
 */
export function mendedLine(text, typeOf = () => "") {
  const words = shellWords(bareCommand(oneLine(text)));
  if (words?.[0] !== "ros2" || words.length < 2) return null;
  const mended = mendedRun(words) ?? mendedWords(words, typeOf);
  return mended.join(" ") === words.join(" ") ? null : mended.map(quoted).join(" ");
}

/** @param {readonly string[]} words @returns {string[] | null} for a program that ROS does not have in this form */
function mendedRun(words) {
  if (words.slice(1, 4).join(" ") !== "run lifecycle lifecycle_service_client") return null;
  const at = words.indexOf("--node-name");
  const node = at > 0 ? (words[at + 1] ?? "") : "";
  return ["ros2", "lifecycle", "get", ...(node ? [node] : [])];
}

/** @param {readonly string[]} words @param {(kind: string, name: string) => string} typeOf @returns {string[]} */
function mendedWords([ros2 = "", command = "", ...after], typeOf) {
  const known = nearest(command, Object.keys(COMMAND_VERBS));
  if (known === "doctor") return [ros2, known, ...after.filter((w) => w !== "--include-dds")];
  const verbs = COMMAND_VERBS[known] ?? [];
  if (verbs.length === 0 || after.length === 0) return [ros2, known, ...after];
  const [first = "", ...rest] = after;
  const verb = nearest(first, verbs);
  if (!KINDS[known]?.folder) return [ros2, known, verb, ...rest];
  const names = verb === first ? rest : rest.map((one) => (one.startsWith("/") ? tidy(one) : one));
  const tidied = names.map(tidyType);
  const whole = verb === KINDS[known].verb ? withType(tidied, known, typeOf) : tidied;
  return [ros2, known, verb, ...whole];
}

/** @param {readonly string[]} words @param {string} kind @param {(kind: string, name: string) => string} typeOf @returns {readonly string[]} with the type behind the name, if it is missing and known */
function withType(words, kind, typeOf) {
  const at = words.findIndex((word) => !word.startsWith("-"));
  const name = words[at];
  const type = words[at + 1];
  if (name === undefined || (type !== undefined && !type.startsWith("{"))) return words;
  const known = typeOf(kind, name.startsWith("/") ? name : `/${name}`);
  return known ? [...words.slice(0, at + 1), known, ...words.slice(at + 1)] : words;
}

/** @param {string} word @returns {string} a type without what no type has at its end, and no underscores around its parts */
function tidyType(word) {
  const bare = word.replace(TYPE_ENDING, "");
  const parts = tidy(bare);
  return TYPE.test(parts) && !word.startsWith("/") ? parts : word;
}

/** @param {string} name @returns {string} no underscore at an edge of its parts */
const tidy = (name) => name.replace(/(^|\/)_+(?=\w)/g, "$1").replace(/(\w)_+(?=\/|$)/g, "$1");

/** @param {string} word @param {readonly string[]} known @returns {string} the known one that it is most like; itself: none is near */
function nearest(word, known) {
  if (known.includes(word) || word.startsWith("-")) return word;
  const [best] = known
    .map((one) => ({ one, far: distance(word, one) }))
    .sort((a, b) => a.far - b.far);
  return best && best.far <= Math.min(2, best.one.length / 2) ? best.one : word;
}

/** @param {string} a @param {string} b @returns {number} letters to put in, leave out, change or swap */
export function distance(a, b) {
  /** @type {number[][]} */
  const rows = [[...Array(b.length + 1).keys()]];
  for (let i = 1; i <= a.length; i += 1) {
    const row = [i];
    for (let j = 1; j <= b.length; j += 1) {
      const same = a[i - 1] === b[j - 1] ? 0 : 1;
      const above = /** @type {number[]} */ (rows[i - 1]);
      let least = Math.min(
        Number(above[j]) + 1,
        Number(row[j - 1]) + 1,
        Number(above[j - 1]) + same,
      );
      if (i > 1 && j > 1 && a[i - 1] === b[j - 2] && a[i - 2] === b[j - 1])
        least = Math.min(least, Number(rows[i - 2]?.[j - 2]) + 1);
      row.push(least);
    }
    rows.push(row);
  }
  return Number(rows[a.length]?.[b.length]);
}

/** @param {string} word @returns {string} as a shell takes it for one word */
export function quoted(word) {
  if (/^[\w@%+=:,./~<>-]+$/.test(word)) return word;
  return word.includes('"') ? `'${word}'` : `"${word}"`;
}
