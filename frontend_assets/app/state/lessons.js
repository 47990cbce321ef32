/** The lessons: which demos there are and run, asked while somebody looks, and which one is read. */

/** @import { CodeFile, DemoView, LessonView } from "../../types/wire.d.ts" */
/** @import { Output } from "../../lib/demo-output.js" */
/** @import { Lesson } from "../../lib/lesson-text.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { NOTHING_PRINTED, withPrinted } from "../../lib/demo-output.js";
import { remembered } from "../../lib/remembered.js";
import { session } from "./connection.js";
import { polled } from "./polling.js";
import { askOrKeepWhy } from "./refusals.js";

const EVERY_MS = 500;

/** In the order in which they are taught. @type {Signal<readonly LessonView[] | null>} null: not told yet */
export const lessons = signal(null);
/** Those that were started from a page, by name. @type {Signal<ReadonlyMap<string, DemoView>>} */
export const demos = signal(new Map());
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

/** The demo whose output is asked for; empty: none is. */
let heard = "";

const UNDER_WAY = ["starting", "running", "stopping"];
/** @param {string} demo @returns {boolean} it was started from a page, and has not ended */
export const isUnderWay = (demo) => UNDER_WAY.includes(demos.value.get(demo)?.state ?? "");
/** Those that were started from a page, and have not ended. */
export const underWay = computed(() => [...demos.value.keys()].filter(isUnderWay));

/** Keep them true while somebody looks; gives the end of looking. */
export const followLessons = polled(askLessons, EVERY_MS);

/** Ask how all of it stands. */
export async function askLessons() {
  if (lessons.value === null) {
    const told = await askOrKeepWhy({ type: "get_lessons" }, lessonsRefused);
    if (told?.type === "lessons") lessons.value = told.lessons;
  }
  const told = await askOrKeepWhy({ type: "get_demos" }, lessonsRefused);
  if (told?.type === "demos") {
    demos.value = new Map(told.demos.map((one) => [one.demo, one]));
    elsewhere.value = told.elsewhere;
  }
  await askOutput();
}

async function askOutput() {
  const [demo, known] = [heard, output.peek()];
  if (!demos.peek().has(demo)) return;
  const { run, last: after } = known;
  const told = await askOrKeepWhy({ type: "get_demo_output", demo, run, after }, lessonsRefused);
  // Another question was quicker, or another demo is looked at.
  if (told?.type !== "demo_output" || output.peek() !== known) return;
  output.value = withPrinted(known, told);
}

/** Have what a demo prints be told. @param {string} demo empty: of none */
export function showOutput(demo) {
  if (heard === demo) return;
  heard = demo;
  output.value = { ...NOTHING_PRINTED };
}

// A studio that was started anew has other runs, and may have other demos.
effect(() => {
  session.value;
  lessons.value = null;
  output.value = NOTHING_PRINTED;
});
