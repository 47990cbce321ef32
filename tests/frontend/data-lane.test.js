/** @import { MessageView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { FrameError, readFrame } from "../../frontend_assets/workers/frames.js";
import { numberAt, stepsOf, valueAt } from "../../frontend_assets/workers/message-paths.js";
import {
  folded,
  hexRows,
  SteadyClock,
  Trace,
  Types,
} from "../../frontend_assets/workers/subscriptions.js";

/** @param {{channel: number, payload: number[], received_ns: bigint, sent_ns: bigint, lost: number}[]} messages */
function frame(messages, dropped = 0) {
  const parts = messages.map(({ channel, payload, received_ns, sent_ns, lost }) => {
    const part = new Uint8Array((28 + payload.length + 7) & ~7);
    const view = new DataView(part.buffer);
    view.setUint32(0, channel, true);
    view.setUint32(4, payload.length, true);
    view.setBigInt64(8, received_ns, true);
    view.setBigInt64(16, sent_ns, true);
    view.setUint32(24, lost, true);
    part.set(payload, 28);
    return part;
  });
  const head = new Uint8Array(16);
  head[0] = 1;
  new DataView(head.buffer).setUint32(4, messages.length, true);
  new DataView(head.buffer).setUint32(8, dropped, true);
  return Uint8Array.from([head, ...parts].flatMap((one) => [...one])).buffer;
}

const ONE = {
  channel: 7,
  payload: [1, 2, 3],
  received_ns: 2_000_000_000n,
  sent_ns: 1_500_000_000n,
  lost: 4,
};

test("a frame gives its messages, and for how many this page was too slow", () => {
  const { dropped, messages } = readFrame(frame([ONE, { ...ONE, channel: 8, payload: [] }], 3));
  assert.equal(dropped, 3);
  assert.deepEqual(
    messages.map(({ channel, cdr, received_s, sent_s, lost }) => [
      channel,
      [...cdr],
      received_s,
      sent_s,
      lost,
    ]),
    [
      [7, [1, 2, 3], 2, 1.5, 4],
      [8, [], 2, 1.5, 4],
    ],
  );
});

test("a frame that is cut off or of another version is refused", () => {
  const whole = frame([ONE]);
  assert.throws(() => readFrame(whole.slice(0, 40)), FrameError);
  assert.throws(() => readFrame(whole.slice(0, 20)), FrameError);
  assert.throws(() => readFrame(new ArrayBuffer(16)), FrameError);
  assert.throws(() => readFrame(new ArrayBuffer(0)), FrameError);
});

const MESSAGE = {
  pose: { position: { x: 3, y: 4, z: 0 } },
  data: Float32Array.from([1, 2.5, -1]),
  big: 2n ** 60n,
  angle: Math.PI,
  turn: { x: 0, y: 0, z: 1, w: 1 },
  on: true,
  name: "base",
  stamp: { sec: 2, nanosec: 500_000_000 },
};

for (const [path, value] of /** @type {const} */ ([
  [".pose.position.x", 3],
  [".data[1]", 2.5],
  [".data[-1]", -1],
  [".pose.position.@norm", 5],
  [".angle.@deg", 180],
  [".turn.@yaw.@deg", 90],
  [".turn.@roll", 0],
  [".turn.@pitch", 0],
  [".pose.@yaw", Number.NaN],
  [".data.@length", 3],
  [".big", 2 ** 60],
  [".on", 1],
  [".stamp", 2.5],
  [".name", Number.NaN],
  [".data[9]", Number.NaN],
  [".none.x", Number.NaN],
  [".pose.constructor", Number.NaN],
]))
  test(`${path} is ${value}`, () => {
    assert.equal(numberAt(MESSAGE, stepsOf(path) ?? []), value);
  });

test("what is no path is none", () => {
  for (const path of ["pose", ".", ".a b", ".a[x]", ".a[1", ".@sqrt", ".a;b"])
    assert.equal(stepsOf(path), null, path);
  assert.deepEqual(stepsOf(""), []);
  assert.equal(valueAt(MESSAGE, []), MESSAGE);
});

test("of long lists and texts the beginning is shown, and more where that is wished", () => {
  const message = {
    list: Float64Array.from({ length: 1000 }, (_, n) => n),
    text: "x".repeat(5000),
  };
  const first = folded(message, new Map());
  assert.equal(first.list["@list"], 1000);
  assert.equal(first.list.items.length, 24);
  assert.deepEqual(first.text["@text"], 5000);
  assert.equal(folded(message, new Map([[".list", 500]])).list.items.length, 500);
  const many = {
    all: Array.from({ length: 24 }, () => ({ a: Array.from({ length: 5000 }, () => [1]) })),
  };
  assert.ok(JSON.stringify(folded(many, new Map([[".all[0].a", 1e9]]))).length < 100_000);
});

test("bytes that nobody can read are shown in rows", () => {
  assert.equal(hexRows(Uint8Array.from([72, 105, 0])), `0000  48 69 00${" ".repeat(39)}  Hi·`);
});

test("times of a sender are even, whatever the way does to them", () => {
  const clock = new SteadyClock();
  const times = [0, 1, 2, 3].map((n) =>
    clock.time({ sent_s: 100 + n * 0.01, received_s: 500 + n * 0.01 + (n % 2) * 0.004 }),
  );
  assert.ok(times.every((one, n) => Math.abs(one - 500 - n * 0.01) < 1e-9));
  assert.equal(clock.time({ sent_s: 0, received_s: 600 }), 600);
  assert.equal(clock.time({ sent_s: 1, received_s: 700 }), 700);
});

test("of every message each number is told, and none is lost while its type is asked for", () => {
  /** @type {any[]} */
  const posted = [];
  const post = (/** @type {any} */ one) => posted.push(one);
  const types = new Types(post);
  const subscription = {
    subscription: 1,
    topic: "/x",
    type_name: "",
    mode: /** @type {const} */ ("every"),
    most_hz: 60,
    reliable: null,
    latched: null,
    depth: null,
  };
  const trace = new Trace(subscription, types, post, [".data", ".none"]);
  trace.typeName = "x/msg/One";
  const cdr = Uint8Array.from([0, 1, 0, 0, 5, 0, 0, 0]);
  const came = { channel: 1, cdr, received_s: 1, sent_s: 1, lost: 0 };
  trace.take([came, came]);
  trace.take([came]);
  assert.deepEqual(posted, [{ kind: "need", typeName: "x/msg/One" }]);
  const field = {
    name: "data",
    base: "int32",
    shape: /** @type {const} */ ("single"),
    count: 0,
    string_bound: 0,
    default: null,
    comment: "",
  };
  /** @type {MessageView[]} */
  const messages = [{ name: "x/msg/One", fields: [field], constants: [], comment: "" }];
  types.learn("x/msg/One", messages, "");
  trace.show();
  const { values, times } = /** @type {any} */ (posted.at(-1));
  assert.deepEqual([...values[0]], [5, 5, 5]);
  assert.ok([...values[1]].every(Number.isNaN));
  assert.equal(times.length, 3);
});
