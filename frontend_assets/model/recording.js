/**
 * Bags of the live system: what is recorded and how it goes, the form of the next one by the words
 * of `ros2 bag record`, the bags that there are, the last minutes saved, and parts cut out.
 */

/** @import { Bags, RecordingState, StartRecording } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { sizeWords } from "../lib/timeline.js";
import { askOrKeepWhy } from "./asking.js";
import { mayManage, session } from "./connection.js";
import { openNamed } from "./requests.js";
import { notify } from "./view.js";
import { RefusedError, send, subscribe } from "./wire.js";

/** @typedef {"contents" | "record" | "bags"} BagPart of the panel */

/** @type {Signal<BagPart>} */
export const bagPart = signal("contents");

/** As it was told last; null: not yet. @type {Signal<RecordingState | null>} */
export const recording = signal(null);
/** Bytes in a second of late; 0 while nothing is recorded. */
export const recordedRate = signal(0);
export const isRecording = computed(() => recording.value?.recording ?? false);

subscribe("recording_state", (event) => {
  const before = recording.peek();
  recordedRate.value = rateOf(before, event);
  recording.value = event;
  if (before?.recording && !event.recording) bagCount.value += 1;
});

/** @param {Pick<RecordingState, "recording" | "path" | "seconds" | "bytes"> | null} before @param {Pick<RecordingState, "recording" | "path" | "seconds" | "bytes">} now @returns {number} bytes in a second */
export function rateOf(before, now) {
  if (!now.recording) return 0;
  const isSame = before?.recording === true && before.path === now.path;
  const [bytes, seconds] = isSame ? [before.bytes, before.seconds] : [0, 0];
  return now.seconds > seconds ? Math.max(now.bytes - bytes, 0) / (now.seconds - seconds) : 0;
}

/**
 * @typedef {object} RecordForm what `ros2 bag record` is told
 * @property {"all" | "topics" | "regex"} which
 * @property {readonly string[]} topics
 * @property {string} regex
 * @property {string} exclude a regular expression
 * @property {string} name of the bag's folder; empty: by date and time
 * @property {"mcap" | "sqlite3"} storage
 * @property {"none" | "zstd" | "lz4"} compression
 * @property {number} maxBytes of a file; 0: never another one
 * @property {number} maxSeconds
 */

/** @type {RecordForm} */
const PLAIN = {
  which: "all",
  topics: [],
  regex: "",
  exclude: "",
  name: "",
  storage: "mcap",
  compression: "none",
  maxBytes: 0,
  maxSeconds: 0,
};
/** @type {Signal<RecordForm>} */
export const recordForm = signal(PLAIN);
/** Why it does not begin, in a sentence. */
export const recordTrouble = signal("");

/** @param {Partial<RecordForm>} news */
export function changeForm(news) {
  recordForm.value = { ...recordForm.peek(), ...news };
}

/**
 * Fill the form by the words of a command line, and show it.
 *
 * @param {Partial<Omit<RecordForm, "which">> & {all?: boolean}} line
 */
export function prepareRecording({ all, ...line }) {
  recordForm.value = filledForm({ ...line, all });
  recordTrouble.value = "";
  bagPart.value = "record";
  commandById("panel.bag")?.run();
}

/** @param {Partial<Omit<RecordForm, "which">> & {all?: boolean | undefined}} line @returns {RecordForm} */
export function filledForm({ all, ...line }) {
  const hasTopics = (line.topics ?? []).length > 0;
  const which = all || !(hasTopics || line.regex) ? "all" : line.regex ? "regex" : "topics";
  return { ...PLAIN, ...line, which };
}

/** @param {RecordForm} form @returns {Omit<StartRecording, "request" | "document" | "id">} what is asked of the studio */
export function recordingAsked(form) {
  const { which, topics, regex, exclude, name, storage, compression } = form;
  return {
    type: "start_recording",
    // As ros2 does, a regular expression adds to the topics that are named.
    topics: which === "all" ? [] : [...topics],
    regex: which === "regex" ? regex : "",
    exclude_regex: exclude,
    ...{ name, storage, compression },
    max_bag_bytes: form.maxBytes,
    max_bag_s: form.maxSeconds,
  };
}

