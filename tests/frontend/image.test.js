import assert from "node:assert/strict";
import { test } from "node:test";
import { sizeOfFile } from "../../frontend_assets/lib/image-file.js";
import { ImageError, pictureOf, pixelAt, rangeOf } from "../../frontend_assets/lib/image-pixels.js";
import { CLOSEST, filling, pixelUnder, rateOf } from "../../frontend_assets/lib/image-view.js";
import { zoomed } from "../../frontend_assets/lib/pan-zoom.js";
import { Pictures } from "../../frontend_assets/workers/pictures.js";
import { Types } from "../../frontend_assets/workers/wishes.js";

/** @import { Pictured } from "../../frontend_assets/workers/pictures.js" */

/** @param {string} encoding @param {number} width @param {number} height @param {number[]} bytes @param {{step?: number, is_bigendian?: number}} [more] */
const raw = (encoding, width, height, bytes, { step = 0, is_bigendian = 0 } = {}) => ({
  encoding,
  width,
  height,
  step,
  is_bigendian,
  data: Uint8Array.from(bytes),
});

/** @param {Parameters<typeof raw>} image @returns {number[][]} every pixel, row by row */
function pixels(...image) {
  const picture = pictureOf(raw(...image), null);
  const { width, height } = picture;
  return Array.from({ length: width * height }, (_, n) =>
    pixelAt(picture, n % width, Math.floor(n / width)),
  );
}

for (const [encoding, bytes] of /** @type {[string, number[]][]} */ ([
  ["rgb8", [10, 20, 30, 40, 50, 60]],
  ["bgr8", [30, 20, 10, 60, 50, 40]],
  ["8UC3", [30, 20, 10, 60, 50, 40]],
  ["rgba8", [10, 20, 30, 9, 40, 50, 60, 9]],
  ["bgra8", [30, 20, 10, 9, 60, 50, 40, 9]],
  ["8UC4", [30, 20, 10, 9, 60, 50, 40, 9]],
  ["rgb16", [1, 10, 1, 20, 1, 30, 1, 40, 1, 50, 1, 60]],
]))
  test(`${encoding} gives red, green and blue, and hides nothing`, () => {
    assert.deepEqual(pixels(encoding, 2, 1, bytes), [
      [10, 20, 30],
      [40, 50, 60],
    ]);
    assert.equal(pictureOf(raw(encoding, 2, 1, bytes), null).rgba[7], 255);
  });

test("rows may be longer than their pixels, and the last may end with them", () => {
  assert.deepEqual(pixels("mono8", 2, 2, [1, 2, 99, 99, 3, 4], { step: 4 }), [[1], [2], [3], [4]]);
  const wide = [1, 2, 3, 99, 4, 5, 6];
  assert.deepEqual(pixels("rgb8", 1, 2, wide, { step: 4 }), [
    [1, 2, 3],
    [4, 5, 6],
  ]);
});

test("numbers of two bytes are read in the order that the message says", () => {
  assert.deepEqual(pixels("mono16", 2, 1, [1, 2, 3, 4]), [[0x0201], [0x0403]]);
  assert.deepEqual(pixels("mono16", 2, 1, [1, 2, 3, 4], { is_bigendian: 1 }), [[0x0102], [0x0304]]);
  assert.deepEqual(pixels("rgb16", 1, 1, [9, 1, 8, 1, 7, 1], { is_bigendian: 1 }), [[9, 8, 7]]);
  assert.deepEqual(pixels("16SC1", 1, 1, [0xff, 0xff]), [[-1]]);
});

test("depth in millimetres has no value where nothing was measured, and is shaded between the others", () => {
  const picture = pictureOf(raw("16UC1", 3, 1, [0, 0, 0xe8, 3, 0xd0, 7]), null);
  assert.deepEqual(picture.range, { low: 1000, high: 2000 });
  assert.equal(picture.unit, "mm");
  assert.deepEqual(pixelAt(picture, 0, 0), [Number.NaN]);
  assert.deepEqual([...picture.rgba], [0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255]);
});

