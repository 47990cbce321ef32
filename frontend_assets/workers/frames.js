/**
 * Frames of the data lane, as `studio/live/topics/frames.py` writes them: 16 bytes of
 * head, then messages, each with 28 bytes of its own, filled up to a multiple of 8.
 */

const VERSION = 1;
const FRAME_HEAD = 16;
const MESSAGE_HEAD = 28;

/**
 * @typedef {object} Came
 * @property {number} channel
 * @property {Uint8Array} cdr a view of the frame
 * @property {number} received_s since the Unix epoch, by the studio's clock
 * @property {number} sent_s by the sender's clock
 * @property {number} lost of its channel so far
 * @property {() => void} [done] to be called by the one that takes it, once nobody reads its bytes any more
 */

/** A frame that none of our studios writes. */
export class FrameError extends Error {}

/** @param {bigint} time_ns @returns {number} */
const seconds = (time_ns) => Number(time_ns) / 1e9;

/**
 * @param {ArrayBuffer} frame
 * @returns {{dropped: number, messages: Came[]}} `dropped`: for so many this browser was too slow
 * @throws {FrameError}
 */
export function readFrame(frame) {
  const view = new DataView(frame);
  if (frame.byteLength < FRAME_HEAD || view.getUint8(0) !== VERSION)
    throw new FrameError("it is of another version");
  const count = view.getUint32(4, true);
  const messages = [];
  let at = FRAME_HEAD;
  for (let n = 0; n < count; n += 1) {
    const length = at + MESSAGE_HEAD <= frame.byteLength ? view.getUint32(at + 4, true) : 0;
    const end = at + MESSAGE_HEAD + length;
    if (end > frame.byteLength) throw new FrameError("it ends too early");
    messages.push({
      channel: view.getUint32(at, true),
      cdr: new Uint8Array(frame, at + MESSAGE_HEAD, length),
      received_s: seconds(view.getBigInt64(at + 8, true)),
      sent_s: seconds(view.getBigInt64(at + 16, true)),
      lost: view.getUint32(at + 24, true),
    });
    at = (end + 7) & ~7;
  }
  return { dropped: view.getUint32(8, true), messages };
}