/** @param {RecordForm} form @returns {string} key of what is missing in it; empty: it can begin */
export function formFault({ which, topics, regex, name }) {
  if (which === "topics" && topics.length === 0) return "bag.fault.topics";
  if (which === "regex" && regex === "") return "bag.fault.regex";
  return /[/\\]|^\.{1,2}$/.test(name) ? "bag.fault.name" : "";
}

export async function startRecording() {
  recordTrouble.value = await whyNot(() => send(recordingAsked(recordForm.peek())));
}

export async function stopRecording() {
  recordTrouble.value = await whyNot(() => send({ type: "stop_recording" }));
}

/** @param {() => Promise<unknown>} asked @returns {Promise<string>} why the studio refused; empty: it did not */
async function whyNot(asked) {
  try {
    await asked();
    return "";
  } catch (error) {
    return error instanceof RefusedError ? error.message : t("connection.lost");
  }
}

/** The share of a part that is written, 0 to 1; null: none is being written. @type {Signal<number | null>} */
export const writtenShare = signal(null);
subscribe("bag_writing", ({ done }) => {
  writtenShare.value = done;
});

/** The damaged or unfinished bag that is being read, and the share that is, 0 to 1; null: none. @type {Signal<{name: string, done: number} | null>} */
export const openingBag = signal(null);
subscribe("bag_opening", ({ name, done }) => {
  openingBag.value = done === null ? null : { name, done };
});

export const stopWriting = () => void send({ type: "stop_writing" });

/** @param {number} seconds of the live system, as far as they are kept */
export const savePast = (seconds) => write({ type: "save_past", seconds });

/** @param {{from_s: number, to_s: number}} range of what is shown @param {readonly string[]} topics none: all @param {string} name of the bag; empty: by date and time */
export const cutBag = ({ from_s, to_s }, topics, name) =>
  write({ type: "cut_bag", begin_s: from_s, end_s: to_s, topics: [...topics], name });

/** @param {Parameters<typeof send>[0]} command that writes a bag; what became of it is said, with the way to it */
async function write(command) {
  try {
    const answer = await send(command);
    if (answer.type !== "bag_written") return false;
    const { path, messages: count, bytes } = answer;
    bagCount.value += 1;
    const run = () => void openRecorded(path);
    notify(t("bag.written", { name: baseName(path), count, size: sizeWords(bytes) }), {
      ...(mayManage.peek() && { action: { label: t("bag.open"), run } }),
    });
    return true;
  } catch (error) {
    const why = error instanceof RefusedError ? error.message : t("connection.lost");
    notify(why, { bad: true, long: true });
    return false;
  }
}

/** @param {string} path @returns {Promise<boolean>} it is shown as a document of its own */
export const openRecorded = (path) => openNamed({ type: "open_bag", path, document: "" });

/**
 * Open a bag as a command line names it: one of those that are there by its name, else by its path.
 *
 * @param {string} path empty: those that are there are shown
 */
export async function openBagNamed(path) {
  const name = baseName(path.replace(/\/+$/, ""));
  bagPart.value = name ? "contents" : "bags";
  commandById("panel.bag")?.run();
  if (!name) return;
  await askBags();
  const known = bags.peek()?.bags.find((one) => one.name === name || baseName(one.path) === name);
  await openRecorded(known?.path ?? path);
}

/** How many were written since the page is there. */
const bagCount = signal(0);
/** The bags that can be opened; null: not told yet. @type {Signal<Bags | null>} */
export const bags = signal(null);
export const bagsRefused = signal("");

async function askBags() {
  const answer = await askOrKeepWhy({ type: "list_bags" }, bagsRefused);
  if (answer?.type === "bags") bags.value = answer;
}

/** Have them told while somebody looks; gives the end of looking. */
export function followBags() {
  return effect(() => {
    bagCount.value;
    session.value;
    untracked(() => void askBags());
  });
}
