import assert from "node:assert/strict";
import { test } from "node:test";
import {
  coarseShare,
  drawnOf,
  shows,
  tableAddress,
  valuesAt,
} from "../../frontend_assets/model/recorded-series.js";

const LINE = { topic: "/a", path: ".x" };
const OTHER = { topic: "/b", path: ".y" };

/** @param {Partial<import("../../frontend_assets/model/recorded-series.js").Answer>} more @returns {import("../../frontend_assets/model/recorded-series.js").Answer} */
const answer = (more) => ({
  ...{ first: [], second: [], before: null, after: null },
  ...{ exact: true, done: 1, count: 100, trouble: "" },
  ...more,
});
/** @param {Record<string, ReturnType<typeof answer>>} answers @param {number} columns @param {number} to_s */
const picture = (answers, columns, to_s) => ({
  ...{ recording: "r", range: { from_s: 0, to_s }, columns },
  answers: new Map(Object.entries(answers)),
});

test("a line has two values in each column, and is drawn on to what lies beside the range", () => {
  const one = answer({ first: [1, 3], second: [2, 0], before: [-1, 9], after: [4.5, 8] });
  const { times, values } = drawnOf(picture({ "/a.x": one }, 2, 4), [LINE], 10);
  assert.deepEqual(times, [-1, 0.5, 1.5, 2.5, 3.5, 4.5]);
  assert.deepEqual(values, [[9, 1, 2, 3, 0, 8]]);
});

test("lines share their times, and have nothing at those of others", () => {
  const answers = {
    "/a.x": answer({ first: [1], second: [1], before: [-2, 5] }),
    "/b.y": answer({ first: [2], second: [2], before: [-1, 6] }),
  };
  const { times, values } = drawnOf(picture(answers, 1, 1), [LINE, OTHER], 10);
  assert.deepEqual(times, [-2, -1, 0.25, 0.75]);
  assert.deepEqual(values, [
    [5, undefined, 1, 1],
    [undefined, 6, 2, 2],
  ]);
});

test("a gap is where nothing came for long, rare messages have none, and a coarse picture knows none", () => {
  const first = [1, null, null, null, null, null, 2];
  const gaps = (
    /** @type {Partial<import("../../frontend_assets/model/recorded-series.js").Answer>} */ more,
  ) =>
    drawnOf(
      picture({ "/a.x": answer({ first, second: first, ...more }) }, 7, 7),
      [LINE],
      70,
    ).values[0]?.flatMap((value, n) => (value === null ? [n] : []));
  assert.deepEqual(gaps({ count: 1000 }), [11]);
  assert.deepEqual(gaps({ count: 7 }), []);
  assert.deepEqual(gaps({ count: 1000, exact: false, done: 0.5 }), []);
});

test("beside a line stands what the last message until then can hold", () => {
  const one = answer({ first: [3, null, 1], second: [2, null, 1], before: [-1, 7] });
  const shown = picture({ "/a.x": one }, 3, 3);
  assert.deepEqual(valuesAt(shown, "/a.x", 0.5), [2, 7]);
  assert.deepEqual(valuesAt(shown, "/a.x", 1.5), [2, 3]);
  assert.deepEqual(valuesAt(shown, "/a.x", 3), [1, 3]);
  assert.deepEqual(valuesAt(shown, "/a.x", -0.5), [7, 7]);
  assert.equal(valuesAt(shown, "/b.y", 1), null);
  assert.equal(valuesAt(null, "/a.x", 1), null);
});

test("a picture is coarse as long as one line is, and a table is given out of what was read", () => {
  const coarse = { "/a.x": answer({}), "/b.y": answer({ exact: false, done: 0.25 }) };
  assert.equal(coarseShare(picture(coarse, 1, 1)), 0.25);
  assert.equal(tableAddress(picture(coarse, 1, 1), [LINE, OTHER]), "");
  const read = { "/a.x": answer({}), "/b.y": answer({ trouble: "No number." }) };
  assert.equal(coarseShare(picture(read, 1, 1)), null);
  assert.match(
    tableAddress(picture(read, 1, 1), [LINE, OTHER]),
    /\/export\/series\?topic=%2Fa&path=\.x$/,
  );
});

test("it is asked again for another range, of the last minutes once that moved a little", () => {
  const shown = picture({ "/a.x": answer({}) }, 10, 100);
  const wish = { recording: "r", range: { from_s: 0, to_s: 100 }, columns: 10, lines: [LINE] };
  assert.ok(shows(shown, wish, false));
  const moved = { ...wish, range: { from_s: 0, to_s: 101 } };
  assert.ok(!shows(shown, moved, false));
  assert.ok(shows(shown, moved, true));
  assert.ok(!shows(shown, { ...wish, range: { from_s: 0, to_s: 104 } }, true));
  assert.ok(!shows(shown, { ...wish, columns: 11 }, false));
  assert.ok(!shows(shown, { ...wish, lines: [LINE, OTHER] }, false));
  assert.ok(!shows(picture({ "/a.x": answer({ exact: false }) }, 10, 100), wish, false));
  assert.ok(!shows(null, wish, true));
});
