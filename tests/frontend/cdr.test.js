/** @import { MessageView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { CdrError, readerOf } from "../../frontend_assets/workers/cdr.js";
import { wholeText } from "../../frontend_assets/workers/subscriptions.js";

/** @type {{schemas: Record<string, MessageView[]>, cases: {type: string, little: string, big: string, value: any}[]}} */
const GOLDEN = JSON.parse(
  readFileSync(new URL("../golden/cdr/messages.json", import.meta.url), "utf8"),
);

/** @param {string} hex @param {number} [offset] where it lies in what it came in */
function bytesOf(hex, offset = 4) {
  const own = Buffer.from(hex, "hex");
  const all = new Uint8Array(own.length + offset);
  all.set(own, offset);
  return all.subarray(offset);
}

/** @param {string} name */
const reader = (name) => readerOf(GOLDEN.schemas[name] ?? [], name);

/** As JSON has it, whole numbers beyond its reach as the nearest that it has. @param {any} value */
const plain = (value) =>
  JSON.parse(wholeText(value), (_, one) =>
    typeof one === "string" && /^-?\d{16,}$/.test(one) ? Number(one) : one,
  );

for (const [n, { type, little, big, value }] of GOLDEN.cases.entries())
  test(`${type} is read as the studio reads it, ${n}`, () => {
    assert.deepEqual(plain(reader(type)(bytesOf(little))), value);
    assert.deepEqual(plain(reader(type)(bytesOf(big))), value);
    for (const offset of [0, 1, 5, 7])
      assert.deepEqual(plain(reader(type)(bytesOf(little, offset))), value);
  });

test("numbers are looked at where they lie, wherever that is possible", () => {
  const found = GOLDEN.cases.find(({ value }) => value.ranges?.length > 0);
  assert.ok(found);
  const cdr = bytesOf(found.little);
  const scan = reader("sensor_msgs/msg/LaserScan")(cdr);
  assert.ok(scan.ranges instanceof Float32Array);
  assert.equal(scan.ranges.buffer, cdr.buffer);
});

test("whatever is cut off, or altered, ends in an error of ours or in a message no larger than it", () => {
  for (const { type, little } of GOLDEN.cases) {
    const whole = bytesOf(little);
    const read = reader(type);
    for (let length = 0; length < whole.length; length += 1) tried(read, whole.slice(0, length));
    for (let at = 4; at < whole.length; at += 3) {
      const altered = whole.slice();
      altered.fill(0xff, at, at + 4);
      tried(read, altered);
    }
  }
});

/** @param {(cdr: Uint8Array) => any} read @param {Uint8Array} cdr */
function tried(read, cdr) {
  try {
    assert.ok(wholeText(read(cdr)).length < 1_000_000);
  } catch (error) {
    assert.ok(error instanceof CdrError, String(error));
  }
}

test("what begins as no plain CDR is refused", () => {
  const read = reader("std_msgs/msg/String");
  for (const head of [[], [0, 1], [0, 2, 0, 0], [1, 0, 0, 0]])
    assert.throws(() => read(Uint8Array.from(head)), CdrError);
});

test("a type that is part of itself, unknown or of wide letters is refused before anything is read", () => {
  const field = {
    name: "a",
    base: "x/msg/A",
    shape: /** @type {const} */ ("sequence"),
    count: 0,
    string_bound: 0,
    default: null,
    comment: "",
  };
  const message = { name: "x/msg/A", fields: [field], constants: [], comment: "" };
  assert.throws(() => readerOf([message], "x/msg/A"), /part of itself/);
  assert.throws(() => readerOf([message], "x/msg/B"), /not known/);
  const wide = { ...message, fields: [{ ...field, base: "wstring" }] };
  assert.throws(() => readerOf([wide], "x/msg/A"), /wide letters/);
});