test("depth in metres may be anything, and a chosen range holds", () => {
  const bytes = new Uint8Array(
    Float32Array.of(0.5, Number.NaN, 3, Number.POSITIVE_INFINITY).buffer,
  );
  const image = raw("32FC1", 4, 1, [...bytes]);
  assert.deepEqual(pictureOf(image, null).range, { low: 0.5, high: 3 });
  const picture = pictureOf(image, { low: 0, high: 1 });
  assert.equal(picture.unit, "m");
  assert.deepEqual(
    [picture.rgba[0], picture.rgba[7], picture.rgba[8], picture.rgba[15]],
    [128, 0, 255, 0],
  );
});

test("where all numbers are one, or none is there, there still is a range", () => {
  assert.deepEqual(rangeOf(Float32Array.of(Number.NaN)), { low: 0, high: 1 });
  assert.deepEqual([...pictureOf(raw("16UC1", 1, 1, [7, 0]), null).rgba], [0, 0, 0, 255]);
});

test("two pixels share the colour of yuv422, in both orders", () => {
  // U, V of pure red; brightness 76 and 150.
  const red = [
    [254, 0, 0],
    [255, 74, 75],
  ];
  const near = (/** @type {number[][]} */ found) => {
    const worst = found.flatMap((one, n) =>
      one.map((value, at) => Math.abs(value - (red[n]?.[at] ?? -9))),
    );
    assert.ok(Math.max(...worst) <= 2, `${found}`);
  };
  near(pixels("yuv422", 2, 1, [85, 76, 255, 150]));
  near(pixels("uyvy", 2, 1, [85, 76, 255, 150]));
  near(pixels("yuv422_yuy2", 2, 1, [76, 85, 150, 255]));
  assert.equal(pixels("yuyv", 3, 1, [76, 85, 150, 255, 80, 85]).length, 3);
});

for (const [pattern, square] of /** @type {[string, number[]][]} */ ([
  ["rggb", [100, 40, 60, 200]],
  ["bggr", [200, 40, 60, 100]],
  ["gbrg", [40, 200, 100, 60]],
  ["grbg", [40, 100, 200, 60]],
]))
  test(`a square of bayer_${pattern} gets the colour that it measures`, () => {
    const color = [100, 50, 200];
    assert.deepEqual(pixels(`bayer_${pattern}8`, 2, 2, square), [color, color, color, color]);
    const doubled = square.flatMap((one) => [7, one]);
    assert.deepEqual(pixels(`bayer_${pattern}16`, 2, 2, doubled)[3], color);
  });

test("a sensor of odd size loses no pixel", () => {
  const rows = pixels("bayer_rggb8", 3, 3, [100, 40, 0, 60, 200, 0, 0, 0, 0]);
  assert.deepEqual(rows[8], [100, 50, 200]);
  assert.equal(pixels("bayer_rggb8", 1, 1, [50]).length, 1);
});

for (const [why, image] of /** @type {[string, Parameters<typeof raw>][]} */ ([
  ["short", ["rgb8", 2, 2, [1, 2, 3]]],
  ["short", ["rgb8", 2, 1, [1, 2, 3, 4, 5, 6], { step: 5 }]],
  ["short", ["16UC1", 2, 1, [1, 2, 3]]],
  ["short", ["yuv422", 16_000, 4000, [1]]],
  ["short", ["bayer_rggb8", 16_000, 4000, [1]]],
  ["large", ["mono8", 2 ** 32 - 1, 1, [1]]],
  ["large", ["rgb8", 16_000, 16_000, [1]]],
  ["empty", ["rgb8", 0, 4, []]],
  ["encoding", ["h264", 2, 2, [1, 2, 3, 4]]],
  ["encoding", ["constructor", 2, 2, [1, 2, 3, 4]]],
  ["encoding", ["64UC1", 1, 1, [1, 2, 3, 4, 5, 6, 7, 8]]],
]))
  test(`an image of ${image[1]} x ${image[2]} ${image[0]} is refused: ${why}`, () => {
    assert.throws(
      () => pictureOf(raw(...image), null),
      (error) => error instanceof ImageError && error.key === `image.trouble.${why}`,
    );
  });

const PNG = [
  0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 2, 128, 0, 0, 1, 224,
];
const JPEG = [
  0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xff, 0xc4, 0, 3, 0, 0xff, 0xc2, 0, 17, 8, 1, 224, 2,
  128,
];

test("how large a file is, is known before it is unpacked", () => {
  assert.deepEqual(sizeOfFile(Uint8Array.from(PNG)), { width: 640, height: 480 });
  assert.deepEqual(sizeOfFile(Uint8Array.from(JPEG)), { width: 640, height: 480 });
});

