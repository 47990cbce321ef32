/** How a text indents, so that new lines do as the old ones. */

const LINES = 400;

/** @param {Iterable<string>} lines @returns {string} a tab or some spaces; two where nothing tells */
export function indentationOf(lines) {
  /** @type {Map<string, number>} */
  const steps = new Map();
  let before = 0;
  for (const line of firstOf(lines)) {
    const depth = /^ */.exec(line)?.[0].length ?? 0;
    const step = line.startsWith("\t") ? "\t" : " ".repeat(Math.max(depth - before, 0));
    if (step === "\t" || (step.length > 1 && step.length <= 8))
      steps.set(step, (steps.get(step) ?? 0) + 1);
    before = depth;
  }
  const [best] = [...steps].sort((a, b) => b[1] - a[1]);
  return best?.[0] ?? "  ";
}

/** @param {Iterable<string>} lines @returns {Generator<string>} those that say something */
function* firstOf(lines) {
  let count = 0;
  for (const line of lines) {
    count += 1;
    if (count > LINES) return;
    if (line.trim() !== "") yield line;
  }
}
