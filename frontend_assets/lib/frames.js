/** Binary frames of the control lane; multi-byte values are little-endian. */

const JOINTS = 1;
const HEADER_BYTES = 8;

/**
 * @param {ArrayBuffer} data
 * @returns {{revision: number, positions: Float64Array} | null} null for a frame of another kind
 */
export function readJointFrame(data) {
  if (data.byteLength < HEADER_BYTES) return null;
  const view = new DataView(data);
  if (view.getUint8(0) !== JOINTS || (data.byteLength - HEADER_BYTES) % 8) return null;
  return { revision: view.getUint32(4, true), positions: new Float64Array(data, HEADER_BYTES) };
}
