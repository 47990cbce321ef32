/**
 * The lessons: one page about each demo, in `lessons/<language>/<name of the demo>.md`.
 *
 * A lesson file begins with its title, `# A publisher that counts` (a few words, no full stop), alone
 * on its line. The next line may say which demos it wants beside its own, by their names and in the
 * order in which they are started: `needs: listener` or `needs: jerry_robot jerry_client`; it is the
 * same in every language. An empty line, then the text in the markup of `lib/help-text.js`: blocks
 * between empty lines; `## Heading`, lists of `- entries` (an entry may go on in the next line), all
 * else paragraphs; in them `**name of a control**`, code in backticks, `{key Mod+K}`, `{icon eye}`.
 * No pictures, no HTML, no numbered lists. Lines `check: node /talker runs` that follow each other are a
 * step, which turns green by itself: `studio/course/lessons/checks.py` has the forms. They are the same
 * in every language.
 *
 * Links open panels, by the id that stands in `app/panels.js`, and may say what is shown there:
 *   `[words](topics)`  `[words](graph)`  any panel
 *   `[words](topics /chatter)`  that topic, opened
 *   `[words](parameters /turtlesim)`  that node's parameters
 *   `[words](services /spawn turtlesim/srv/Spawn)`  the form of that service; its type is needed
 *   `[words](actions /fibonacci example_interfaces/action/Fibonacci)`, `[words](publish /cmd_vel
 *   geometry_msgs/msg/Twist)`  likewise
 *   `[words](lessons listener)`  another lesson
 *   `[words](open r2d2_description stands:=false)`  a robot that comes with the studio, with its arguments
 *
 * Names of topics, services, actions and nodes stand in backticks with their slash, as `/chatter`:
 * a test looks whether the demo's code, or that of one which it needs, has them.
 */

/** @import { CodeFile, Command, DemoOutput, DemoView, LessonView, PressKey } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Asked } from "./wire.js" */
/** @import { MessageForm } from "./message-forms.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { readHelp, textFiles } from "../lib/help-text.js";
import { remembered } from "../lib/remembered.js";
import { askedWhenChanged, askOrKeepWhy, changeCount } from "./asking.js";
import { session } from "./connection.js";
import { goalForm, publishForm, serviceForm } from "./message-forms.js";
import { chooseNode } from "./parameters.js";
import { ask, openNamed } from "./requests.js";
import { chosenTopic } from "./topics.js";
import { layoutControl } from "./view.js";

/** As many lines as the studio keeps. */
const LINES_MAX = 200;

/** @typedef {Pick<DemoOutput, "run" | "lines" | "last">} Output */
/** @type {Output} */
export const NOTHING_PRINTED = { run: 0, lines: [], last: 0 };

/** @param {Output} known @param {Output} answer since then; of another run it takes the place of all @returns {Output} */
export function withPrinted(known, answer) {
  if (answer.run !== known.run) return answer;
  if (answer.lines.length === 0) return known;
  return { ...answer, lines: [...known.lines, ...answer.lines].slice(-LINES_MAX) };
}

/** In the order in which they are taught. @type {Signal<readonly LessonView[] | null>} null: not known yet */
export const lessons = signal(null);
/** Those that were started from a page, by name. @type {Signal<ReadonlyMap<string, DemoView>>} */
export const demos = signal(new Map());
/** When that was told, ms as `performance.now` has it. */
export const demosToldAt_ms = signal(0);
/** Those that somebody else started. @type {Signal<readonly string[]>} */
export const elsewhere = signal([]);
export const lessonsRefused = signal("");
/** The demo whose lesson is read; empty: none is. */
export const chosenLesson = remembered("lessons.chosen", "");
/** The texts by demo, in the language of the page. @type {Signal<ReadonlyMap<string, Lesson & {text: string}>>} */
export const lessonTexts = signal(new Map());
/** The source code of demos, by name. @type {Signal<ReadonlyMap<string, readonly CodeFile[]>>} */
export const demoCode = signal(new Map());
/** What the demo that is looked at printed. @type {Signal<Output>} */
export const output = signal(NOTHING_PRINTED);

