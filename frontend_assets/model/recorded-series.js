/**
 * Numbers over a recording, as few as a picture can show: asked of the studio for what is seen, a
 * coarse picture at first, until every message was read.
 */

/** @import { Range } from "../lib/timeline.js" */
/** @import { Series } from "./plotting.js" */
/** @import { Series as Told } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal, untracked } from "vendor/preact.js";
import { address } from "../lib/address.js";
import { latestSender } from "../lib/latest.js";
import { connection, documentId } from "./connection.js";
import { columnTimes, GAP_S, keyOf } from "./plotting.js";
import { isBag, isPast, recordingKey, seenRange, timeZoom, wholeTime } from "./time.js";
import { send } from "./wire.js";

/** @typedef {Pick<Told, "first" | "second" | "before" | "after" | "exact" | "done" | "count" | "trouble">} Answer */
/** @typedef {{recording: string, range: Range, columns: number, answers: ReadonlyMap<string, Answer>}} Picture what was answered for one range, by line */
/** @typedef {{recording: string, range: Range, columns: number, lines: readonly Series[]}} Wish */

/** What can be drawn; null: nothing was answered yet. @type {Signal<Picture | null>} */
export const recordedPicture = signal(null);
/** How wide the picture is, px; 0: nobody looks. */
export const recordedColumns = signal(0);

const COLUMNS_MAX = 4000;
const AGAIN_MS = 250;
const RETRY_MS = 1000;
/** So often no answer came. */
const failures = signal(0);
/** Of the last minutes, which go on: an end that moved by less is the same picture. */
const MOVED_SHARE = 0.02;
/** So many times as far apart as messages mostly are, there is a gap. */
const GAP_PERIODS = 4;

/**
 * @param {Wish} wish
 * @returns {Promise<void>} when all lines are answered: they are drawn over the same times
 */
async function askFor({ recording, range, columns, lines }) {
  const asked = lines.map((one) =>
    send({
      ...{ type: "get_series", topic: one.topic, path: one.path, columns },
      ...{ begin_s: range.from_s, end_s: range.to_s },
    }),
  );
  const answers = new Map();
  try {
    (await Promise.all(asked)).forEach((answer, n) => {
      const line = lines[n];
      if (line && answer.type === "series") answers.set(keyOf(line), answer);
    });
  } catch {
    // The recording was closed, or too much was asked: it is asked again in a moment.
    setTimeout(() => {
      failures.value += 1;
    }, RETRY_MS);
    return;
  }
  if (recordingKey.peek() === recording)
    recordedPicture.value = { recording, range, columns, answers };
}

const asker = latestSender(askFor);

/** @param {Picture | null} picture @param {Wish} wish @param {boolean} goesOn its end moves by itself @returns {boolean} it shows all that is wished */
export function shows(picture, wish, goesOn) {
  if (picture?.recording !== wish.recording || picture.columns !== wish.columns) return false;
  if (picture.answers.size !== wish.lines.length) return false;
  if (wish.lines.some((one) => !picture.answers.get(keyOf(one))?.exact)) return false;
  const width_s = wish.range.to_s - wish.range.from_s;
  const apart_s =
    Math.abs(picture.range.from_s - wish.range.from_s) +
    Math.abs(picture.range.to_s - wish.range.to_s);
  return apart_s <= (goesOn ? MOVED_SHARE * width_s : 0);
}

/** Have the lines asked for while somebody looks. @param {readonly Series[]} lines @returns {() => void} the end of it */
export function followRecorded(lines) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @returns {Wish} */
  const wishNow = () => ({
    recording: recordingKey.value,
    range: seenRange.value,
    columns: Math.min(COLUMNS_MAX, recordedColumns.value),
    lines,
  });
  const soon = () => {
    timer ??= setTimeout(() => {
      timer = undefined;
      asker.push(untracked(wishNow));
    }, AGAIN_MS);
  };
  const forget = effect(() => {
    failures.value;
    const wish = wishNow();
    const picture = recordedPicture.value;
    const goesOn = !isBag.value && timeZoom.value === null;
    if (!isPast.value || connection.value !== "connected" || wish.columns === 0) return;
    if (lines.length === 0 || shows(picture, wish, goesOn)) return;
    if (isAnswered(picture, wish) || (goesOn && picture)) soon();
    else asker.push(wish);
  });
  return () => {
    clearTimeout(timer);
    forget();
  };
}

/** @param {Picture | null} picture @param {Wish} wish @returns {boolean} it is the answer, which is not exact yet */
const isAnswered = (picture, wish) =>
  picture?.recording === wish.recording &&
  picture.columns === wish.columns &&
  picture.range.from_s === wish.range.from_s &&
  picture.range.to_s === wish.range.to_s &&
  picture.answers.size === wish.lines.length &&
  wish.lines.every((one) => picture.answers.has(keyOf(one)));

