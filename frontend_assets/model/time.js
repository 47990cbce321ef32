/**
 * The time that the document shows: now, a moment of the last minutes, or one of a bag; its
 * topics, marks, ticks and bookmarks, and what can be asked of it. All seconds count from
 * `zero_s` of the state.
 */

/** @import { Bookmark, RecordedTopicView, TimeState, TimeTick } from "../types/wire.d.ts" */
/** @import { Range } from "../lib/timeline.js" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, effect, signal, untracked } from "vendor/preact.js";
import { latestSender } from "../lib/latest.js";
import { clamp } from "../lib/numbers.js";
import { remembered } from "../lib/remembered.js";
import { countedOn, followedTime, seenTime } from "../lib/timeline.js";
import { keepAsking, sharedFollowing } from "./asking.js";
import { connection, documentId, mayEdit } from "./connection.js";
import { ask } from "./requests.js";
import { ros } from "./ros.js";
import { send, subscribe } from "./wire.js";

/** As it was told last; null: not yet. @type {Signal<TimeState | null>} */
export const timeState = signal(null);
/** The topics of what is shown. @type {Signal<readonly RecordedTopicView[]>} */
export const timeTopics = signal([]);
/** @type {Signal<readonly Bookmark[]>} */
export const bookmarks = signal([]);
/** Why bookmarks cannot be kept, in a sentence; else empty. */
export const bookmarkTrouble = signal("");

/** What is shown is no longer now. */
export const isPast = computed(() => (timeState.value?.mode ?? "live") !== "live");
export const isBag = computed(() => timeState.value?.mode === "bag");
/** Only who has control of the document moves its time. */
export const mayMoveTime = computed(() => mayEdit.value && timeState.value !== null);
/** There is a time to be moved: of a bag, or of a system that is listened to. */
export const hasTimeline = computed(() => {
  const state = timeState.value;
  if (!state || documentId.value === "") return false;
  const isKept = state.kept_bytes_max > 0 && ["connected", "lost"].includes(ros.value.state);
  return state.mode !== "live" || isKept;
});
/** Which recording is shown: times of another one mean something else. */
export const recordingKey = computed(() => {
  const state = timeState.value;
  return state ? `${state.mode === "bag" ? state.path : ""} ${state.zero_s}` : "";
});

/** When the state came, ms as `performance.now` has it. */
let told_ms = 0;
/** Counted on from the state; told anew while somebody looks. */
const counted = signal({ now_s: 0, end_s: 0 });
/** Where it is dragged to; null: nobody drags. @type {Signal<number | null>} */
const held_s = signal(null);
/** The time that is shown, s. */
export const now_s = computed(() => held_s.value ?? counted.value.now_s);
/** All that there is of it. @type {import("vendor/preact.js").ReadonlySignal<Range>} */
export const wholeTime = computed(() => ({
  from_s: timeState.value?.begin_s ?? 0,
  to_s: counted.value.end_s,
}));
/** What is seen of it; null: the whole. @type {Signal<Range | null>} */
export const timeZoom = signal(null);
export const seenRange = computed(() => seenTime(timeZoom.value, wholeTime.value));

subscribe("time_state", (event) => {
  told_ms = performance.now();
  batch(() => {
    timeState.value = event;
    count();
  });
});
subscribe("time_topics", (event) => {
  timeTopics.value = event.topics;
});
subscribe("bookmarks", (event) => {
  bookmarks.value = event.bookmarks;
  bookmarkTrouble.value = event.trouble;
});

function count() {
  const state = timeState.peek();
  if (!state) return;
  const now = countedOn(state, (performance.now() - told_ms) / 1000);
  const before = counted.peek();
  if (now.now_s !== before.now_s || now.end_s !== before.end_s) counted.value = now;
  const range = timeZoom.peek();
  if (range && held_s.peek() === null && state.playing && state.mode !== "live")
    timeZoom.value = followedTime(range, now.now_s, wholeTime.peek());
}

/** What does not play moves by the second. */
const SLOWLY_MS = 1000;

/** Have the time counted on while somebody looks; gives the end of looking. */
export const followNow = sharedFollowing(() => {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  let drawing = 0;
  const stop = () => {
    clearTimeout(timer);
    cancelAnimationFrame(drawing);
  };
  const look = () => {
    count();
    const state = timeState.peek();
    if (state && state.mode !== "live" && state.playing) drawing = requestAnimationFrame(look);
    else timer = setTimeout(look, SLOWLY_MS);
  };
  // Whoever presses play does not wait for the next second.
  const forget = effect(() => {
    timeState.value;
    stop();
    timer = setTimeout(look, 0);
  });
  return () => {
    stop();
    forget();
  };
});

/** @type {ReturnType<typeof latestSender<{at_s: number, settled: boolean}>>} */
const seeker = latestSender((wanted) => ask({ type: "seek_time", ...wanted }));

/** @param {number} at_s while it is dragged: of several the newest counts */
export function dragTime(at_s) {
  held_s.value = inWhole(at_s);
  seeker.push({ at_s: held_s.value, settled: false });
}

