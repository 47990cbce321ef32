/** @import { Range, RawImage } from "../../frontend_assets/lib/image-encodings.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { ImageError, inkOf } from "../../frontend_assets/lib/image-encodings.js";
import {
  average,
  CLOSEST,
  FARTHEST,
  filling,
  pixelUnder,
  rateOf,
  ratioFor,
  viewWithin,
  wholeOf,
  windowOf,
} from "../../frontend_assets/lib/image-view.js";
import { zoomed } from "../../frontend_assets/lib/pan-zoom.js";
import { sizeOfFile } from "../../frontend_assets/workers/pictures.js";
import { PNG, raw } from "./support/images.js";

const FROM_BYTES = { low: 0, high: 255 };

/** @param {Parameters<typeof raw>} image @returns {number[][]} every pixel, row by row */
function pixels(...image) {
  const read = raw(...image);
  const ink = inkOf(read);
  return Array.from({ length: read.width * read.height }, (_, n) =>
    ink.at(n % read.width, Math.floor(n / read.width)),
  );
}

/** @param {RawImage} read @param {Range} [range] @returns {number[]} RGBA of all of it */
function painted(read, range) {
  const ink = inkOf(read);
  const packed = new Uint32Array(read.width * read.height);
  ink.paint(wholeOf(read), packed, range ?? ink.numbers?.range ?? FROM_BYTES);
  return [...new Uint8Array(packed.buffer)];
}

for (const [encoding, bytes] of /** @type {[string, number[]][]} */ ([
  ["rgb8", [10, 20, 30, 40, 50, 60]],
  ["bgr8", [30, 20, 10, 60, 50, 40]],
  ["8UC3", [30, 20, 10, 60, 50, 40]],
  ["rgba8", [10, 20, 30, 9, 40, 50, 60, 9]],
  ["bgra8", [30, 20, 10, 9, 60, 50, 40, 9]],
  ["8UC4", [30, 20, 10, 9, 60, 50, 40, 9]],
  ["rgb16", [10, 0, 20, 0, 30, 0, 40, 0, 50, 0, 60, 0]],
]))
  test(`${encoding} gives red, green and blue, and hides nothing`, () => {
    assert.deepEqual(pixels(encoding, 2, 1, bytes), [
      [10, 20, 30],
      [40, 50, 60],
    ]);
    const opaque = painted(raw(encoding, 2, 1, bytes)).filter((_, n) => n % 4 === 3);
    assert.deepEqual(opaque, [255, 255]);
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
  assert.deepEqual(pixels("rgb16", 1, 1, [9, 1, 8, 1, 7, 1], { is_bigendian: 1 }), [
    [0x0901, 0x0801, 0x0701],
  ]);
  assert.deepEqual(painted(raw("rgb16", 1, 1, [1, 9, 1, 8, 1, 7])), [9, 8, 7, 255]);
  assert.deepEqual(pixels("16SC1", 1, 1, [0xff, 0xff]), [[-1]]);
});

test("depth in millimetres has no value where nothing was measured, and is shaded between the others", () => {
  const depth = raw("16UC1", 3, 1, [0, 0, 0xe8, 3, 0xd0, 7]);
  const ink = inkOf(depth);
  assert.deepEqual(ink.numbers, { range: { low: 1000, high: 2000 }, unit: "mm" });
  assert.deepEqual(ink.at(0, 0), [Number.NaN]);
  assert.deepEqual(painted(depth), [0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255]);
});

test("depth in metres may be anything, and a chosen range holds", () => {
  const metres = Float32Array.of(0.5, Number.NaN, 3, Infinity, -Infinity, 0.75);
  const depth = raw("32FC1", 6, 1, [...new Uint8Array(metres.buffer)]);
  assert.deepEqual(inkOf(depth).numbers, { range: { low: 0.5, high: 3 }, unit: "m" });
  const bytes = painted(depth, { low: 0, high: 1 });
  assert.deepEqual(
    bytes.filter((_, n) => n % 4 === 0),
    [128, 0, 255, 0, 0, 191],
  );
  assert.deepEqual(
    bytes.filter((_, n) => n % 4 === 3),
    [255, 0, 255, 0, 0, 255],
  );
});

