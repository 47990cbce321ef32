/**
 * The texts of the help and the lessons: a small part of Markdown, with keys, icons and marks,
 * each fetched when it is first asked for.
 *
 * A line `![what it shows](name)` is a picture, `## Words` a heading, `- words` an entry of a
 * list; all else is text. In a text: `**name of a control**`, code in backticks, `[words](page)`
 * or, with what is to be seen there, `[words](page /name type)`, `{key Mod+K}`, `{icon eye}`, and
 * `{mark amber}` for a dot of that tone.
 */

/** @typedef {{kind: "text" | "strong" | "code" | "key" | "icon" | "mark", text: string} | {kind: "link", text: string, page: string, about: readonly string[]}} Part */
/**
 * @typedef {{kind: "picture", name: string, alt: string} | {kind: "heading" | "text", parts: readonly Part[]} |
 *   {kind: "list", entries: readonly (readonly Part[])[]}} Block
 */

const PICTURE = /^!\[([^\]]+)\]\((\w+)\)$/;
const INLINE =
  /\*\*(?<strong>[^*]+)\*\*|`(?<code>[^`]+)`|\[(?<link>[^\]]+)\]\((?<page>\w+)(?: (?<about>[^()]+))?\)|\{(?<sign>key|icon|mark) (?<name>[^}]+)\}/g;

/** @param {string} text @returns {Block[]} */
export function readHelp(text) {
  return text
    .split(/\n\s*\n/)
    .map((block) => block.trim())
    .filter((block) => block !== "")
    .map(readBlock);
}

/** @param {string} block @returns {Block} */
function readBlock(block) {
  const [, alt, name] = PICTURE.exec(block) ?? [];
  if (alt && name) return { kind: "picture", name, alt };
  if (block.startsWith("## ")) return { kind: "heading", parts: readParts(block.slice(3)) };
  if (block.startsWith("- "))
    return { kind: "list", entries: block.slice(2).split(/\n- /).map(readParts) };
  return { kind: "text", parts: readParts(block) };
}

/** @param {string} text may run over several lines @returns {Part[]} */
function readParts(text) {
  const line = text.replace(/\s*\n\s*/g, " ");
  /** @type {Part[]} */
  const parts = [];
  let at = 0;
  for (const match of line.matchAll(INLINE)) {
    if (match.index > at) parts.push({ kind: "text", text: line.slice(at, match.index) });
    parts.push(partOf(match.groups ?? {}));
    at = match.index + match[0].length;
  }
  if (at < line.length) parts.push({ kind: "text", text: line.slice(at) });
  return parts;
}

/** @param {Record<string, string | undefined>} found @returns {Part} */
function partOf({ strong, code, link, page, about = "", sign, name = "" }) {
  if (strong !== undefined) return { kind: "strong", text: strong };
  if (code !== undefined) return { kind: "code", text: code };
  if (link !== undefined && page !== undefined)
    return { kind: "link", text: link, page, about: about.split(" ").filter(Boolean) };
  return { kind: /** @type {"key" | "icon" | "mark"} */ (sign), text: name };
}

/** @param {Block} block @returns {readonly Part[]} */
export function partsOf(block) {
  if (block.kind === "picture") return [];
  return block.kind === "list" ? block.entries.flat() : block.parts;
}

/** @param {readonly Block[]} blocks @returns {string} what can be searched, without pictures and icons */
export function plainHelp(blocks) {
  return blocks
    .flatMap((block) => (block.kind === "list" ? block.entries : [partsOf(block)]))
    .map((parts) => parts.map(spoken).join(""))
    .filter((text) => text !== "")
    .join(" ");
}

/** @param {Part} part @returns {string} */
const spoken = ({ kind, text }) =>
  kind === "icon" || kind === "mark" ? "" : kind === "key" ? text.replace("Mod", "Ctrl") : text;

/**
 * @template T
 * @param {string} folder its address
 * @param {(text: string) => T} read is given an empty text when there is none now
 * @returns {(name: string) => Promise<T>} by the name of a file in the folder
 */
export function textFiles(folder, read) {
  /** @type {Map<string, Promise<T>>} */
  const known = new Map();
  const fetched = async (/** @type {string} */ name) => {
    const text = await fetch(`${folder}${name}`)
      .then((answer) => (answer.ok ? answer.text() : ""))
      .catch(() => "");
    // What failed is asked for anew the next time.
    if (text === "") known.delete(name);
    return read(text);
  };
  return (name) => {
    const asked = known.get(name) ?? fetched(name);
    known.set(name, asked);
    return asked;
  };
}
