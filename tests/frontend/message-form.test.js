import assert from "node:assert/strict";
import { test } from "node:test";
import {
  blank,
  choicesOf,
  fromPlain,
  isWrong,
  troubleOf,
  typeText,
  yamlOf,
} from "../../frontend_assets/model/message-forms.js";

/** @param {string} name @param {string} base @param {object} [more] */
const field = (name, base, more = {}) => ({
  name,
  base,
  shape: /** @type {const} */ ("single"),
  count: 0,
  string_bound: 0,
  default: null,
  comment: "",
  ...more,
});
/** @param {string} name @param {any[]} fields @param {any[]} [constants] */
const message = (name, fields, constants = []) => ({ name, fields, constants, comment: "" });

const POINT = message("g/msg/Point", [field("x", "float64"), field("y", "float64")]);
const ALL = message("t/msg/All", [
  field("on", "bool", { default: true }),
  field("count", "uint8"),
  field("big", "int64"),
  field("label", "string", { string_bound: 5 }),
  field("point", "g/msg/Point"),
  field("numbers", "float32", { shape: "array", count: 2 }),
  field("names", "string", { shape: "sequence" }),
  field("points", "g/msg/Point", { shape: "bounded", count: 3 }),
]);
const TYPES = new Map([POINT, ALL, message("t/msg/Empty", [])].map((one) => [one.name, one]));

test("a blank form holds the defaults", () => {
  assert.deepEqual(blank(TYPES, "t/msg/All"), {
    on: true,
    count: "0",
    big: "0",
    label: "",
    point: { x: "0.0", y: "0.0" },
    numbers: "0.0, 0.0",
    names: [],
    points: [],
  });
});

test("what was read of a text is laid over the defaults, large numbers letter for letter", () => {
  const value = fromPlain(TYPES, "t/msg/All", {
    big: "9007199254740993",
    numbers: [1, "nan"],
    points: [{ y: 2 }],
  });
  assert.deepEqual(/** @type {any} */ (value).points, [{ x: "0.0", y: "2.0" }]);
  assert.match(yamlOf(TYPES, "t/msg/All", value), /^big: 9007199254740993$/m);
  assert.match(yamlOf(TYPES, "t/msg/All", value), /^numbers: \[1.0, .nan\]$/m);
});

test("a form is written as YAML with a line for each field", () => {
  const value = fromPlain(TYPES, "t/msg/All", {
    label: 'a"b',
    names: ["x", "no"],
    points: [{ x: 1 }, {}],
  });
  assert.equal(
    yamlOf(TYPES, "t/msg/All", value),
    [
      '"on": true',
      "count: 0",
      "big: 0",
      'label: "a\\"b"',
      "point:",
      "  x: 0.0",
      "  y: 0.0",
      "numbers: [0.0, 0.0]",
      "names:",
      '- "x"',
      '- "no"',
      "points:",
      "- x: 1.0",
      "  y: 0.0",
      "- x: 0.0",
      "  y: 0.0",
    ].join("\n"),
  );
  assert.equal(yamlOf(TYPES, "t/msg/Empty", {}), "{}");
});

test("a word may stand for a whole message", () => {
  const value = fromPlain(TYPES, "t/msg/All", { point: "now" });
  assert.match(yamlOf(TYPES, "t/msg/All", value), /^point: "now"$/m);
});

test("what a field does not take is found before it is sent", () => {
  const by = Object.fromEntries(ALL.fields.map((one) => [one.name, one]));
  assert.equal(troubleOf(by.count, "256"), "form.range");
  assert.equal(troubleOf(by.count, "0xff"), "");
  assert.equal(troubleOf(by.count, "1.5"), "form.whole");
  assert.equal(troubleOf(by.big, "-9223372036854775808"), "");
  assert.equal(troubleOf(by.label, "123456"), "form.long");
  assert.equal(troubleOf(by.numbers, "1, 2, 3"), "form.count");
  assert.equal(troubleOf(by.numbers, "[1, -inf]"), "");
  assert.equal(troubleOf(by.numbers, "1, x"), "form.items");
  assert.equal(troubleOf(POINT.fields[0], "1e-3"), "");
  const value = blank(TYPES, "t/msg/All");
  assert.equal(isWrong(TYPES, "t/msg/All", value), false);
  assert.equal(isWrong(TYPES, "t/msg/All", { ...value, points: [{ x: "1", y: "" }] }), true);
});

test("constants are the choice of the field that they are named after", () => {
  const constant = (/** @type {string} */ name) => ({ name, base: "uint8", value: 1, comment: "" });
  const status = message(
    "t/msg/S",
    [field("status", "uint8"), field("other", "uint8"), field("text", "string")],
    [constant("STATUS_OK"), constant("FAST")],
  );
  const names = status.fields.map((one) => choicesOf(status, one).map(({ name }) => name));
  assert.deepEqual(names, [["STATUS_OK"], ["FAST"], []]);
});

test("types are written as in their texts", () => {
  assert.deepEqual(ALL.fields.slice(3).map(typeText), [
    "string<=5",
    "g/msg/Point",
    "float32[2]",
    "string[]",
    "g/msg/Point[<=3]",
  ]);
});
