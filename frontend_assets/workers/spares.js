/**
 * Memory of frames that nobody reads any more. The next frame of that size is put there: to have
 * the same megabytes made anew for each picture of a camera takes longer than to fill them.
 */

const KEPT_MOST = 2;

export class Spares {
  constructor() {
    /** @type {ArrayBuffer[]} */
    this.kept = [];
  }

  /** @param {number} length @returns {Uint8Array<ArrayBuffer>} of any content */
  take(length) {
    const at = this.kept.findIndex((one) => one.byteLength === length);
    const [found] = at < 0 ? [] : this.kept.splice(at, 1);
    return new Uint8Array(found ?? new ArrayBuffer(length));
  }

  /** @param {ArrayBuffer} frame that nobody reads any more */
  give(frame) {
    this.kept = [...this.kept, frame].slice(-KEPT_MOST);
  }

  clear() {
    this.kept = [];
  }
}
