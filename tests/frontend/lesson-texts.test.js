/** @import { Part } from "../../frontend_assets/lib/help-text.js" */

import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { partsOf } from "../../frontend_assets/lib/help-text.js";
import { readLesson } from "../../frontend_assets/model/lessons.js";
import { ICON_NAMES, PANEL_IDS as PANELS } from "./support/panels.js";

const ROOT = new URL("../../", import.meta.url);
/** @param {string} path */
const textOf = (path) => readFileSync(new URL(path, ROOT), "utf8");

const CHAPTERS = textOf("studio/course/demos.py");
const FOUND = [...CHAPTERS.matchAll(/Lesson\("(\w+)", "(\/\w+)"/g)];
const DEMOS = FOUND.map(([, demo = ""]) => demo);
const NODES = FOUND.map(([, , node = ""]) => node);
const [, LISTED = ""] =
  /EXERCISES: Final = \(([^)]*)\)/.exec(textOf("studio/course/lessons/shelf.py")) ?? [];
const EXERCISES = [...LISTED.matchAll(/"(\w+)"/g)].map(([, name = ""]) => name);
const NAMES = [...DEMOS, ...EXERCISES];
/** How many words a link may have after the panel. @type {Record<string, readonly number[]>} */
const ABOUT = {
  ...{ topics: [0, 1], parameters: [0, 1], lessons: [0, 1] },
  ...{ services: [0, 2], actions: [0, 2], publish: [0, 2] },
};
/** Names that are of no demo: every node's, or the studio's own. */
const EVERYWHERE = ["/rosout", "/parameter_events", "/studio", "/tf", "/tf_static"];

/** @param {string} language @param {string} name */
const lessonOf = (language, name) =>
  readLesson(textOf(`frontend_assets/lessons/${language}/${name}.md`));

/** @param {string} demo @returns {string} all that it is written in */
function codeOf(demo) {
  const [file, folder] = [`studio/course/${demo}.py`, `studio/course/${demo.split("_")[0]}/`];
  const inFolder = existsSync(new URL(folder, ROOT)) ? readdirSync(new URL(folder, ROOT)) : [];
  const files = inFolder.filter((name) => name.endsWith(".py")).map((name) => folder + name);
  return [file, ...files]
    .filter((one) => existsSync(new URL(one, ROOT)))
    .map(textOf)
    .join("\n");
}

/** @param {import("../../frontend_assets/model/lessons.js").LessonBlock} block */
const partsOfBlock = (block) => (block.kind === "checks" ? [] : partsOf(block));

/** @param {import("../../frontend_assets/model/lessons.js").LessonBlock} block @returns {string[]} names of ROS in its checks */
const checkedIn = (block) =>
  block.kind === "checks" ? block.lines.flatMap((line) => line.match(/(?<= )\/\w+/g) ?? []) : [];

/** @param {Part} part @returns {boolean} it leads somewhere, or is drawn */
function isKnown(part) {
  if (part.kind === "link") return leadsSomewhere(part);
  if (part.kind === "icon") return ICON_NAMES.includes(part.text);
  // What the reader did not understand would be shown as it was written.
  return part.kind !== "text" || !/\*\*|\]\(|\{|`|^#|!\[/.test(part.text);
}

/** @param {Extract<Part, {kind: "link"}>} link */
function leadsSomewhere({ page, about: [name, ...more] }) {
  const words = name === undefined ? 0 : 1 + more.length;
  if (page === "open")
    return existsSync(new URL(`models/${name}/package.xml`, ROOT)) && more.every(isArgument);
  const isThere = page !== "lessons" || name === undefined || NAMES.includes(name);
  return isThere && PANELS.includes(page) && (ABOUT[page] ?? [0]).includes(words);
}

/** @param {string} word */
const isArgument = (word) => /^\w+:=\S+$/.test(word);

/** @param {Part} part @returns {string} the first part of a name of ROS; empty: it is none */
const rosName = ({ kind, text }) => (kind === "code" && /^\/[a-z]\w*/.exec(text)?.[0]) || "";

test("the demos, the exercises and the panels are found", () => {
  assert.ok(DEMOS.length >= 38 && EXERCISES.length >= 5 && PANELS.includes("lessons"));
});

test("every demo and exercise has a lesson in each language, and they need the same others", () => {
  for (const language of ["en", "de"]) {
    const files = readdirSync(new URL(`frontend_assets/lessons/${language}/`, ROOT));
    assert.deepEqual(files.sort(), NAMES.map((name) => `${name}.md`).sort());
  }
  for (const name of NAMES) {
    const [english, german] = [lessonOf("en", name), lessonOf("de", name)];
    assert.ok(english.title && german.title && english.title !== name, name);
    assert.deepEqual(english.needs, german.needs, name);
    assert.ok(
      english.needs.every((needed) => needed !== name && DEMOS.includes(needed)),
      name,
    );
  }
});

for (const language of ["en", "de"]) {
  test(`links, icons and marks of the lessons in ${language} are known`, () => {
    for (const name of NAMES)
      for (const part of lessonOf(language, name).blocks.flatMap(partsOfBlock))
        assert.ok(isKnown(part), `${language}/${name}: ${part.text}`);
  });

  test(`names of ROS in the lessons in ${language} are those of the demos`, () => {
    for (const lesson of NAMES) {
      const { needs, blocks } = lessonOf(language, lesson);
      const parts = blocks.flatMap(partsOfBlock);
      const linked = parts.flatMap((part) => (part.kind === "link" ? part.about : []));
      const code = [lesson, ...needs, ...linked].map(codeOf).join("\n");
      const own = EXERCISES.includes(lesson) ? blocks.flatMap(checkedIn) : [];
      for (const name of parts.map(rosName).filter(Boolean))
        assert.ok(
          [...EVERYWHERE, ...NODES, ...own].includes(name) || code.includes(name.slice(1)),
          `${language}/${lesson}: ${name} is not in its code`,
        );
    }
  });
}
