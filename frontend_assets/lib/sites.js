/** Sites as lists: which are shown, under which file and heading. */

/** @import { SiteView } from "../types/wire.d.ts" */

/**
 * @typedef {{words: string, kinds: ReadonlySet<string>, chosen: ReadonlySet<string> | null}} SiteFilter
 * @typedef {{key: string, group: string, file: string, sites: string[]}} SiteGroup
 */

export const KINDS = /** @type {const} */ (["arg", "property", "yaml", "param_default", "literal"]);

/** @param {SiteView} site @returns {boolean} the file on disk says something else */
export function isChanged(site) {
  return site.saved_text !== null && site.saved_text !== site.text;
}

/**
 * Whether a sentence names something, and not only another thing whose name holds that name.
 *
 * @param {string} sentence
 * @param {string} name
 * @returns {boolean}
 */
export function names(sentence, name) {
  if (name === "") return false;
  for (let at = sentence.indexOf(name); at >= 0; at = sentence.indexOf(name, at + 1)) {
    const around = [sentence.slice(0, at), sentence.slice(at + name.length)];
    if (!OF_A_NAME_BEFORE.test(around[0] ?? "") && !OF_A_NAME_AFTER.test(around[1] ?? ""))
      return true;
  }
  return false;
}

/** What makes a name longer; a full stop does where more follows. */
const OF_A_NAME_BEFORE = /(?:[\p{L}\p{N}_-]|[\p{L}\p{N}_]\.)$/u;
const OF_A_NAME_AFTER = /^(?:[\p{L}\p{N}_-]|\.[\p{L}\p{N}_])/u;

/** @param {SiteView} site @returns {string} its name without the path that its heading already says */
export function shortName({ name, group }) {
  return group !== "" && name.startsWith(`${group}.`) ? name.slice(group.length + 1) : name;
}

/** @param {SiteView} site @param {string} words lower case, all must be found @returns {boolean} */
export function matchesWords(site, words) {
  const heap = `${site.name} ${site.group} ${site.text} ${site.widget.help}`.toLowerCase();
  return words.split(/\s+/).every((word) => heap.includes(word));
}

/** @param {SiteView} site @param {SiteFilter} filter @returns {boolean} */
export function isShown(site, { words, kinds, chosen }) {
  if (chosen ? !chosen.has(site.id) : !kinds.has(site.kind)) return false;
  return words === "" || matchesWords(site, words.toLowerCase());
}

/**
 * @param {readonly string[]} order
 * @param {ReadonlyMap<string, SiteView>} sites
 * @param {SiteFilter} filter
 * @returns {SiteGroup[]} runs of one file and group, in the order of the file list, then by first sight
 */
export function groupSites(order, sites, filter) {
  /** @type {Map<string, Map<string, string[]>>} */
  const files = new Map();
  for (const id of order) {
    const site = sites.get(id);
    if (!site || !isShown(site, filter)) continue;
    /** @type {Map<string, string[]>} */
    const groups = files.get(site.file) ?? new Map();
    files.set(site.file, groups);
    const ids = groups.get(site.group);
    if (ids) ids.push(id);
    else groups.set(site.group, [id]);
  }
  return [...files].flatMap(([file, groups]) =>
    [...groups].map(([group, ids]) => ({ key: `${file}\n${group}`, file, group, sites: ids })),
  );
}

/**
 * @param {readonly string[]} order
 * @param {ReadonlyMap<string, SiteView>} sites
 * @returns {Map<string, number>} how many sites there are of each kind that occurs
 */
export function countKinds(order, sites) {
  const counts = new Map();
  for (const id of order) {
    const kind = sites.get(id)?.kind;
    if (kind) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  }
  return counts;
}
