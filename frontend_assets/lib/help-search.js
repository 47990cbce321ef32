/** Finding a page of the help by words in it. */

/** @typedef {{page: string, title: string, text: string}} HelpText */
/** @typedef {{page: string, title: string, excerpt: string}} Found */

const AROUND = 60;
const FOUND_MOST = 12;

/**
 * @param {readonly HelpText[]} texts
 * @param {string} sought
 * @returns {Found[]} pages with every one of the words; those with a word in the title first
 */
export function searchHelp(texts, sought) {
  const words = sought.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return [];
  return texts
    .map((one) => ({ one, weight: weightOf(one, words) }))
    .filter(({ weight }) => weight > 0)
    .sort((a, b) => b.weight - a.weight)
    .slice(0, FOUND_MOST)
    .map(({ one }) => ({ page: one.page, title: one.title, excerpt: excerpt(one.text, words) }));
}

/** @param {HelpText} one @param {readonly string[]} words @returns {number} 0: a word is missing */
function weightOf({ title, text }, words) {
  const [named, said] = [title.toLowerCase(), text.toLowerCase()];
  if (!words.every((word) => named.includes(word) || said.includes(word))) return 0;
  const inTitle = words.filter((word) => named.includes(word)).length;
  const times = words.reduce((sum, word) => sum + said.split(word).length - 1, 0);
  return 1 + 100 * inTitle + Math.min(times, 50);
}

/** @param {string} text @param {readonly string[]} words @returns {string} whole words around the first that is found */
function excerpt(text, words) {
  const low = text.toLowerCase();
  const places = words.map((word) => low.indexOf(word)).filter((at) => at >= 0);
  const at = places.length > 0 ? Math.min(...places) : 0;
  const begin = at <= AROUND ? 0 : text.indexOf(" ", at - AROUND) + 1;
  const end = text.lastIndexOf(" ", at + 2 * AROUND);
  const cut = at + 2 * AROUND >= text.length || end <= at ? text.length : end;
  return `${begin > 0 ? "… " : ""}${text.slice(begin, cut)}${cut < text.length ? " …" : ""}`;
}