/** @param {number} at_s and there it stays @returns {Promise<void>} */
export async function seekTime(at_s) {
  const wanted_s = inWhole(at_s);
  const before = timeState.peek();
  held_s.value = wanted_s;
  seeker.push({ at_s: wanted_s, settled: true });
  await seeker.settled();
  if (held_s.peek() !== wanted_s) return;
  batch(() => {
    // What the studio told since is newer.
    if (timeState.peek() === before) counted.value = { ...counted.peek(), now_s: wanted_s };
    held_s.value = null;
  });
}

/** @param {number} at_s @returns {number} */
const inWhole = (at_s) => clamp(at_s, wholeTime.peek().from_s, wholeTime.peek().to_s);

export const openBag = (
  /** @type {string} */ path,
  /** @type {{document?: string}} */ where = {},
) => ask({ type: "open_bag", path, ...where });
export const goLive = () => ask({ type: "go_live" });
/** @param {boolean} playing */
export const playTime = (playing) => ask({ type: "play_time", playing });
/** @param {number} rate */
export const setTimeRate = (rate) => ask({ type: "set_time_rate", rate });
/** @param {boolean} forward to the next message of the chosen topic, or to the one before */
export async function stepTime(forward) {
  await seeker.settled();
  return ask({ type: "step_time", topic: markTopic.peek(), forward });
}
/** @param {Range | null} range null: the whole, once */
export const loopTime = (range) =>
  ask({ type: "loop_time", begin_s: range?.from_s ?? null, end_s: range?.to_s ?? null });

/** @param {boolean} atBegin the begin of the loop, else its end, is now */
export function loopFromNow(atBegin) {
  const [begin, end] = timeState.peek()?.loop ?? [];
  const whole = wholeTime.peek();
  const at_s = now_s.peek();
  const range = atBegin
    ? { from_s: at_s, to_s: end !== undefined && end > at_s ? end : whole.to_s }
    : { from_s: begin !== undefined && begin < at_s ? begin : whole.from_s, to_s: at_s };
  return range.to_s > range.from_s ? loopTime(range) : null;
}

/** @param {readonly Bookmark[]} kept these and no others */
export const setBookmarks = (kept) =>
  ask({ type: "set_bookmarks", bookmarks: kept.toSorted((a, b) => a.at_s - b.at_s) });
/** @param {string} name of this moment */
export const addBookmark = (name) =>
  setBookmarks([...bookmarks.peek(), { at_s: now_s.peek(), name }]);
/** @param {Bookmark} one */
export const removeBookmark = (one) =>
  setBookmarks(bookmarks.peek().filter((other) => other !== one));
/** @param {Bookmark} one @param {string} name */
export const renameBookmark = (one, name) =>
  setBookmarks(bookmarks.peek().map((other) => (other === one ? { ...one, name } : other)));

/** The topic whose messages are marked and stepped through; empty: all together. */
export const markTopic = signal("");
/** Messages in each part of a range. @type {Signal<{topic: string, range: Range, counts: readonly number[]} | null>} */
export const timeMarks = signal(null);

/** @type {ReturnType<typeof latestSender<{topic: string, range: Range, bins: number}>>} */
const marker = latestSender(async ({ topic, range, bins }) => {
  const answer = await send({
    ...{ type: "get_time_marks", topic, bins },
    ...{ begin_s: range.from_s, end_s: range.to_s },
  });
  if (answer.type === "time_marks") timeMarks.value = { topic, range, counts: answer.counts };
});

/** @param {Range} range @param {number} bins parts of it */
export function askMarks(range, bins) {
  if (connection.peek() === "connected")
    marker.push({ topic: markTopic.peek(), range, bins: clamp(Math.round(bins), 1, BINS_MAX) });
}

const BINS_MAX = 4000;
const TICKS_EVERY_MS = 3000;
const TICKS_SOON_MS = 400;

/** Errors and warnings in what is shown; `done`: the share that was read. @type {Signal<{ticks: readonly TimeTick[], more: number, done: number}>} */
export const timeTicks = signal({ ticks: [], more: 0, done: 0 });

/** Have them told while somebody looks: of a bag until it is read, else again and again. */
export const followTicks = sharedFollowing(() => {
  let end = () => {};
  const forget = effect(() => {
    end();
    end = () => {};
    if (recordingKey.value === "" || connection.value !== "connected") return;
    untracked(() => {
      end = keepAsking(askTicks, TICKS_SOON_MS);
    });
  });
  return () => {
    forget();
    end();
  };
});
let ticks_ms = 0;

async function askTicks() {
  const isRead = timeTicks.peek().done >= 1;
  if (
    document.hidden ||
    (isRead && (isBag.peek() || performance.now() - ticks_ms < TICKS_EVERY_MS))
  )
    return false;
  try {
    const answer = await send({ type: "get_time_ticks" });
    ticks_ms = performance.now();
    if (answer.type === "time_ticks") timeTicks.value = answer;
  } catch {
    // It is asked again in a moment; what is in the way says itself elsewhere.
  }
  return false;
}

effect(() => {
  recordingKey.value;
  untracked(() =>
    batch(() => {
      timeZoom.value = null;
      timeMarks.value = null;
      timeTicks.value = { ticks: [], more: 0, done: 0 };
      if (!timeTopics.peek().some(({ name }) => name === markTopic.peek())) markTopic.value = "";
    }),
  );
});

/** Whether the bar of a live system is shown with all that belongs to it. */
export const expandsTimeline = remembered("timeline.expanded", false);
