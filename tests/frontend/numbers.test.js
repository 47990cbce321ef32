import assert from "node:assert/strict";
import { test } from "node:test";
import {
  allDigits,
  decimalsOf,
  formatNumber,
  niceStep,
  parseNumber,
  shownMeasure,
  shownNumber,
  shownNumbers,
  snap,
  steppedBy,
  toDegrees,
  toRadians,
} from "../../frontend_assets/lib/numbers.js";

test("only a plain number is read as one", () => {
  assert.equal(parseNumber(" 0.105 "), 0.105);
  assert.equal(parseNumber("-.5"), -0.5);
  assert.equal(parseNumber("1e-3"), 0.001);
  for (const text of ["", "a", "1 2", "0x10", "1,5", "${1}", "Infinity", "1e", "1e999", "nan"]) {
    assert.equal(parseNumber(text), null, text);
  }
});

test("float noise is not written into a file", () => {
  assert.equal(formatNumber(0.1 + 0.2), "0.3");
  assert.equal(formatNumber(1.1 * 3), "3.3");
  assert.equal(formatNumber(-0), "0");
  assert.equal(formatNumber(0.000012), "0.000012");
  assert.equal(formatNumber(123456.789), "123456.789");
});

test("a number that is written reads back as the same number", () => {
  for (const value of [0.1, 1 / 3, 2e-5, 12345.6789, -7, 1e-9, 4.2e17]) {
    const back = parseNumber(formatNumber(value));
    assert.ok(back !== null && Math.abs(back - value) <= Math.abs(value) * 1e-9, String(value));
  }
});

test("a slider moves on the grid of its step", () => {
  assert.equal(snap(0.1234, 0.005), 0.125);
  assert.equal(snap(0.30000000000000004, 0.1), 0.3);
  assert.equal(snap(7.4, 1), 7);
  assert.equal(snap(1.234, 0), 1.234);
  assert.equal(decimalsOf(0.005), 3);
  assert.equal(decimalsOf(10), 0);
});

test("a range gets a round step, about two hundred of them", () => {
  assert.equal(niceStep(0, 1), 0.005);
  assert.equal(niceStep(-Math.PI, Math.PI), 0.05);
  assert.equal(niceStep(0, 200), 1);
  assert.equal(niceStep(3, 3), 0.01);
});

test("degrees and radians are each other's inverse", () => {
  assert.equal(toDegrees(Math.PI), 180);
  assert.ok(Math.abs(toRadians(180) - Math.PI) < 1e-8);
  for (const deg of [0, 1, -90, 33.3]) assert.ok(Math.abs(toDegrees(toRadians(deg)) - deg) < 1e-6);
});

test("Shift makes a step ten times larger, Alt ten times smaller", () => {
  assert.equal(steppedBy(0.5, { shiftKey: true, altKey: false }), 5);
  assert.equal(steppedBy(0.5, { shiftKey: false, altKey: true }), 0.05);
  assert.equal(steppedBy(0.5, { shiftKey: false, altKey: false }), 0.5);
});

test("a panel shows six significant digits, and no float noise", () => {
  assert.equal(shownNumber(0.24080000000000001), "0.2408");
  assert.equal(shownNumber(-12.3456789), "-12.3457");
  assert.equal(shownNumber(1 / 3), "0.333333");
  assert.equal(shownNumber(0.0000141482666), "0.0000141483");
  assert.equal(shownNumber(-6e-17), "-6e-17");
  assert.equal(shownMeasure(-6e-17), "0");
  assert.equal(shownMeasure(89.99999999999), "90");
  assert.equal(allDigits(0.1 + 0.2), "0.3");
  assert.equal(allDigits(1 / 3), "0.333333333333333");
});

test("numbers in a text are shortened, names, paths and versions are not", () => {
  assert.equal(shownNumbers("0.24080000000000001"), "0.2408");
  assert.equal(shownNumbers("[0.1, -0.30000000000000004]"), "[0.1, -0.3]");
  for (const text of ["12345678", "a/0.1234567/b.stl", "v1.2345678", "0.1234567.stl", "1.0"])
    assert.equal(shownNumbers(text), text);
});