/** How often the list had changed when it was asked for. */
let listedAt = -1;

/** The demo whose output is asked for; empty: none is. */
let heard = "";

const UNDER_WAY = ["starting", "running", "stopping"];
/** @param {string} demo @returns {boolean} it was started from a page, and has not ended */
export const isUnderWay = (demo) => UNDER_WAY.includes(demos.value.get(demo)?.state ?? "");
/** Those that were started from a page, and have not ended. */
export const underWay = computed(() => [...demos.value.keys()].filter(isUnderWay));

/** Keep them true while somebody looks; gives the end of looking. */
export const followLessons = askedWhenChanged(askLessons, "lessons", "graph", "lesson_list");

/** Ask how all of it stands. */
export async function askLessons() {
  await askList();
  const answer = await askOrKeepWhy({ type: "get_demos" }, lessonsRefused);
  if (answer?.type === "demos") {
    demosToldAt_ms.value = performance.now();
    demos.value = new Map(answer.demos.map((one) => [one.demo, one]));
    elsewhere.value = answer.elsewhere;
  }
  await askOutput();
}

/** The list, with what is done: once, and whenever a lesson was written or deleted. */
async function askList() {
  const told = changeCount("lesson_list");
  if (lessons.peek() !== null && told === listedAt) return;
  const answer = await askOrKeepWhy({ type: "get_lessons" }, lessonsRefused);
  if (answer?.type !== "lessons") return;
  listedAt = told;
  lessons.value = answer.lessons;
}

async function askOutput() {
  const [demo, known] = [heard, output.peek()];
  if (!demos.peek().has(demo)) return;
  const { run, last: after } = known;
  const answer = await askOrKeepWhy({ type: "get_demo_output", demo, run, after }, lessonsRefused);
  // Another question was quicker, or another demo is looked at.
  if (answer?.type !== "demo_output" || output.peek() !== known) return;
  output.value = withPrinted(known, answer);
}

/** Have what a demo prints be told. @param {string} demo empty: of none */
export function showOutput(demo) {
  if (heard === demo) return;
  heard = demo;
  output.value = { ...NOTHING_PRINTED };
  void askOutput();
}

// A studio that was started anew has other runs, and may have other demos.
effect(() => {
  session.value;
  lessons.value = null;
  output.value = NOTHING_PRINTED;
});

/** @typedef {{kind: "checks", step: number, lines: readonly string[]}} Checks a step, by its place among all */
/** @typedef {import("../lib/help-text.js").Block | Checks} LessonBlock */
/** @typedef {{title: string, needs: readonly string[], blocks: readonly LessonBlock[]}} Lesson */

/** Lines of checks, which stand by themselves. */
const STEP = /^(?:[ \t]*check:.*(?:\n|$))+/gm;
const HEAD = /^# (.+)\n(?:needs:(.*)\n)?/;

/** @param {string} text @returns {Lesson} */
export function readLesson(text) {
  const [head = "", title = "", needs = ""] = HEAD.exec(text) ?? [];
  return {
    title: title.trim(),
    needs: needs.split(" ").filter(Boolean),
    blocks: readBlocks(text.slice(head.length)),
  };
}

/** @param {string} text @returns {LessonBlock[]} */
function readBlocks(text) {
  /** @type {LessonBlock[]} */
  const blocks = [];
  let at = 0;
  let step = 0;
  for (const match of text.matchAll(STEP)) {
    blocks.push(...readHelp(text.slice(at, match.index)));
    const lines = match[0].trim().split("\n");
    blocks.push({
      kind: "checks",
      step,
      lines: lines.map((line) => line.trim().slice("check:".length).trim()),
    });
    step += 1;
    at = match.index + match[0].length;
  }
  return [...blocks, ...readHelp(text.slice(at))];
}

/**
 * @param {string} words what is sought
 * @param {{name: string, node: string}} named
 * @param {string} text of its lesson
 * @returns {boolean} each of the words is somewhere in it
 */
