/** @import { MessageView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Echo, Trace, Types } from "../../frontend_assets/workers/subscriptions.js";

/** @type {{schemas: Record<string, MessageView[]>, cases: {type: string, little: string}[]}} */
const GOLDEN = JSON.parse(
  readFileSync(new URL("../golden/cdr/messages.json", import.meta.url), "utf8"),
);
const WISH = {
  subscription: 1,
  topic: "/x",
  type_name: "",
  mode: /** @type {const} */ ("every"),
  most_hz: 10,
  reliable: null,
  latched: null,
  depth: null,
};
const NUMBER = "std_msgs/msg/Float64";
/** @type {MessageView} */
const NUMBER_MESSAGE = {
  name: NUMBER,
  comment: "",
  constants: [],
  fields: [
    {
      name: "data",
      base: "float64",
      shape: "single",
      count: 0,
      string_bound: 0,
      default: null,
      comment: "",
    },
  ],
};

/** @param {Uint8Array} cdr */
const came = (cdr) => ({ channel: 1, cdr, received_s: 1, sent_s: 0, lost: 0 });

/** @param {string} type @param {readonly MessageView[]} messages */
function looking(type, messages) {
  /** @type {any[]} */
  const told = [];
  const types = new Types((message) => told.push(message));
  types.learn(type, messages, "");
  const look = new Echo(WISH, types, (message) => told.push(message));
  look.typeName = type;
  return { look, told };
}

for (const [n, { type, little }] of GOLDEN.cases.entries())
  test(`however ${type} is cut, a sentence says so and the next whole one is read, ${n}`, () => {
    const whole = new Uint8Array(Buffer.from(little, "hex"));
    const { look, told } = looking(type, GOLDEN.schemas[type] ?? []);
    for (let length = 0; length < whole.length; length += 1) {
      look.take([came(whole.slice(0, length))]);
      const { trouble, value, bytes } = told.at(-1);
      assert.equal(bytes, length);
      assert.equal(value, null);
      assert.match(trouble, /^it .+[^.]$/);
    }
    look.take([came(whole)]);
    assert.equal(told.at(-1).trouble, "");
    assert.notEqual(told.at(-1).value, null);
    assert.equal(told.length, whole.length + 1);
  });

test("what cannot be read among what can leaves a gap in its line, and says why", () => {
  /** @type {any[]} */
  const told = [];
  const types = new Types(() => {});
  types.learn(NUMBER, [NUMBER_MESSAGE], "");
  const trace = new Trace(WISH, types, (message) => told.push(message), [".data"]);
  trace.typeName = NUMBER;
  const good = new Uint8Array(12);
  good[1] = 1;
  trace.take([came(good), came(good.slice(0, 9)), came(good)]);
  assert.deepEqual([...told[0].values[0]], [0, Number.NaN, 0]);
  assert.equal(told[0].trouble, "it has 9 bytes, which is too few");
  trace.take([came(good)]);
  assert.equal(told[1].trouble, "");
});

test("a type that nobody tells is shown as bytes with the reason, asked for now and then, and read once it is told", () => {
  let now_ms = 0;
  /** @type {any[]} */
  const told = [];
  const post = (/** @type {any} */ message) => told.push(message);
  const types = new Types(post, () => now_ms);
  const look = new Echo(WISH, types, post);
  look.typeName = NUMBER;
  const cdr = new Uint8Array(12);
  cdr[1] = 1;
  look.take([came(cdr)]);
  types.learn(NUMBER, null, "no known package defines it.");
  look.take([came(cdr)]);
  look.take([came(cdr)]);
  now_ms = 5001;
  look.take([came(cdr)]);
  types.learn(NUMBER, [NUMBER_MESSAGE], "");
  look.take([came(cdr)]);
  const need = { kind: "need", typeName: NUMBER };
  assert.deepEqual([told[0], told[3]], [need, need]);
  assert.equal(told[1].trouble, "no known package defines it.");
  assert.match(told[2].hex, /^0000 {2}00 01 /);
  assert.deepEqual(told[4].value, { data: 0 });
  assert.equal(told.length, 5);
});
