/**
 * Reads messages out of plain CDR (XCDR1), by what the studio tells of their type.
 *
 * What comes may be anything: whatever is wrong with it ends in a CdrError, and nothing is made
 * that is larger than the bytes that came allow.
 */

/** @import { FieldView, MessageView } from "../types/wire.d.ts" */

/** The bytes are no such message, or its type is none that can be read. */
export class CdrError extends Error {}

/** @typedef {(cursor: Cursor) => any} Read */
/** @typedef {{read: Read, least: number}} Part how a value is read, and of how many bytes it is at least */
/** @typedef {new (buffer: ArrayBufferLike, offset: number, length: number) => ArrayLike<number | bigint>} NumberArray */

const HEAD = 4;
const DEPTH_MAX = 64;
const HOST_IS_LITTLE = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
const EMPTY = { least: 1, read: (/** @type {Cursor} */ cursor) => skipDummy(cursor) };
const SHORT = 32;
const decoder = new TextDecoder();

/** Where in the body of a message one is; it begins behind the head. */
class Cursor {
  /** @param {Uint8Array} cdr */
  constructor(cdr) {
    if (cdr.length < HEAD || cdr[0] !== 0 || (cdr[1] ?? 2) > 1)
      throw new CdrError("it does not begin with the head of plain CDR");
    this.little = cdr[1] === 1;
    this.bytes = cdr.subarray(HEAD);
    this.view = new DataView(cdr.buffer, cdr.byteOffset + HEAD, cdr.byteLength - HEAD);
    this.at = 0;
  }

  /** @param {number} size of a number, and what its place is a multiple of @returns {number} its place */
  step(size) {
    const at = (this.at + size - 1) & -size;
    this.at = this.checked(at, size);
    return at;
  }

  /** @param {number} at @param {number} bytes @returns {number} the place behind them */
  checked(at, bytes) {
    const end = at + bytes;
    if (end > this.bytes.length)
      throw new CdrError(`it has ${this.bytes.length + HEAD} bytes, which is too few`);
    return end;
  }

  /** @param {number} least bytes of each @returns {number} how many follow */
  count(least) {
    const count = this.view.getUint32(this.step(4), this.little);
    if (count * least > this.bytes.length - this.at)
      throw new CdrError(`it tells of ${count} values, for which it has too few bytes`);
    return count;
  }
}

/** @typedef {(view: DataView, at: number, little: boolean) => number | bigint | boolean} ReadNumber */

/** @param {NumberArray & {BYTES_PER_ELEMENT: number}} list @param {ReadNumber} read */
const number = (list, read) => ({ size: list.BYTES_PER_ELEMENT, list, read });
const byte = number(Uint8Array, (view, at) => view.getUint8(at));

/** @type {Record<string, {size: number, read: ReadNumber, list: NumberArray}>} */
const NUMBERS = {
  bool: number(Uint8Array, (view, at) => view.getUint8(at) !== 0),
  byte,
  char: byte,
  uint8: byte,
  int8: number(Int8Array, (view, at) => view.getInt8(at)),
  uint16: number(Uint16Array, (view, at, little) => view.getUint16(at, little)),
  int16: number(Int16Array, (view, at, little) => view.getInt16(at, little)),
  uint32: number(Uint32Array, (view, at, little) => view.getUint32(at, little)),
  int32: number(Int32Array, (view, at, little) => view.getInt32(at, little)),
  uint64: number(BigUint64Array, (view, at, little) => view.getBigUint64(at, little)),
  int64: number(BigInt64Array, (view, at, little) => view.getBigInt64(at, little)),
  float32: number(Float32Array, (view, at, little) => view.getFloat32(at, little)),
  float64: number(Float64Array, (view, at, little) => view.getFloat64(at, little)),
};

/**
 * @param {readonly MessageView[]} messages a type and all that it is made of
 * @param {string} name of the type
 * @returns {(cdr: Uint8Array) => any} reads one message; arrays of numbers are views of it where that is possible
 * @throws {CdrError} the type cannot be read
 */
export function readerOf(messages, name) {
  const known = new Map(messages.map((one) => [one.name, one]));
  const { read } = messagePart(known, name, 0);
  return (cdr) => read(new Cursor(cdr));
}

