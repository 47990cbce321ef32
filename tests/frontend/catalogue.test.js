import assert from "node:assert/strict";
import { test } from "node:test";
import { sourcesIn } from "./support/sources.js";
import { wordsOf } from "./support/words.js";

/** What is the same in every language: names of keys, of formats, and what xacro itself is written in. */
const SAME =
  /^(Enter|Esc|URDF|YAML|XML|PNG|HTML|JSON|SRDF|name:=value|kg|m|mm|rad|deg|xyz|rpy|x|y|z|w)$/;
const SPOKEN = /(?:aria-label|title|placeholder|label|hint|alt|aria-description)="([^"]*)"/g;
const HOLE = "\0";
/** @type {Record<string, string>} */
const WORDS = wordsOf("en");

/**
 * The templates of a module, each as its own text with a hole for what is put in.
 *
 * @param {string} source
 * @returns {string[]}
 */
function templatesOf(source) {
  /** @type {string[]} */
  const found = [];
  for (const { index } of source.matchAll(/\bhtml`/g)) {
    found.push(templateAt(source, index + "html`".length).text);
  }
  return found;
}

/** @param {string} source @param {number} from behind the opening mark @returns {{text: string, end: number}} */
function templateAt(source, from) {
  let text = "";
  let at = from;
  while (at < source.length && source[at] !== "`") {
    if (source.startsWith("${", at)) {
      text += HOLE;
      at = endOfHole(source, at + 2);
    } else {
      text += source[at];
      at += 1;
    }
  }
  return { text, end: at + 1 };
}

/** @param {string} source @param {number} from behind `${` @returns {number} behind the brace that closes it */
function endOfHole(source, from) {
  let depth = 1;
  let at = from;
  while (at < source.length && depth > 0) {
    const sign = source[at];
    if (sign === "`") at = templateAt(source, at + 1).end - 1;
    else if (sign === '"') at = source.indexOf('"', at + 1);
    else if (sign === "{") depth += 1;
    else if (sign === "}") depth -= 1;
    at += 1;
  }
  return at;
}

/** @param {string} template @returns {string[]} the words in it that a person reads or hears */
function wordsIn(template) {
  const spoken = [...template.matchAll(SPOKEN)].map(([, words]) => words ?? "");
  const read = template.replace(/<[^<>]*>/g, HOLE).split(HOLE);
  return [...spoken, ...read]
    .flatMap((part) => part.split(HOLE))
    .map((part) => part.trim())
    .filter((part) => /\p{L}{2,}/u.test(part) && !SAME.test(part) && !(part in WORDS));
}

test("the words of a template are found, however deep it lies", () => {
  const source = 'f(html`<p title="A tip">${x ? html`<b>Yes ${n}</b>` : { a: `}` }}</p> on`)';
  assert.deepEqual(templatesOf(source).flatMap(wordsIn), ["A tip", "on", "Yes"]);
});

test("no panel and no window speaks but in the words of the catalogue", () => {
  for (const [file, source] of sourcesIn(["app/", "model/", "panels/", "lib/"]))
    assert.deepEqual(templatesOf(source).flatMap(wordsIn), [], file);
});

test("every command has its words", () => {
  for (const [file, source] of sourcesIn(["app/", "model/", "panels/"])) {
    if (!source.includes("addCommands(")) continue;
    for (const [, id] of source.matchAll(/\bid: "([\w.]+)"/g))
      assert.ok(`command.${id}` in WORDS, `${file}: command.${id} has no words`);
  }
  for (const panel of Object.keys(WORDS).filter((key) => /^command\.panel\.\w+$/.test(key)))
    assert.ok(panel.replace("command.", "") in WORDS, panel);
});
