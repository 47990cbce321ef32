/** The steps of the lesson that is read: how their checks stand, and for a teacher who has done them. */

/** @import { LessonTable, LessonState, StepView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { csvCell } from "../lib/csv.js";
import { askedWhenChanged, askOrKeepWhy } from "./asking.js";
import { leads } from "./class.js";
import { connection, documentId } from "./connection.js";
import { chosenLesson, lessons } from "./lessons.js";
import { ask } from "./requests.js";
import { activePanel } from "./view.js";
import { send, subscribe } from "./wire.js";

/** As the studio told it last. @type {Signal<LessonState | null>} */
const told = signal(null);
/** A page that never showed lessons asks nothing of one that was read another day. */
const isReading = signal(false);

/** The steps of the chosen lesson, in the order of its text; none until the studio told. */
export const steps = computed(() =>
  told.value?.lesson === chosenLesson.value ? told.value.steps : [],
);
export const doneCount = computed(() => steps.value.filter(isDone).length);

/** @param {StepView} step */
export const isDone = ({ done_s: done }) => typeof done === "number";

/** The chosen lesson is read now: what it checks is looked at from now on, whatever else is opened. */
export function readOn() {
  isReading.value = true;
}

subscribe("lesson_state", (event) => {
  told.value = event;
  const done = event.steps.filter(isDone).length;
  const all = lessons.peek();
  if (all?.some((one) => one.name === event.lesson && one.done !== done))
    lessons.value = all.map((one) => (one.name === event.lesson ? { ...one, done } : one));
});

/** The lesson that is looked at in the studio; empty: none is, or it has no steps. */
const wanted = computed(() => {
  const listed = lessons.value?.find(({ name }) => name === chosenLesson.value);
  const mayHave = lessons.value === null || (listed?.steps ?? 0) > 0;
  return isReading.value && connection.value === "connected" && mayHave ? chosenLesson.value : "";
});
let isOpen = false;

effect(() => {
  const lesson = wanted.value;
  documentId.value; // another robot is checked
  if (lesson) send({ type: "open_lesson", lesson }).catch(() => null);
  else if (isOpen && connection.peek() === "connected")
    send({ type: "close_lesson" }).catch(() => null);
  isOpen = lesson !== "";
});

/** Panels that the lesson asks about. */
const asked = computed(
  () =>
    new Set(
      steps.value
        .flatMap(({ checks }) => checks)
        .filter(({ kind, ok }) => kind === "opened" && !ok)
        .map(({ values }) => values.panel),
    ),
);
/** Panels that were opened since the lesson was, also before the studio told what it asks about. */
const seen = new Set();
effect(() => {
  chosenLesson.value;
  seen.clear();
});
effect(() => {
  const panel = activePanel.value;
  if (panel) seen.add(panel);
  for (const one of asked.value)
    if (one && seen.has(one))
      untracked(() => send({ type: "saw_panel", panel: one }).catch(() => null));
});

/** Who has done which step of the chosen lesson, while a teacher looks. @type {Signal<LessonTable | null>} */
export const table = signal(null);
export const tableRefused = signal("");
export const followTable = askedWhenChanged(askTable, "ticks");

async function askTable() {
  const lesson = chosenLesson.peek();
  if (!leads.peek() || !lesson) return;
  const answer = await askOrKeepWhy({ type: "get_lesson_table", lesson }, tableRefused);
  if (answer?.type === "lesson_table") table.value = answer;
}

/**
 * @param {LessonTable} all
 * @param {readonly string[]} head the words above name and steps
 * @returns {string} a table of names by steps: when each was done, ISO 8601; empty: not yet
 */
export function csvOf({ rows }, head) {
  const lines = rows.map(({ name, done_s: done }) =>
    [name, ...done.map((one) => (one == null ? "" : new Date(one * 1000).toISOString()))].map(
      csvCell,
    ),
  );
  return [head.map(csvCell), ...lines].map((line) => `${line.join(",")}\r\n`).join("");
}

/** @param {string} lesson its name @param {string} text @returns {Promise<boolean>} it was written */
export const saveLesson = async (lesson, text) =>
  (await ask({ type: "save_lesson", lesson, text })) !== null;

/** @param {string} lesson */
export const deleteLesson = (lesson) => ask({ type: "delete_lesson", lesson });

/** @param {string} text @returns {Promise<import("../types/wire.d.ts").LessonRead | null>} its faults */
export async function readFaults(text) {
  const answer = await ask({ type: "read_lesson", text });
  return answer?.type === "lesson_read" ? answer : null;
}
