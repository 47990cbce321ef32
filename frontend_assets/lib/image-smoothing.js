/** A picture that is made smaller: where a pixel of the screen covers many, it shows what they have in common. */

/** Two of four bytes, with room for the sum of four of each. */
const EVERY_OTHER = 0x00ff00ff;
/** Halves are rounded up. */
const HALVES = 0x00020002;

/**
 * @param {Uint32Array} fine RGBA, two columns and two rows for each pixel
 * @param {Uint32Array} packed RGBA, of which every pixel is the middle of its four
 * @param {number} width of `packed`
 */
export function average(fine, packed, width) {
  for (let begin = 0; begin < packed.length; begin += width)
    averageRow(fine, 4 * begin, packed, begin, width);
}

/** @param {Uint32Array} fine @param {number} from @param {Uint32Array} packed @param {number} to @param {number} width */
function averageRow(fine, from, packed, to, width) {
  for (let n = 0; n < width; n += 1) {
    const at = from + 2 * n;
    packed[to + n] = middleOf(
      fine[at] ?? 0,
      fine[at + 1] ?? 0,
      fine[at + 2 * width] ?? 0,
      fine[at + 2 * width + 1] ?? 0,
    );
  }
}

/** @param {number} a @param {number} b @param {number} c @param {number} d @returns {number} */
function middleOf(a, b, c, d) {
  const lower =
    (a & EVERY_OTHER) + (b & EVERY_OTHER) + (c & EVERY_OTHER) + (d & EVERY_OTHER) + HALVES;
  const upper =
    ((a >>> 8) & EVERY_OTHER) +
    ((b >>> 8) & EVERY_OTHER) +
    ((c >>> 8) & EVERY_OTHER) +
    ((d >>> 8) & EVERY_OTHER) +
    HALVES;
  return ((lower >>> 2) & EVERY_OTHER) | (((upper >>> 2) & EVERY_OTHER) << 8);
}