test("where all numbers are one, or none is there, there still is a range", () => {
  const nothing = raw("32FC1", 1, 1, [...new Uint8Array(Float32Array.of(Number.NaN).buffer)]);
  assert.deepEqual(inkOf(nothing).numbers?.range, { low: 0, high: 1 });
  assert.deepEqual(painted(raw("16UC1", 1, 1, [7, 0])), [0, 0, 0, 255]);
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
      () => inkOf(raw(...image)),
      (error) => error instanceof ImageError && error.key === `image.trouble.${why}`,
    );
  });

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
  const large = filling({ width: 16_384, height: 16_384 }, { width: 200, height: 200 });
  assert.ok(zoomed(large, 0.9, { x: 0, y: 0 }, CLOSEST, FARTHEST).scale < large.scale);
});

test("a canvas has the pixels of the screen, up to as many as a large one has", () => {
  assert.equal(ratioFor({ width: 0, height: 0 }, 1.5), 1.5);
  assert.equal(ratioFor({ width: 800, height: 600 }, 2), 2);
  assert.equal(ratioFor({ width: 4000, height: 4000 }, 3), 0.5);
});

test("each pixel of the screen shows the one of the picture that is under its middle", () => {
  const picture = { width: 4, height: 2 };
  const sight = { width: 8, height: 8, ratio: 1, view: null };
  const seen = windowOf(picture, viewWithin(picture, sight), sight);
  assert.deepEqual(
    [seen.left, seen.top, [...seen.columns], [...seen.rows]],
    [0, 2, [0, 0, 1, 1, 2, 2, 3, 3], [0, 0, 1, 1]],
  );
  const small = { ...sight, width: 2 };
  assert.deepEqual([...windowOf(picture, viewWithin(picture, small), small).columns], [1, 3]);
  const fine = { ...sight, width: 16, height: 16, ratio: 2 };
  assert.deepEqual(viewWithin(picture, fine), { x: 0, y: 4, scale: 4 });
});

test("a picture that a person moved lies there on a screen of any fineness", () => {
  const sight = { width: 20, height: 20, ratio: 2, view: { x: 3, y: -1, scale: 0.5 } };
  assert.deepEqual(viewWithin({ width: 9, height: 9 }, sight), { x: 6, y: -2, scale: 1 });
});

test("of a picture that was moved, what is outside of the frame is not painted", () => {
  const picture = { width: 100, height: 100 };
  const at = (/** @type {number} */ x, /** @type {number} */ scale) =>
    windowOf(picture, { x, y: 0, scale }, { width: 10, height: 10 });
  assert.deepEqual([...at(-30, 1).columns], [30, 31, 32, 33, 34, 35, 36, 37, 38, 39]);
  assert.deepEqual([at(7, 1).left, ...at(7, 1).columns], [7, 0, 1, 2]);
  assert.deepEqual([...at(-6390, 64).columns], new Array(10).fill(99));
  for (const x of [10, 1e9, -101, -1e9, Number.NaN])
    assert.equal(at(x, 1).columns.length, 0, `${x}`);
});

test("what is thinner than a pixel of the screen is seen nevertheless", () => {
  const picture = { width: 16_384, height: 1 };
  const sight = { width: 100, height: 100, ratio: 1, view: null };
  const seen = windowOf(picture, viewWithin(picture, sight), sight);
  assert.deepEqual([seen.columns.length, [...seen.rows]], [100, [0]]);
});

test("of a picture that is made smaller, each pixel of the screen is the middle of four", () => {
  const picture = { width: 12, height: 4 };
  const view = { x: 1, y: 0, scale: 0.25 };
  const canvas = { width: 9, height: 9 };
  const seen = windowOf(picture, view, canvas, 2);
  assert.deepEqual(
    [seen.left, [...seen.columns], [...seen.rows]],
    [1, [1, 3, 5, 7, 9, 11], [1, 3]],
  );
  const bytes = (/** @type {number[]} */ ...each) => new Uint32Array(new Uint8Array(each).buffer);
  const fine = bytes(
    ...[0, 10, 255, 255, 1, 20, 255, 255, 200, 0, 0, 255, 200, 0, 0, 255],
    ...[2, 30, 255, 255, 4, 41, 255, 255, 100, 0, 0, 255, 100, 0, 0, 255],
  );
  const packed = new Uint32Array(2);
  average(fine, packed, 2);
  assert.deepEqual([...new Uint8Array(packed.buffer)], [2, 25, 255, 255, 150, 0, 0, 255]);
});

test("a rate is told from two moments on", () => {
  assert.equal(rateOf([]), null);
  assert.equal(rateOf([4]), null);
  assert.equal(rateOf([4, 4]), null);
  assert.equal(rateOf([4, 4.1, 4.2])?.toFixed(3), "10.000");
});
