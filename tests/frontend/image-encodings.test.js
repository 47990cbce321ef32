/** @import { RawImage } from "../../frontend_assets/lib/image-encodings.js" */
/** @import { Window } from "../../frontend_assets/lib/image-view.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { inkOf } from "../../frontend_assets/lib/image-encodings.js";
import { wholeOf, windowOf } from "../../frontend_assets/lib/image-view.js";
import { noisy, slowPixel } from "./support/images.js";

/** Bytes of a pixel. @type {Record<string, number>} */
const ENCODINGS = {
  rgb8: 3,
  bgr8: 3,
  rgba8: 4,
  bgra8: 4,
  "8UC3": 3,
  "8UC4": 4,
  rgb16: 6,
  bgr16: 6,
  rgba16: 8,
  bgra16: 8,
  "16UC3": 6,
  "16UC4": 8,
  mono8: 1,
  "8UC1": 1,
  "8SC1": 1,
  mono16: 2,
  "16UC1": 2,
  "16SC1": 2,
  "32SC1": 4,
  "32FC1": 4,
  "64FC1": 8,
  yuv422: 2,
  uyvy: 2,
  yuv422_yuy2: 2,
  yuyv: 2,
  ...Object.fromEntries(
    ["rggb", "bggr", "gbrg", "grbg"].flatMap((one) => [
      [`bayer_${one}8`, 1],
      [`bayer_${one}16`, 2],
    ]),
  ),
};
const SIZES = [
  [1, 1],
  [2, 1],
  [1, 3],
  [7, 5],
  [8, 6],
];
const PADDING = [0, 1, 8];
/** Where a message's bytes begin in the frame that they came in. */
const BEGINS = [0, 3];
const RANGE = { low: 40, high: 50_000 };

/** @param {RawImage} image @param {Window} window @returns {number[][]} RGBA of each pixel that is seen */
function painted(image, window) {
  const packed = new Uint32Array(window.columns.length * window.rows.length);
  inkOf(image).paint(window, packed, RANGE);
  const bytes = [...new Uint8Array(packed.buffer)];
  return Array.from(packed, (_, n) => bytes.slice(4 * n, 4 * n + 4));
}

/** @param {RawImage} image @param {Window} window @returns {number[][]} */
const expected = (image, { columns, rows }) =>
  [...rows].flatMap((y) => [...columns].map((x) => slowPixel(image, x, y, RANGE).rgba));

/** @param {number[][]} found @param {number[][]} wanted @param {string} where */
function assertNear(found, wanted, where) {
  assert.equal(found.length, wanted.length, where);
  const apart = found.flatMap((one, n) =>
    one.map((byte, at) => Math.abs(byte - (wanted[n]?.[at] ?? 0))),
  );
  // Halves are rounded one way or the other.
  assert.ok(Math.max(...apart) <= 1, `${where}: ${found} instead of ${wanted}`);
}

/** @param {string} encoding @returns {RawImage[]} of every size, order of bytes, padding and place */
const images = (encoding) =>
  SIZES.flatMap(([width = 1, height = 1]) =>
    PADDING.flatMap((padding) =>
      BEGINS.flatMap((begin) =>
        [0, 1].map((is_bigendian) => {
          const step = width * (ENCODINGS[encoding] ?? 0) + padding;
          return noisy({ encoding, width, height, step, is_bigendian }, begin);
        }),
      ),
    ),
  );

for (const encoding of Object.keys(ENCODINGS))
  test(`${encoding} shows what a slow reader finds, in both orders of bytes, with odd sizes and longer rows`, () => {
    for (const image of images(encoding)) {
      const { width, height, step, is_bigendian } = image;
      const where = `${width} x ${height}, step ${step}, ${is_bigendian ? "big" : "little"} end first`;
      const whole = wholeOf(image);
      assertNear(painted(image, whole), expected(image, whole), where);
      const zoomed = windowOf(image, { x: -1, y: 0.4, scale: 1.7 }, { width: 11, height: 4 });
      assertNear(painted(image, zoomed), expected(image, zoomed), `zoomed ${where}`);
    }
  });

for (const encoding of Object.keys(ENCODINGS))
  test(`a pixel of ${encoding} is told as it was measured`, () => {
    for (const image of images(encoding)) {
      const ink = inkOf(image);
      for (let y = 0; y < image.height; y += 1)
        for (let x = 0; x < image.width; x += 1) {
          const { values, isExact } = slowPixel(image, x, y, RANGE);
          const found = ink.at(x, y);
          const apart = found.map((one, n) => Math.abs(one - (values[n] ?? 0)));
          if (isExact) assert.deepEqual(found, values);
          else assert.ok(Math.max(...apart) <= 1, `${found} instead of ${values}`);
        }
    }
  });