test("what is neither JPEG nor PNG, or ends too early, has no size", () => {
  for (const all of [PNG, JPEG])
    for (let length = 0; length < all.length; length += 1)
      assert.equal(sizeOfFile(Uint8Array.from(all.slice(0, length))), null);
  assert.equal(sizeOfFile(Uint8Array.from([0xff, 0xd8, ...new Array(40).fill(0xff)])), null);
});

test("a picture fills its frame, and each of its pixels can be found", () => {
  const view = filling({ width: 100, height: 50 }, { width: 400, height: 400 });
  assert.deepEqual(view, { x: 0, y: 100, scale: 4 });
  assert.deepEqual(pixelUnder(view, { x: 399, y: 100 }), { x: 99, y: 0 });
  assert.deepEqual(pixelUnder(view, { x: 0, y: 99 }), { x: 0, y: -1 });
  const close = zoomed(view, 1000, { x: 200, y: 200 }, CLOSEST);
  assert.equal(close.scale, CLOSEST);
  assert.deepEqual(pixelUnder(close, { x: 200, y: 200 }), { x: 50, y: 25 });
});

test("a rate is told from two moments on", () => {
  assert.equal(rateOf([]), null);
  assert.equal(rateOf([4]), null);
  assert.equal(rateOf([4, 4]), null);
  assert.equal(rateOf([4, 4.1, 4.2])?.toFixed(3), "10.000");
});

const WISH = {
  wish: 5,
  topic: "/camera",
  type_name: "",
  mode: /** @type {const} */ ("newest"),
  most_hz: 30,
  reliable: null,
  latched: null,
  depth: null,
};

/** @param {string} typeName @param {any} message what is read; an Error: nothing can be @returns {Promise<Pictured>} what the page is told */
function told(typeName, message) {
  return new Promise((resolve) => {
    const post = (/** @type {any} */ one) => one.kind === "picture" && resolve(one);
    const types = new Types(post);
    types.known.set(typeName, { read: () => message, trouble: "" });
    const pictures = new Pictures(WISH, types, post, null);
    pictures.typeName = typeName;
    pictures.take([{ channel: 1, cdr: new Uint8Array(9), received_s: 2, sent_s: 1, lost: 0 }]);
  });
}

test("an image becomes a picture with what is said of it", async () => {
  const found = await told("sensor_msgs/msg/Image", raw("mono8", 1, 1, [77]));
  assert.deepEqual([found.wish, found.encoding, found.bytes, found.trouble], [5, "mono8", 9, null]);
  assert.deepEqual([...(found.picture?.rgba ?? [])], [77, 77, 77, 255]);
});

for (const [key, typeName, message] of /** @type {[string, string, any][]} */ ([
  ["encoding", "sensor_msgs/msg/Image", raw("h264", 1, 1, [1])],
  ["type", "sensor_msgs/msg/Image", { data: "text" }],
  ["type", "std_msgs/msg/String", { data: "text" }],
  ["type", "sensor_msgs/msg/CompressedImage", { data: "text", format: 3 }],
  [
    "depth",
    "sensor_msgs/msg/CompressedImage",
    { data: new Uint8Array(9), format: "16UC1; compressedDepth png" },
  ],
  ["file", "sensor_msgs/msg/CompressedImage", { data: new Uint8Array(9), format: "webp" }],
  [
    "large",
    "sensor_msgs/msg/CompressedImage",
    { data: Uint8Array.from([...PNG.slice(0, 16), 9, 9, 9, 9, 9, 9, 9, 9]), format: "png" },
  ],
  ["broken", "sensor_msgs/msg/CompressedImage", { data: Uint8Array.from(PNG), format: "png" }],
]))
  test(`what cannot be shown says why: ${key} in ${typeName}`, async (context) => {
    // Node has no pictures; a browser says the same of bytes that are none.
    const unpack = async () => {
      throw new DOMException("no image");
    };
    Object.assign(globalThis, { createImageBitmap: unpack });
    context.after(() => Reflect.deleteProperty(globalThis, "createImageBitmap"));
    const { picture, trouble } = await told(typeName, message);
    assert.equal(picture, null);
    assert.equal(trouble?.key, `image.trouble.${key}`);
  });
