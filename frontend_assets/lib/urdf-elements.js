/** Which part and element of the robot each line of its URDF begins, in the layout that the studio writes. */

/** @typedef {{part: string, element: string}} ElementOfPart a part's key, and the path inside it; empty: the part itself */
/** @typedef {{tag: string, name: string | null, line: number, children: Element[]}} Element */

const TAG = /<(\/?)([\w:.-]+)((?:\s+[\w:.-]+\s*=\s*"[^"]*")*)\s*(\/?)>/g;
const NAME = /\sname="([^"]*)"/;
const NAMED = new Set(["link", "joint", "material"]);
/** @type {Record<string, string>} */
const ENTITIES = { lt: "<", gt: ">", amp: "&", quot: '"', apos: "'" };

/** @param {readonly string[]} lines @returns {Map<number, ElementOfPart>} by line, from 0 */
export function elementsByLine(lines) {
  /** @type {Map<number, ElementOfPart>} */
  const found = new Map();
  for (const [key, part] of keyed(elementsOf(lines)?.children ?? [])) walk(key, "", part, found);
  return found;
}

/** @param {readonly string[]} lines @returns {Element | undefined} the root */
function elementsOf(lines) {
  /** @type {Element} */
  const all = { tag: "", name: null, line: -1, children: [] };
  const open = [all];
  lines.forEach((text, line) => {
    for (const found of text.matchAll(TAG)) take(open, found, line);
  });
  return all.children[0];
}

/** @param {Element[]} open around the tag, the root's parent first @param {RegExpMatchArray} found @param {number} line */
function take(open, [, isEnd, tag = "", attributes = "", isWhole], line) {
  if (isEnd) {
    if (open.length > 1) open.pop();
    return;
  }
  const name = NAME.exec(attributes)?.[1];
  const element = { tag, name: name === undefined ? null : plain(name), line, children: [] };
  open.at(-1)?.children.push(element);
  if (!isWhole) open.push(element);
}

/** @param {readonly Element[]} parts @returns {[string, Element][]} with their keys, as the studio names parts */
function keyed(parts) {
  /** @type {Map<string, number>} */
  const used = new Map();
  let others = 0;
  return parts.map((part) => {
    const named = NAMED.has(part.tag) && part.name !== null;
    const key = named ? `${part.tag}:${part.name}` : `other:${others}`;
    if (!named) others += 1;
    const count = (used.get(key) ?? 0) + 1;
    used.set(key, count);
    return [count === 1 ? key : `${key}#${count}`, part];
  });
}

/** @param {string} part @param {string} path @param {Element} element @param {Map<number, ElementOfPart>} found */
function walk(part, path, element, found) {
  found.set(element.line, { part, element: path });
  /** @type {Map<string, number>} */
  const seen = new Map();
  for (const child of element.children) {
    const number = (seen.get(child.tag) ?? 0) + 1;
    seen.set(child.tag, number);
    const several = element.children.filter(({ tag }) => tag === child.tag).length > 1;
    const step = several ? `${child.tag}[${number}]` : child.tag;
    walk(part, path ? `${path}/${step}` : step, child, found);
  }
}

/** @param {string} text of an attribute @returns {string} without references */
function plain(text) {
  return text.replace(/&(\w+);/g, (whole, name) => ENTITIES[name] ?? whole);
}
