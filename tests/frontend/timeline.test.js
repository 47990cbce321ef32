import assert from "node:assert/strict";
import { test } from "node:test";
import { matches } from "../../frontend_assets/lib/commands.js";
import {
  countedOn,
  followedTime,
  gapsIn,
  nearestTo,
  pannedTime,
  placeOf,
  placesOf,
  rulerSteps,
  seenTime,
  sinceStart,
  sizeWords,
  timeAfterKey,
  timeAt,
  zoomedTime,
} from "../../frontend_assets/lib/timeline.js";

/** @param {Partial<import("../../frontend_assets/lib/timeline.js").Running>} [more] @returns {import("../../frontend_assets/lib/timeline.js").Running} */
const running = (more = {}) => ({
  mode: "bag",
  begin_s: 0,
  end_s: 70,
  now_s: 10,
  playing: true,
  rate: 2,
  loop: null,
  ...more,
});
const WHOLE = { from_s: 0, to_s: 100 };

test("a bag that plays is counted on at its rate, up to its end, and one that rests is not", () => {
  assert.deepEqual(countedOn(running(), 3), { now_s: 16, end_s: 70 });
  assert.deepEqual(countedOn(running(), 3000), { now_s: 70, end_s: 70 });
  assert.deepEqual(countedOn(running({ playing: false }), 3), { now_s: 10, end_s: 70 });
});

test("what is looped begins again, and whoever plays from behind it goes on to the end", () => {
  assert.equal(countedOn(running({ loop: [8, 12] }), 1.5).now_s, 9);
  assert.equal(countedOn(running({ loop: [8, 12], now_s: 60 }), 2).now_s, 64);
  assert.equal(countedOn(running({ loop: [20, 24], now_s: 10 }), 1).now_s, 12);
});

test("while one rewinds, the robot goes on: the end moves, and the past only when it plays", () => {
  const past = running({ mode: "past", rate: 1 });
  assert.deepEqual(countedOn(past, 5), { now_s: 15, end_s: 75 });
  assert.deepEqual(countedOn({ ...past, playing: false }, 5), { now_s: 10, end_s: 75 });
  assert.deepEqual(countedOn({ ...past, mode: "live" }, 5), { now_s: 75, end_s: 75 });
});

test("zooming keeps the time under the pointer, and stays within the whole", () => {
  const near = zoomedTime(WHOLE, 4, 20, WHOLE);
  assert.deepEqual(near, { from_s: 15, to_s: 40 });
  assert.equal(placeOf(20, near, 1000), placeOf(20, WHOLE, 1000));
  assert.deepEqual(zoomedTime(near, 0.01, 20, WHOLE), WHOLE);
  assert.deepEqual(pannedTime(near, 1000, WHOLE), { from_s: 75, to_s: 100 });
  assert.deepEqual(pannedTime(near, -1000, WHOLE), { from_s: 0, to_s: 25 });
});

test("an empty time is as wide that it can be drawn, and a zoom of another recording is clipped", () => {
  const { from_s, to_s } = seenTime(null, { from_s: 5, to_s: 5 });
  assert.ok(from_s === 5 && to_s > 5);
  assert.deepEqual(seenTime({ from_s: 90, to_s: 140 }, WHOLE), { from_s: 50, to_s: 100 });
});

test("what is seen turns over like a page once the time leaves it", () => {
  const seen = { from_s: 10, to_s: 30 };
  assert.equal(followedTime(seen, 20, WHOLE), seen);
  assert.deepEqual(followedTime(seen, 31, WHOLE), { from_s: 31, to_s: 51 });
  assert.deepEqual(followedTime(seen, 95, WHOLE), { from_s: 80, to_s: 100 });
});

test("a place and a time are each other's way back", () => {
  const range = { from_s: -3, to_s: 9 };
  for (const x of [0, 123, 800])
    assert.ok(Math.abs(placeOf(timeAt(x, range, 800), range, 800) - x) < 1e-9);
});

test("the steps of a ruler are round, within it, and far enough apart for their words", () => {
  for (const width_s of [0.02, 3, 70, 4000, 900_000]) {
    const { step_s, times } = rulerSteps({ from_s: 1.5, to_s: 1.5 + width_s }, 900);
    assert.ok(times.length >= 2 && times.length <= 900 / 74 + 1, `${width_s}: ${times.length}`);
    assert.ok((step_s / width_s) * 900 >= 74);
    for (const one of times) assert.ok(one >= 1.5 - 1e-6 && one <= 1.5 + width_s + 1e-6);
  }
  assert.deepEqual([placesOf(0.001), placesOf(0.5), placesOf(1), placesOf(600)], [3, 1, 0, 0]);
});

test("times since the start are written with minutes, hours where there are some, and a sign", () => {
  assert.equal(sinceStart(7.456, 1), "0:07.5");
  assert.equal(sinceStart(59.96, 1), "1:00.0");
  assert.equal(sinceStart(3723), "1:02:03");
  assert.equal(sinceStart(-83.25, 2), "-1:23.25");
  assert.equal(sinceStart(-0.0001, 1), "0:00.0");
});

test("a gap lies between messages and is wide enough to be seen", () => {
  assert.deepEqual(gapsIn([0, 1, 0, 0, 0, 2, 0, 1, 0], 2), [[2, 5]]);
  assert.deepEqual(gapsIn([1, 0, 1], 2), []);
  assert.deepEqual(gapsIn([0, 0, 0], 2), []);
});

test("a click near an error, a warning or a bookmark means it", () => {
  const all = [{ at_s: 1 }, { at_s: 1.4 }, { at_s: 5 }];
  assert.equal(nearestTo(all, 1.3, 0.5), all[1]);
  assert.equal(nearestTo(all, 3, 0.5), null);
});

test("keys lead by a second, ten or a tenth, to the ends, and no farther", () => {
  const key = (/** @type {string} */ name, more = {}) => ({
    ...{ key: name, shiftKey: false, altKey: false, ctrlKey: false, metaKey: false },
    ...more,
  });
  assert.equal(timeAfterKey(key("ArrowRight"), 50, WHOLE), 51);
  assert.equal(timeAfterKey(key("ArrowLeft", { shiftKey: true }), 50, WHOLE), 40);
  assert.equal(timeAfterKey(key("ArrowLeft", { altKey: true }), 50, WHOLE), 49.9);
  assert.equal(timeAfterKey(key("PageUp"), 95, WHOLE), 100);
  assert.equal(timeAfterKey(key("Home"), 50, WHOLE), 0);
  assert.equal(timeAfterKey(key("End"), 50, WHOLE), 100);
  assert.equal(timeAfterKey(key("x"), 50, WHOLE), null);
  assert.equal(timeAfterKey(key("ArrowRight", { ctrlKey: true }), 50, WHOLE), null);
});

test("Space, comma and dot are keys like others", () => {
  const stroke = (/** @type {string} */ key) => ({
    ...{ key, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false },
  });
  assert.ok(matches("Space", stroke(" ")));
  assert.ok(matches(",", stroke(",")) && matches(".", stroke(".")));
  assert.ok(!matches("Space", { ...stroke(" "), ctrlKey: true }));
});

test("sizes have two or three digits", () => {
  assert.deepEqual([0, 999, 1500, 912e6, 51.2e9].map(sizeWords), [
    ...["0 B", "999 B", "1.5 kB", "912 MB", "51 GB"],
  ]);
});
