import assert from "node:assert/strict";
import { test } from "node:test";
import { Pace } from "../../frontend_assets/viser/quality.js";

/**
 * Pictures one after the other, the next one asked for right after each.
 *
 * @param {Pace} pace
 * @param {{from: number, every: number, lasting: number, asks?: boolean}} times ms
 * @returns {number[]} what it told, pictures a second
 */
function draw(pace, { from, every, lasting, asks = true }) {
  const told = [];
  for (let now = from; now <= from + lasting; now += every) {
    const hz = pace.drawn(now);
    if (hz !== null) told.push(hz);
    if (asks) pace.asked(now + 5);
  }
  return told;
}

/** @returns {Pace} that counts from 0 on */
function begun() {
  const pace = new Pace();
  pace.begin(0);
  return pace;
}

test("ten pictures a second for three seconds are slow, which is told once", () => {
  const pace = begun();
  const [hz, ...more] = draw(pace, { from: 0, every: 100, lasting: 4000 });
  assert.ok(hz !== undefined && Math.abs(hz - 10) < 0.5, String(hz));
  assert.deepEqual(more, []);
  assert.deepEqual(draw(pace, { from: 5000, every: 100, lasting: 9000 }), []);
});

test("twenty-five pictures a second are enough", () => {
  assert.deepEqual(draw(begun(), { from: 0, every: 40, lasting: 20_000 }), []);
});

test("ten pictures a second are enough where no more than that are wanted", () => {
  const pace = begun();
  pace.slowBelow_hz = 6;
  assert.deepEqual(draw(pace, { from: 0, every: 100, lasting: 9000 }), []);
  assert.equal(draw(pace, { from: 10_000, every: 250, lasting: 9000 }).length, 1);
});

test("two slow seconds are not long enough", () => {
  const pace = begun();
  assert.deepEqual(draw(pace, { from: 0, every: 100, lasting: 2000 }), []);
  assert.deepEqual(draw(pace, { from: 9000, every: 100, lasting: 2000 }), []);
});

test("a picture now and then that nobody asks for at once has no pace", () => {
  assert.deepEqual(draw(begun(), { from: 0, every: 500, lasting: 20_000, asks: false }), []);
});

test("a machine that slept, or a tab that was hidden, was not slow", () => {
  assert.deepEqual(draw(begun(), { from: 0, every: 2000, lasting: 30_000 }), []);
});

test("what comes before the count begins does not count", () => {
  const pace = new Pace();
  assert.deepEqual(draw(pace, { from: 0, every: 100, lasting: 9000 }), []);
});
