/** What it takes to paint a picture of 1920 x 1080: `node image_painting.mjs` gives ms by encoding. */

import { inkOf } from "../../frontend_assets/lib/image-encodings.js";
import { windowOf } from "../../frontend_assets/lib/image-view.js";

const SIZE = { width: 1920, height: 1080 };
/** All of it, and a panel among others. */
const SIGHTS = [SIZE, { width: 480, height: 270 }];
const RUNS = 25;
/** Bytes of a pixel. */
const ENCODINGS = {
  rgb8: 3,
  bgr8: 3,
  rgba8: 4,
  bgra8: 4,
  mono8: 1,
  mono16: 2,
  "16UC1": 2,
  "32FC1": 4,
  yuv422: 2,
  yuv422_yuy2: 2,
  bayer_rggb8: 1,
  bayer_gbrg16: 2,
};

/** @param {string} encoding @param {number} pixel @returns {number[]} ms for each sight, in the middle */
function measured(encoding, pixel) {
  const step = SIZE.width * pixel;
  const data = Uint8Array.from({ length: step * SIZE.height }, (_, n) => (n * 7) & 127);
  const image = { ...SIZE, encoding, is_bigendian: 0, step, data };
  return SIGHTS.map((sight) => paintingOf(image, sight));
}

function paintingOf(image, sight) {
  const window = windowOf(image, { x: 0, y: 0, scale: sight.width / image.width }, sight);
  const packed = new Uint32Array(window.columns.length * window.rows.length);
  const times = Array.from({ length: RUNS }, () => {
    const began = performance.now();
    const ink = inkOf(image);
    ink.paint(window, packed, ink.numbers?.range ?? { low: 0, high: 255 });
    return performance.now() - began;
  });
  return times.sort((a, b) => a - b)[RUNS >> 1];
}

const found = Object.entries(ENCODINGS).map(([name, pixel]) => [name, measured(name, pixel)]);
process.stdout.write(JSON.stringify(Object.fromEntries(found)));
