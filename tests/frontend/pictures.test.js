/** @import { Easel, Pictured } from "../../frontend_assets/workers/pictures.js" */
/** @import { Came } from "../../frontend_assets/workers/frames.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { Pictures } from "../../frontend_assets/workers/pictures.js";
import { Types } from "../../frontend_assets/workers/subscriptions.js";
import { PNG, raw } from "./support/images.js";

const WISH = {
  subscription: 5,
  topic: "/camera",
  type_name: "",
  mode: /** @type {const} */ ("newest"),
  most_hz: 30,
  reliable: null,
  latched: null,
  depth: null,
};
const IMAGE = "sensor_msgs/msg/Image";
const COMPRESSED = "sensor_msgs/msg/CompressedImage";

/** A topic that is looked at; its screen is ready for another picture when `frame` says so. */
class Echoed {
  /** @param {string} typeName @param {(cdr: Uint8Array) => any} read */
  constructor(typeName, read) {
    /** @type {Pictured[]} */
    this.told = [];
    /** The first pixel of each picture that was painted. @type {number[][]} */
    this.painted = [];
    /** @type {(() => void)[]} */
    this.asked = [];
    const post = (/** @type {any} */ message) =>
      message.kind === "picture" && this.told.push(message);
    const known = () => ({ read, trouble: "" });
    const types = Object.assign(new Types(post), { find: known });
    const easel = /** @type {Easel} */ (
      /** @type {any} */ ({
        paint: (/** @type {any} */ { ink }) => this.painted.push(ink.at(0, 0)),
      })
    );
    this.pictures = new Pictures(WISH, types, post, easel, (paint) => this.asked.push(paint));
    this.pictures.typeName = typeName;
  }

  /** @param {number[]} numbers each stands in a message of its own */
  subscribe(...numbers) {
    this.pictures.take(numbers.map((number) => cameWith(number)));
  }

  /** The screen is ready. */
  async frame() {
    this.asked.shift()?.();
    await new Promise(setImmediate);
  }
}

/** @param {number} number @returns {Came} */
const cameWith = (number) => ({
  channel: 1,
  cdr: Uint8Array.of(number),
  received_s: number,
  sent_s: 0,
  lost: 0,
});

const grey = () => new Echoed(IMAGE, ([number = 0]) => raw("mono8", 2, 1, [number, 9]));

test("an image is painted, and it is told what it is", async (context) => {
  const looked = grey();
  context.after(() => looked.pictures.leave());
  looked.subscribe(77);
  await looked.frame();
  assert.deepEqual(looked.painted, [[77]]);
  assert.deepEqual(looked.told[0], {
    kind: "picture",
    subscription: 5,
    painted: 1,
    rate_hz: null,
    bytes: 1,
    encoding: "mono8",
    size: { width: 2, height: 1 },
    numbers: null,
    pointed: null,
    trouble: null,
  });
});

test("of images that come faster than the screen shows them, only the newest is painted", async (context) => {
  const looked = grey();
  context.after(() => looked.pictures.leave());
  looked.subscribe(1, 2);
  for (let number = 3; number < 200; number += 1) looked.subscribe(number);
  assert.equal(looked.asked.length, 1);
  await looked.frame();
  assert.deepEqual(looked.painted, [[199]]);
  assert.equal(looked.asked.length, 0);
  looked.subscribe(200);
  await looked.frame();
  assert.deepEqual(looked.painted, [[199], [200]]);
});

test("of every image it is said once that nobody reads it any more: when it was passed over, or after another is shown", async (context) => {
  const looked = grey();
  context.after(() => looked.pictures.leave());
  /** @type {number[]} */
  const done = [];
  const subscribe = (/** @type {number} */ number) =>
    looked.pictures.take([{ ...cameWith(number), done: () => done.push(number) }]);
  for (const number of [1, 2, 3]) subscribe(number);
  assert.deepEqual(done, [1, 2]);
  await looked.frame();
  assert.deepEqual(done, [1, 2]);
  subscribe(4);
  assert.deepEqual(done, [1, 2]);
  await looked.frame();
  assert.deepEqual(done, [1, 2, 3]);
  assert.deepEqual(looked.painted, [[3], [4]]);
});

test("a picture that is moved is painted anew, and does not count as another one", async (context) => {
  const looked = grey();
  context.after(() => looked.pictures.leave());
  looked.subscribe(1);
  await looked.frame();
  const sight = { width: 4, height: 4, ratio: 1, view: null };
  looked.pictures.carryOut({ kind: "sight", sight });
  await looked.frame();
  looked.pictures.carryOut({ kind: "point", pixel: { x: 1, y: 0 } });
  assert.equal(looked.painted.length, 2);
  const last = looked.told.at(-1);
  assert.equal(last?.painted, 1);
  assert.deepEqual(last?.pointed, { x: 1, y: 0, values: [9] });
});

test("beside a picture no pixel is pointed at", async (context) => {
  const looked = grey();
  context.after(() => looked.pictures.leave());
  looked.subscribe(1);
  await looked.frame();
  for (const pixel of [{ x: 2, y: 0 }, { x: 0, y: -1 }, null]) {
    looked.pictures.carryOut({ kind: "point", pixel });
    assert.equal(looked.told.at(-1)?.pointed, null);
  }
});

test("what is said of alike pictures is said some times in a second, and the newest in the end", async (context) => {
  const looked = grey();
  context.mock.timers.enable({ apis: ["setTimeout"] });
  for (let number = 1; number < 30; number += 1) {
    looked.subscribe(number);
    await looked.frame();
  }
  const before = looked.told.length;
  assert.ok(before < 29, `${before} were told`);
  context.mock.timers.runAll();
  assert.equal(looked.told.at(-1)?.painted, 29);
  assert.equal(looked.told.at(-1)?.rate_hz, 1);
});

for (const [key, typeName, message] of /** @type {[string, string, any][]} */ ([
  ["encoding", IMAGE, raw("h264", 1, 1, [1])],
  ["large", IMAGE, raw("rgb8", 2 ** 31, 2 ** 31, [1])],
  ["type", IMAGE, { data: "text" }],
  ["type", IMAGE, { ...raw("mono8", 1, 1, [1]), width: -1 }],
  ["type", "std_msgs/msg/String", { data: "text" }],
  ["type", COMPRESSED, { data: "text", format: 3 }],
  ["depth", COMPRESSED, { data: new Uint8Array(9), format: "16UC1; compressedDepth png" }],
  ["file", COMPRESSED, { data: new Uint8Array(9), format: "webp" }],
  [
    "large",
    COMPRESSED,
    { data: Uint8Array.from([...PNG.slice(0, 16), ...new Array(8).fill(9)]), format: "png" },
  ],
  ["broken", COMPRESSED, { data: Uint8Array.from(PNG), format: "png" }],
]))
  test(`what cannot be shown says why: ${key} in ${typeName}`, async (context) => {
    // Node has no pictures; a browser says the same of bytes that are none.
    const unpack = async () => {
      throw new DOMException("no image");
    };
    Object.assign(globalThis, { createImageBitmap: unpack });
    context.after(() => Reflect.deleteProperty(globalThis, "createImageBitmap"));
    const looked = new Echoed(typeName, () => message);
    looked.subscribe(1);
    await looked.frame();
    assert.equal(looked.told[0]?.size, null);
    assert.equal(looked.told[0]?.trouble?.key, `image.trouble.${key}`);
    assert.deepEqual(looked.painted, []);
  });