effect(() => {
  recordingKey.value;
  recordedPicture.value = null;
});

/**
 * The lines of a picture over the same times: two for each column, and what is next to the range.
 *
 * @param {Picture} picture @param {readonly Series[]} lines
 * @param {number} whole_s how long the recording is
 * @returns {{times: number[], values: (number | null | undefined)[][]}} undefined: nothing came there, null: there is a gap
 */
export function drawnOf({ range, columns, answers }, lines, whole_s) {
  const all = lines.map((one) => answers.get(keyOf(one)));
  const outside = (/** @type {"before" | "after"} */ side) =>
    [...new Set(all.flatMap((one) => (one?.[side] ? [one[side][0]] : [])))].sort((a, b) => a - b);
  const before = outside("before");
  const after = outside("after");
  const times = [...before, ...columnTimes(columns, range.from_s, range.to_s), ...after];
  const width_s = (range.to_s - range.from_s) / columns;
  const values = all.map((one) => {
    if (!one) return new Array(times.length).fill(undefined);
    const gap_s = one.exact
      ? Math.max(GAP_S, (GAP_PERIODS * whole_s) / Math.max(one.count, 1))
      : Number.POSITIVE_INFINITY;
    return [
      ...before.map((time_s) => valueBeside(one.before, time_s)),
      ...withGaps(one, width_s, gap_s),
      ...after.map((time_s) => valueBeside(one.after, time_s)),
    ];
  });
  return { times, values };
}

/** @param {readonly [number, number] | readonly number[] | null} sample @param {number} time_s */
const valueBeside = (sample, time_s) => (sample?.[0] === time_s ? sample[1] : undefined);

/** @param {Answer} answer @param {number} width_s of a column @param {number} gap_s @returns {(number | null | undefined)[]} */
function withGaps({ first, second }, width_s, gap_s) {
  /** @type {(number | null | undefined)[]} */
  const drawn = new Array(first.length * 2).fill(undefined);
  let last = -1;
  first.forEach((value, n) => {
    if (value === null) return;
    if (n - last > 1 && (n - last - 1) * width_s > gap_s) drawn[n * 2 - 1] = null;
    last = n;
    drawn[n * 2] = value;
    drawn[n * 2 + 1] = second[n] ?? value;
  });
  if (last >= 0 && (first.length - 1 - last) * width_s > gap_s) drawn[last * 2 + 2] = null;
  return drawn;
}

/**
 * What a line's last message until then holds, as near as the picture tells: it came in the column
 * of then, perhaps, or in the last one before it that has any.
 *
 * @param {Picture | null} picture @param {string} key of a line @param {number} at_s
 * @returns {readonly [number, number] | null} the least and the largest that it can be; null: there is none
 */
export function valuesAt(picture, key, at_s) {
  const answer = picture?.answers.get(key);
  if (!picture || !answer) return null;
  const { range, columns } = picture;
  const share = (at_s - range.from_s) / (range.to_s - range.from_s || 1);
  const column = Math.min(columns - 1, Math.floor(share * columns));
  const earlier = answer.first.slice(0, Math.max(column, 0)).findLastIndex((one) => one !== null);
  const found = [answer.first[column], answer.second[column]];
  if (earlier >= 0) found.push(answer.first[earlier], answer.second[earlier]);
  else found.push(answer.before?.[1]);
  const told = found.flatMap((one) => one ?? []);
  return told.length > 0 ? [Math.min(...told), Math.max(...told)] : null;
}

/** @param {Picture | null} picture @returns {number | null} the share that was read, of the line that has least; null: all was */
export function coarseShare(picture) {
  const open = [...(picture?.answers.values() ?? [])].filter(({ exact }) => !exact);
  return open.length > 0 ? Math.min(...open.map(({ done }) => done)) : null;
}

/** @param {Picture | null} picture @param {readonly Series[]} lines @returns {string} where their table is given out; empty: it is not, yet */
export function tableAddress(picture, lines) {
  const told = lines.filter((one) => picture?.answers.get(keyOf(one))?.trouble === "");
  if (told.length === 0 || coarseShare(picture) !== null) return "";
  const query = new URLSearchParams();
  for (const { topic, path } of told) {
    query.append("topic", topic);
    query.append("path", path);
  }
  const id = encodeURIComponent(documentId.value);
  return address(`/api/documents/${id}/export/series?${query}`);
}

/** @returns {number} how long the recording is, s */
export const wholeLength = () => wholeTime.value.to_s - wholeTime.value.from_s;
