/** Types of ROS as texts: their names, what a field is written as, and which dropped files define some. */

/** @import { ConstantView, FieldView } from "../types/wire.d.ts" */

/** @typedef {"msg" | "srv" | "action"} Kind */

export const KINDS = /** @type {const} */ (["msg", "srv", "action"]);
const FILE =
  /(?:^|\/)(?:(?<folder>[^/]+)\/)?(?:msg|srv|action)\/(?<name>[^/]+)\.(?<kind>msg|srv|action)$/;
const LOOSE = /(?:^|\/)(?<name>[^/]+)\.(?<kind>msg|srv|action)$/;
const ROBOT = /\.(xacro|urdf|sdf|zip|rviz)$/i;
/** A line of a text, and one that stands nowhere else. */
const FIELD =
  /^[A-Za-z]\w*(\/[A-Za-z]\w*){0,2}(<=\d+)?(\[(<=)?\d*\])?\s+[A-Za-z]\w*(\s*=.+|\s+(-?[\d.][\w.+-]*|"[^"]*"|'[^']*'|\[.*\]|true|false))?$/i;
const SURE =
  /^(bool|byte|char|float32|float64|u?int(8|16|32|64)|w?string|[a-z]\w*(\/msg)?\/[A-Z]\w*)(<=\d+)?(\[(<=)?\d*\])?\s+[A-Za-z]\w*/;
const NAME = /^(?<package>[a-z][a-z0-9_]*)\/(?<kind>msg|srv|action)\/(?<type>[A-Z][A-Za-z0-9]*)$/;

/** @param {string} name @returns {{package: string, kind: Kind, type: string} | null} parts of a full name */
export function nameParts(name) {
  const found = NAME.exec(name)?.groups;
  return found ? /** @type {any} */ ({ ...found }) : null;
}

/** @param {readonly string[]} names full ones @returns {Map<string, string[]>} by package, in their order */
export function byPackage(names) {
  /** @type {Map<string, string[]>} */
  const packages = new Map();
  for (const name of names) {
    const [owner = ""] = name.split("/", 1);
    const known = packages.get(owner);
    if (known) known.push(name);
    else packages.set(owner, [name]);
  }
  return packages;
}

/** @param {readonly string[]} names @param {string} words each of them in the name @returns {string[]} those whose own name begins so come first */
export function foundNames(names, words) {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const found = names.filter((name) => wanted.every((one) => name.toLowerCase().includes(one)));
  const rank = (/** @type {string} */ name) =>
    (name.split("/").at(-1) ?? "").toLowerCase().startsWith(wanted[0] ?? "") ? 0 : 1;
  return found.sort((a, b) => rank(a) - rank(b));
}

/** @param {FieldView} field @returns {string} its type as it is written in a text */
export function fieldType({ base, shape, count, string_bound: bound }) {
  const short = base.replace("/msg/", "/");
  const single = bound > 0 ? `${short}<=${bound}` : short;
  if (shape === "single") return single;
  if (shape === "array") return `${single}[${count}]`;
  return shape === "bounded" ? `${single}[<=${count}]` : `${single}[]`;
}

/** @param {ConstantView["value"] | FieldView["default"]} value @returns {string} as it is written in a text */
export function valueText(value) {
  if (value === null || value === undefined) return "";
  return Array.isArray(value) ? `[${value.map(valueText).join(", ")}]` : JSON.stringify(value);
}

/** @param {{place: string, line: number}} fault @returns {string} its file without the folders above the package, and the line */
export function faultPlace({ place, line }) {
  const short = place.split(/[/\\]/).slice(-3).join("/");
  return line > 0 ? `${short}:${line}` : short;
}

/** @param {string} text @returns {Kind} what a text defines, by the lines of dashes in it */
export function kindOf(text) {
  const rules = text.split("\n").filter((line) => /^---\s*$/.test(line)).length;
  return KINDS[Math.min(rules, 2)] ?? "msg";
}

/** @param {string} text @returns {boolean} it defines a type: each of its lines does, and one names what no other text does */
export function definesType(text) {
  const lines = text.split("\n").map((line) => line.replace(/#.*/, "").trim());
  const said = lines.filter((line) => line !== "" && line !== "---");
  return said.every((line) => FIELD.test(line)) && said.some((line) => SURE.test(line));
}

/**
 * @template T
 * @param {readonly {path: string, file: T}[]} files that were dropped
 * @param {ReadonlyMap<string, string>} [packages] names of packages by the folder that holds their package.xml
 * @returns {{named: {name: string, file: T}[], loose: {type: string, kind: Kind, file: T}[]} | null} null: there is none, or a robot is among them; `loose`: those that do not tell their package
 */
export function typesAmong(files, packages = new Map()) {
  if (files.some(({ path }) => ROBOT.test(path))) return null;
  /** @type {{name: string, file: T}[]} */
  const named = [];
  /** @type {{type: string, kind: Kind, file: T}[]} */
  const loose = [];
  for (const { path, file } of files) {
    const found = FILE.exec(path)?.groups;
    const other = LOOSE.exec(path)?.groups;
    const above = path.replace(/\/?(msg|srv|action)\/[^/]+$/, "");
    const owner = packages.get(above) ?? found?.folder;
    if (found && owner) named.push({ name: `${owner}/${found.kind}/${found.name}`, file });
    else if (other)
      loose.push({ type: other.name ?? "", kind: /** @type {Kind} */ (other.kind), file });
  }
  return named.length + loose.length > 0 ? { named, loose } : null;
}