export function isSought(words, { name, node }, text) {
  const all = `${name} ${node} ${text}`.toLowerCase();
  return words
    .toLowerCase()
    .split(/\s+/)
    .every((word) => all.includes(word));
}

const known = textFiles(new URL("../lessons/", import.meta.url).href, (text) => ({
  ...readLesson(text),
  text,
}));

/** Of what is asked for at the same time, the newest counts. */
let fetches = 0;

/** Have the texts of some lessons in a language. @param {string} language @param {readonly LessonView[]} wanted */
export async function fetchLessons(language, wanted) {
  fetches += 1;
  const fetch = fetches;
  const texts = await Promise.all(
    wanted.map((lesson) =>
      lesson.own ? ownText(lesson, language) : known(`${language}/${lesson.name}.md`),
    ),
  );
  if (fetch !== fetches) return;
  lessonTexts.value = new Map(texts.map((text, at) => [wanted[at]?.name ?? "", text]));
}

/** Texts that are none of the course's, by name: fetched once, until they are written anew. @type {Map<string, {of: string, text: Lesson & {text: string}}>} */
const ownTexts = new Map();

/** @param {LessonView} lesson one that is none of the course @param {string} language */
async function ownText({ name, version }, language) {
  const of = `${language} ${version}`;
  const kept = ownTexts.get(name);
  if (kept?.of === of) return kept.text;
  const command = /** @type {const} */ ({ type: "get_lesson_text", lesson: name });
  const answer = await askOrKeepWhy({ ...command, language }, lessonsRefused);
  if (answer?.type !== "lesson_text") return kept?.text ?? { ...readLesson(""), text: "" };
  const text = { ...readLesson(answer.text), text: answer.text };
  ownTexts.set(name, { of, text });
  return text;
}

/** Have the code of a demo, once. @param {string} demo */
export async function fetchCode(demo) {
  if (demoCode.peek().has(demo)) return;
  const answer = await ask({ type: "get_demo_code", demo });
  if (answer?.type === "demo_code")
    demoCode.value = new Map(demoCode.peek()).set(demo, answer.files);
}

/** @param {Asked<Command>} command and look what became of it */
async function askAndRefresh(command) {
  await ask(command);
  await askLessons();
}

/** Start demos one after the other, until one is refused. @param {readonly string[]} demos */
export async function startDemos(demos) {
  for (const demo of demos) if (!(await ask({ type: "start_demo", demo }))) break;
  await askLessons();
}

/** @param {string} demo */
export const stopDemo = (demo) => askAndRefresh({ type: "stop_demo", demo });

/** All that run. */
export async function stopAllDemos() {
  await Promise.all(underWay.peek().map((demo) => ask({ type: "stop_demo", demo })));
  await askLessons();
}

/** @param {string} demo @param {PressKey["pressed"]} pressed */
export const pressKey = (demo, pressed) => ask({ type: "press_key", demo, pressed });

/** @type {Record<string, MessageForm>} */
const FORMS = { services: serviceForm, actions: goalForm, publish: publishForm };

/** Where a link of a lesson leads, with the lesson kept in sight. @param {string} panel @param {readonly string[]} about a name, and perhaps its type */
export function followLink(panel, [name = "", type = "", ...more]) {
  if (panel === "open") {
    void openNamed({ type: "open_example", name, arguments: argumentsOf([type, ...more]) });
    return;
  }
  if (name !== "" && panel === "lessons") chosenLesson.value = name;
  if (name !== "" && panel === "topics") chosenTopic.value = name;
  if (name !== "" && panel === "parameters") chooseNode(name);
  if (type !== "") void FORMS[panel]?.open({ name, type });
  layoutControl.value?.showBeside(panel, "lessons");
}

/** @param {readonly string[]} words each `name:=value` @returns {Record<string, string>} */
const argumentsOf = (words) =>
  Object.fromEntries(words.filter(Boolean).map((word) => word.split(/:=(.*)/s).slice(0, 2)));
