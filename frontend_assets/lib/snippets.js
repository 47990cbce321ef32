/** Texts with places for the cursor, as CodeMirror's snippets write them. */

/**
 * @param {string} text
 * @param {readonly (readonly number[])[]} stops stretches of the text that the cursor visits, in order
 * @returns {string} a snippet template of CodeMirror
 */
export function snippetTemplate(text, stops) {
  let template = "";
  let at = 0;
  stops.forEach(([start = 0, end = 0], number) => {
    const inside = text.slice(start, end).replaceAll(/[{}]/g, "");
    template += plain(text.slice(at, start));
    template += inside === "" ? `#{${number + 1}}` : `#{${number + 1}:${inside}}`;
    at = end;
  });
  return template + plain(text.slice(at));
}

/** @param {string} text */
const plain = (text) => text.replaceAll(/[{}]/g, "\\$&");
