/** The line of a text in which a link or joint of the robot is written. */

/** @typedef {{lines: number, line: (number: number) => {text: string}}} Lines as CodeMirror's Text; from 1 */

/**
 * @param {Lines} doc as it is now; the robot may be of an older one
 * @param {{kind: string, name: string, line: number}} part `line` where it was in the last good run
 * @returns {number} from 1; 0: it is not to be found
 */
export function lineOfPart(doc, { kind, name, line }) {
  const tag = new RegExp(`<${kind}(?:[\\s>]|$)`);
  const isNamed = (/** @type {string} */ text) =>
    tag.test(text) && (text.includes(`"${name}"`) || text.includes(`'${name}'`));
  const there = line >= 1 && line <= doc.lines ? doc.line(line).text : "";
  // A name that a macro makes is not written anywhere; its line is all that is known.
  if (isNamed(there) || (tag.test(there) && there.includes("$"))) return line;
  for (let number = 1; number <= doc.lines; number += 1)
    if (isNamed(doc.line(number).text)) return number;
  return tag.test(there) ? line : 0;
}