/** @param {Map<string, MessageView>} known @param {string} name @param {number} depth @returns {Part} */
function messagePart(known, name, depth) {
  const message = known.get(name);
  if (!message) throw new CdrError(`the type ${name} is not known`);
  if (depth > DEPTH_MAX) throw new CdrError(`the type ${name} is part of itself`);
  if (message.fields.length === 0) return EMPTY;
  const names = message.fields.map((field) => field.name);
  const parts = message.fields.map((field) => fieldPart(known, field, depth));
  const reads = parts.map(({ read }) => read);
  return {
    least: parts.reduce((sum, { least }) => sum + least, 0),
    read(cursor) {
      /** @type {Record<string, any>} */
      const value = {};
      for (let n = 0; n < reads.length; n += 1)
        value[/** @type {string} */ (names[n])] = /** @type {Read} */ (reads[n])(cursor);
      return value;
    },
  };
}

/** A type without fields has one byte. @param {Cursor} cursor */
function skipDummy(cursor) {
  cursor.step(1);
  return {};
}

/** @param {Map<string, MessageView>} known @param {FieldView} field @param {number} depth @returns {Part} */
function fieldPart(known, { base, shape, count }, depth) {
  if (shape === "single") return valuePart(known, base, depth);
  const isFixed = shape === "array";
  const isNumber = Object.hasOwn(NUMBERS, base);
  const part = isNumber && base !== "bool" ? null : valuePart(known, base, depth);
  const least = part?.least ?? NUMBERS[base]?.size ?? 1;
  const all = part ? listOf(part.read) : numbersOf(base);
  return {
    least: isFixed ? count * least : 4,
    read: (cursor) => all(cursor, isFixed ? count : cursor.count(least)),
  };
}

/** @param {Map<string, MessageView>} known @param {string} base @param {number} depth @returns {Part} */
function valuePart(known, base, depth) {
  if (base === "string") return { least: 4, read: readText };
  if (base === "wstring")
    throw new CdrError("it has a text of wide letters, which no two systems write alike");
  const kind = Object.hasOwn(NUMBERS, base) ? NUMBERS[base] : undefined;
  if (!kind) return messagePart(known, base, depth + 1);
  const { size, read } = kind;
  return { least: size, read: (cursor) => read(cursor.view, cursor.step(size), cursor.little) };
}

/** @param {Read} read @returns {(cursor: Cursor, count: number) => any[]} */
const listOf = (read) => (cursor, count) => {
  const values = [];
  for (let n = 0; n < count; n += 1) values.push(read(cursor));
  return values;
};

/** @param {string} base @returns {(cursor: Cursor, count: number) => ArrayLike<number | bigint>} */
function numbersOf(base) {
  const { size, list: NumberList } = /** @type {typeof NUMBERS[string]} */ (NUMBERS[base]);
  return (cursor, count) => {
    if (count === 0) return new NumberList(new ArrayBuffer(0), 0, 0);
    const at = (cursor.at + size - 1) & -size;
    cursor.at = cursor.checked(at, count * size);
    const place = cursor.view.byteOffset + at;
    if (place % size === 0 && cursor.little === HOST_IS_LITTLE)
      return new NumberList(cursor.view.buffer, place, count);
    const own = cursor.bytes.slice(at, at + count * size);
    if (cursor.little !== HOST_IS_LITTLE) turn(own, size);
    return new NumberList(own.buffer, 0, count);
  };
}

/** Turn the order of bytes of every number. @param {Uint8Array} bytes @param {number} size */
function turn(bytes, size) {
  for (let at = 0; at < bytes.length; at += size) bytes.subarray(at, at + size).reverse();
}

/** @param {Cursor} cursor @returns {string} */
function readText(cursor) {
  const length = cursor.count(1);
  const begin = cursor.at;
  cursor.at += length;
  // Its end is marked by a zero, which some leave out of an empty one.
  const end = length > 0 && cursor.bytes[cursor.at - 1] === 0 ? cursor.at - 1 : cursor.at;
  return textOf(cursor.bytes, begin, end);
}

/** @param {Uint8Array} bytes @param {number} begin @param {number} end @returns {string} */
function textOf(bytes, begin, end) {
  if (end - begin > SHORT) return decoder.decode(bytes.subarray(begin, end));
  let text = "";
  for (let at = begin; at < end; at += 1) {
    const code = bytes[at] ?? 0;
    if (code > 127) return decoder.decode(bytes.subarray(begin, end));
    text += String.fromCharCode(code);
  }
  return text;
}
