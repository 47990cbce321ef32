/** How large a JPEG or PNG is, by its first bytes: known before anything of it is unpacked. */

const PNG = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
/** Behind these marks of a JPEG is its size; the others of that row are tables. */
const isFrame = (/** @type {number} */ mark) =>
  mark >= 0xc0 && mark <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(mark);

/** @param {Uint8Array} bytes @returns {{width: number, height: number} | null} null: it is neither */
export function sizeOfFile(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length >= 24 && PNG.every((one, n) => bytes[n] === one))
    return { width: view.getUint32(16), height: view.getUint32(20) };
  return bytes[0] === 0xff && bytes[1] === 0xd8 ? sizeOfJpeg(view) : null;
}

/** @param {DataView} view @returns {{width: number, height: number} | null} */
function sizeOfJpeg(view) {
  let at = 2;
  while (at + 9 <= view.byteLength && view.getUint8(at) === 0xff) {
    const mark = view.getUint8(at + 1);
    if (isFrame(mark)) return { height: view.getUint16(at + 5), width: view.getUint16(at + 7) };
    // Marks may be filled up with more of the sign that they begin with.
    at += mark === 0xff ? 1 : 2 + view.getUint16(at + 2);
  }
  return null;
}
