import assert from "node:assert/strict";
import { test } from "node:test";
import { FrameRate } from "../../frontend_assets/viser/frame-rate.js";

/** A window whose screen shows a picture when it is told to. */
class Screen {
  count = 0;
  /** @type {Map<number, FrameRequestCallback>} */
  asked = new Map();

  /** @param {FrameRequestCallback} callback */
  requestAnimationFrame(callback) {
    this.count += 1;
    this.asked.set(this.count, callback);
    return this.count;
  }

  /** @param {number} handle */
  cancelAnimationFrame(handle) {
    this.asked.delete(handle);
  }

  /** @param {number} now_ms */
  show(now_ms) {
    const now = [...this.asked.values()];
    this.asked.clear();
    for (const one of now) one(now_ms);
  }
}

/** @param {number} hz @param {number} seconds of a screen with 60 pictures a second @returns {number} pictures drawn */
function drawnIn(hz, seconds) {
  const screen = new Screen();
  const rate = new FrameRate(screen);
  rate.set(hz);
  let drawn = 0;
  const draw = () => {
    drawn += 1;
    screen.requestAnimationFrame(draw);
  };
  screen.requestAnimationFrame(draw);
  for (let n = 0; n < 60 * seconds; n += 1) screen.show((n * 1000) / 60);
  return drawn;
}

test("at most so many pictures a second are drawn, and all without a limit", () => {
  assert.equal(drawnIn(0, 2), 120);
  assert.equal(drawnIn(60, 2), 120);
  assert.equal(drawnIn(30, 2), 60);
  assert.equal(drawnIn(10, 2), 20);
  assert.equal(drawnIn(1, 2), 2);
});

test("what is asked for one picture comes with it, and what is cancelled does not come", () => {
  const screen = new Screen();
  const rate = new FrameRate(screen);
  rate.set(10);
  assert.equal(Math.round(rate.hz), 10);
  /** @type {string[]} */
  const came = [];
  const ask = (/** @type {string} */ name) =>
    screen.requestAnimationFrame(() => {
      came.push(name);
    });
  ask("a");
  ask("b");
  screen.show(0);
  const waits = ask("c");
  ask("d");
  screen.show(17);
  screen.cancelAnimationFrame(waits);
  screen.show(101);
  assert.deepEqual(came, ["a", "b", "d"]);
});
