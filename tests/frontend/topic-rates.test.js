import assert from "node:assert/strict";
import { test } from "node:test";
import { ageWords, bandWords, flowWords } from "../../frontend_assets/model/topics.js";

/** @param {object} told */
const rate = (told) =>
  /** @type {any} */ ({ rate_hz: 0, bytes_per_s: 0, age_s: null, state: "live", ...told });

test("bytes in a second are told in three digits at most, by thousands", () => {
  const told = [0, 1, 999, 1000, 9949, 12_345, 999_499, 2_800_000, 186_000_000, 5e9, 7e12];
  const words = ["", "1 B/s", "999 B/s", "1.0 kB/s", "9.9 kB/s", "12 kB/s", "999 kB/s"];
  const heavy = ["2.8 MB/s", "186 MB/s", "5.0 GB/s", "7000 GB/s"];
  assert.deepEqual(told.map(bandWords), [...words, ...heavy]);
});

test("less than a byte in a second is none of a greater unit", () => {
  assert.equal(bandWords(0.4), "0 B/s");
});

test("how a topic comes is its rate and its bytes, as far as they are known", () => {
  assert.equal(flowWords(rate({ rate_hz: 30, bytes_per_s: 2_765_000 })), "30 Hz · 2.8 MB/s");
  assert.equal(flowWords(rate({})), "");
  assert.equal(flowWords(undefined), "");
});

test("there is an age once something came, however fresh it is", () => {
  assert.equal(ageWords(rate({ age_s: 0 })), "0.0 s");
  assert.equal(ageWords(rate({ age_s: 75 })), "1 min");
  assert.equal(ageWords(rate({})), "");
  assert.equal(ageWords(undefined), "");
});
