/**
 * Paths into a message: `.pose.position.x`, `.ranges[3]`, `.linear.@norm`, `.orientation.@yaw.@deg`.
 *
 * What stands behind an `@` is worked out: the length of a vector, an angle in another unit, the
 * angle of a quaternion about an axis (radians, as `tf2` names them).
 */

/** @typedef {{field: string} | {index: number} | {work: Work}} Step */
/** @typedef {"norm" | "deg" | "rad" | "length" | "roll" | "pitch" | "yaw"} Work */

const STEP = /\.@(norm|deg|rad|length|roll|pitch|yaw)|\.([A-Za-z_]\w*)|\[(-?\d{1,9})\]/y;

/** @param {string} path @returns {Step[] | null} null: it is none */
export function stepsOf(path) {
  const text = path.trim();
  /** @type {Step[]} */
  const steps = [];
  STEP.lastIndex = 0;
  while (STEP.lastIndex < text.length) {
    const [whole, work, field, index] = STEP.exec(text) ?? [];
    if (whole === undefined) return null;
    if (work) steps.push({ work: /** @type {Work} */ (work) });
    else if (field) steps.push({ field });
    else steps.push({ index: Number(index) });
  }
  return steps;
}

/** @param {any} value @param {Step} step @returns {any} undefined: there is none */
function stepInto(value, step) {
  if (value === null || value === undefined) return undefined;
  if ("field" in step)
    return typeof value === "object" && Object.hasOwn(value, step.field)
      ? value[step.field]
      : undefined;
  if ("index" in step)
    return isList(value)
      ? value[step.index < 0 ? value.length + step.index : step.index]
      : undefined;
  return worked(value, step.work);
}

/** @param {any} value @returns {boolean} */
export const isList = (value) => Array.isArray(value) || ArrayBuffer.isView(value);

/** @param {any} value @param {Work} work @returns {number} */
function worked(value, work) {
  if (work === "deg") return (numberOf(value) * 180) / Math.PI;
  if (work === "rad") return (numberOf(value) * Math.PI) / 180;
  if (work === "length")
    return isList(value) || typeof value === "string" ? value.length : Number.NaN;
  if (work !== "norm") return angleOf(value, work);
  const parts = typeof value === "object" ? Object.values(value).map(numberOf) : [Number.NaN];
  return Math.hypot(...parts.slice(0, 64));
}

/** @param {any} value a quaternion @param {"roll" | "pitch" | "yaw"} work @returns {number} rad; NaN of anything else */
function angleOf(value, work) {
  const part = (/** @type {string} */ axis) => numberOf(value[axis]);
  const [x, y, z, w] = [part("x"), part("y"), part("z"), part("w")];
  const norm = x * x + y * y + z * z + w * w;
  if (work === "roll") return Math.atan2(2 * (w * x + y * z), norm - 2 * (x * x + y * y));
  if (work === "yaw") return Math.atan2(2 * (w * z + x * y), norm - 2 * (y * y + z * z));
  return Math.asin(Math.min(1, Math.max(-1, (2 * (w * y - z * x)) / norm)));
}

/** @param {any} message @param {readonly Step[]} steps @returns {any} undefined: it has none there */
export function valueAt(message, steps) {
  let value = message;
  for (const step of steps) value = stepInto(value, step);
  return value;
}

/** @param {any} value @returns {number} NaN of what is no number; a time in seconds */
export function numberOf(value) {
  if (typeof value === "number") return value;
  if (typeof value === "bigint" || typeof value === "boolean") return Number(value);
  if (typeof value === "object" && value !== null && "sec" in value && "nanosec" in value)
    return Number(value.sec) + Number(value.nanosec) / 1e9;
  return Number.NaN;
}

/** @param {any} message @param {readonly Step[]} steps @returns {number} NaN: it has no number there */
export const numberAt = (message, steps) => numberOf(valueAt(message, steps));
