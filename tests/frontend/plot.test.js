import assert from "node:assert/strict";
import { test } from "node:test";
import { numberPaths } from "../../frontend_assets/model/number-paths.js";
import { columnsOf, columnTimes, csvOf, Samples } from "../../frontend_assets/model/plotting.js";
import { isNoise, shownTopics } from "../../frontend_assets/model/topics.js";
import { echoRows } from "../../frontend_assets/panels/topics/echo.js";

/** @param {number} count @param {number} rate_hz @param {(n: number) => number} value */
function samplesOf(count, rate_hz, value) {
  const samples = new Samples();
  for (let n = 0; n < count; n += 100) {
    const size = Math.min(100, count - n);
    samples.add(
      Float64Array.from({ length: size }, (_, k) => (n + k) / rate_hz),
      Float64Array.from({ length: size }, (_, k) => value(n + k)),
    );
  }
  return samples;
}

test("every sample of 60 s at 1 kHz is kept, in its order", () => {
  const samples = samplesOf(60_000, 1000, (n) => n);
  assert.equal(samples.count, 60_000);
  assert.equal(samples.end - samples.begin, 60_000);
  assert.equal(samples.valueAt(30), 30_000);
  assert.equal(samples.newest(), 59_999);
  assert.equal(samples.valueAt(70), null);
});

test("what is kept is bounded: the oldest goes", () => {
  const samples = samplesOf(1_500_000, 1000, (n) => n);
  assert.ok(samples.end - samples.begin <= 1_048_576);
  assert.equal(samples.newest(), 1_499_999);
  assert.equal(samples.valueAt(0), null);
});

test("a column of pixels shows the least and the largest of what came in it", () => {
  const samples = samplesOf(10_000, 1000, (n) => (n === 5003 ? 9 : n === 5007 ? -9 : 1));
  const drawn = columnsOf(samples, 0, 10, 100);
  assert.equal(drawn.length, 200);
  assert.deepEqual(drawn.slice(98, 104), [1, 1, 9, -9, 1, 1]);
  assert.deepEqual(columnTimes(2, -4, 0), [-3.5, -2.5, -1.5, -0.5]);
});

test("a line has a gap where nothing came for long, and none where messages are rare", () => {
  const samples = new Samples();
  const times = Float64Array.from([0, 1, 2, 8, 9]);
  samples.add(times, times);
  const drawn = columnsOf(samples, 0, 10, 20);
  assert.deepEqual(
    drawn.flatMap((one, n) => (one === null ? [n] : [])),
    [31],
  );
});

test("what is no number is counted and not drawn", () => {
  const samples = new Samples();
  samples.add(Float64Array.from([1, 2]), Float64Array.from([Number.NaN, 5]));
  assert.deepEqual([samples.count, samples.others], [1, 1]);
});

test("a table holds what is seen, and no formula", () => {
  const samples = samplesOf(4, 1, (n) => n / 2);
  const text = csvOf([{ topic: "=1+1", path: '.a"b', samples }], 1, 2);
  assert.equal(
    text,
    `topic,path,time_s,value\n'=1+1,".a""b",1.000000,0.5\n'=1+1,".a""b",2.000000,1\n`,
  );
});

test("a message is a tree: short things are open, lists are not", () => {
  const message = {
    header: { stamp: { sec: 3, nanosec: 7 }, frame_id: "map" },
    ranges: { "@list": 360, items: [1, 2, 3, 4, 5, 6, 7, 8] },
    covariance: [0, 1],
    text: { "@text": 5000, begin: "abc" },
    empty: [],
  };
  const rows = echoRows(message, new Set());
  assert.deepEqual(
    rows.map(({ path, text, expanded }) => [path, text, expanded]),
    [
      [".header", "", true],
      [".header.stamp", "3.000000007", false],
      [".header.frame_id", "map", false],
      [".ranges", "[360] 1, 2, 3, 4, 5, 6, …", false],
      [".covariance", "[0, 1]", false],
      [".text", "abc…", false],
      [".empty", "[]", false],
    ],
  );
  const open = echoRows(message, new Set([".header", ".ranges"]));
  assert.deepEqual(
    open.slice(0, 4).map(({ path, numeric, more }) => [path, numeric, more]),
    [
      [".header", false, 0],
      [".ranges", false, 352],
      [".ranges[0]", true, 0],
      [".ranges[1]", true, 0],
    ],
  );
});

test("a number of a message has six digits in its row, and all of them in its title", () => {
  const [scalar, vector, count] = echoRows(
    { data: 0.24080000000000001, at: { x: 1 / 3, y: 2 }, count: 123456789 },
    new Set(),
  ).filter(({ level }) => level === 1);
  assert.deepEqual([scalar?.text, scalar?.whole], ["0.2408", "0.24080000000000001"]);
  assert.deepEqual([vector?.text, vector?.whole], ["x 0.333333  y 2", `x ${1 / 3}  y 2`]);
  assert.equal(count?.text, "123456789");
});

test("the numbers of a type are offered, and what is worked out of vectors and quaternions", () => {
  const field = (/** @type {string} */ name, /** @type {string} */ base, shape = "single") =>
    /** @type {any} */ ({ name, base, shape });
  const messages = /** @type {any} */ ([
    {
      name: "T",
      fields: [field("v", "V"), field("name", "string"), field("data", "int8", "sequence")],
    },
    { name: "Q", fields: ["x", "y", "z", "w"].map((one) => field(one, "float64")) },
    { name: "R", fields: [field("q", "Q")] },
    { name: "V", fields: ["x", "y", "z"].map((one) => field(one, "float64")) },
  ]);
  assert.deepEqual(numberPaths(messages, "T"), [".v.x", ".v.y", ".v.z", ".v.@norm", ".data[0]"]);
  assert.equal(numberPaths(messages, "R").at(-1), ".q.@yaw.@deg");
});

/** @param {string} name @param {string} type */
const topic = (name, type) => ({ name, types: [type], publishers: 1, subscribers: 0, kind: "" });
/** @param {string} name @param {number} rate_hz */
const rate = (name, rate_hz) => ({
  name,
  rate_hz,
  bytes_per_s: rate_hz * 10,
  age_s: 0,
  state: /** @type {const} */ ("live"),
});

test("noise is hidden unless it is wished, and rows stand as they were sorted", () => {
  const all = [
    topic("/rosout", "L"),
    topic("/b", "Z"),
    topic("/a", "Y"),
    topic("/x/_action/status", "S"),
  ];
  const rates = new Map([rate("/b", 30), rate("/a", 1)].map((one) => [one.name, one]));
  const names = (/** @type {any} */ more) =>
    shownTopics(all, { words: "", noise: false, order: "name", rates, ...more }).map(
      ({ name }) => name,
    );
  assert.deepEqual(names({}), ["/a", "/b"]);
  assert.deepEqual(names({ order: "rate" }), ["/b", "/a"]);
  assert.deepEqual(names({ order: "type" }), ["/a", "/b"]);
  assert.deepEqual(names({ noise: true, words: "ros" }), ["/rosout"]);
  assert.ok(isNoise("/parameter_events"));
});
