/** @import { Door } from "./door.js" */
/** @import { Message } from "./viser.d.ts" */

import { isSeen } from "./extent.js";

/**
 * The data of a cloud as it came: three numbers for each point, and three bytes, or three for all.
 * @typedef {object} Whole
 * @property {Uint16Array | Float32Array} points
 * @property {Uint8Array} colors
 */

/** A picture that takes longer than this is slow, two in a row are too many. */
const SLOW_MS = 120;
/** A picture quicker than this leaves room for twice as many points ... */
const QUICK_MS = 30;
/** ... once it was so for this long; longer each time that it proved wrong. */
const PATIENCE_MS = 3000;
const PATIENCE_MAX_MS = 60_000;
/** So many points are always drawn: if pictures are slow then, it is not for them. */
const ALWAYS = 30_000;
const POLL_MS = 4;
/** Multiples of the golden ratio modulo 1 fill a circle evenly, however many there are. */
const GOLDEN = 2_654_435_769;
const CIRCLE = 2 ** 32;
const FIRST_ORDER = 65_536;

/** Which part of all points is drawn, by how long pictures take. */
export class Share {
  value = 1;
  #slow = 0;
  #patience_ms = PATIENCE_MS;
  /** @type {number | null} */
  #quickFrom_ms = null;
  #raised = false;

  /**
   * @param {number} picture_ms how long a picture took
   * @param {number} now_ms
   * @param {number} points of all clouds
   * @returns {boolean} whether another part is drawn from now on
   */
  took(picture_ms, now_ms, points) {
    if (picture_ms > SLOW_MS) return this.#lower(points);
    this.#slow = 0;
    if (picture_ms > QUICK_MS || this.value >= 1) {
      this.#quickFrom_ms = null;
      return false;
    }
    this.#quickFrom_ms ??= now_ms;
    return now_ms - this.#quickFrom_ms >= this.#patience_ms && this.#raise();
  }

  /** @param {number} points */
  #lower(points) {
    this.#quickFrom_ms = null;
    this.#slow += 1;
    if (this.#slow < 2 || (points * this.value) / 2 < ALWAYS) return false;
    this.#slow = 0;
    if (this.#raised) this.#patience_ms = Math.min(2 * this.#patience_ms, PATIENCE_MAX_MS);
    this.#raised = false;
    this.value /= 2;
    return true;
  }

  #raise() {
    this.#quickFrom_ms = null;
    this.#raised = true;
    this.value *= 2;
    return true;
  }
}

/** By share: the numbers of points that are drawn, ascending; of fewer points it is a beginning. @type {Map<number, Uint32Array>} */
const orders = new Map();

/**
 * Which of many points are drawn, spread evenly over them, and the same ones each time.
 * @param {number} share a half, a quarter, ... @param {number} count of points
 */
export function orderOf(share, count) {
  const known = orders.get(share);
  const last = known?.at(-1) ?? -1;
  if (known && last + 1 / share >= count) return known;
  const most = 2 ** Math.ceil(Math.log2(Math.max(count, FIRST_ORDER)));
  const order = new Uint32Array(Math.ceil(most * share) + 1);
  const below = share * CIRCLE;
  let length = 0;
  for (let point = 0, key = 0; point < most; point += 1, key = (key + GOLDEN) % CIRCLE)
    if (key < below) order[length++] = point;
  const made = order.slice(0, length);
  orders.set(share, made);
  return made;
}

/** How many of an order are below a number. @param {Uint32Array} order @param {number} count */
export function countBelow(order, count) {
  let low = 0;
  let high = order.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (/** @type {number} */ (order[middle]) < count) low = middle + 1;
    else high = middle;
  }
  return low;
}

/**
 * That part of what a cloud holds: other arrays, or the same for all points.
 * @param {Whole} whole @param {number} share @returns {Whole}
 */
export function partOf({ points, colors }, share) {
  if (share >= 1) return { points, colors };
  const count = points.length / 3;
  const whole = orderOf(share, count);
  const order = whole.subarray(0, countBelow(whole, count));
  return {
    points: gathered(points, order),
    colors: colors.length > 3 ? gathered(colors, order) : colors,
  };
}

/**
 * @template {Uint16Array | Float32Array | Uint8Array} T
 * @param {T} rows three numbers each @param {Uint32Array} order
 */
function gathered(rows, order) {
  const part = /** @type {T} */ (rows.slice(0, 3 * order.length));
  for (let at = 0; at < order.length; at += 1) {
    const from = 3 * /** @type {number} */ (order[at]);
    part[3 * at] = /** @type {number} */ (rows[from]);
    part[3 * at + 1] = /** @type {number} */ (rows[from + 1]);
    part[3 * at + 2] = /** @type {number} */ (rows[from + 2]);
  }
  return part;
}

/**
 * Where pictures with many points come too slowly, a part of each cloud is drawn: half, a quarter, ...
 * of its points, spread evenly. All of it has come; another browser may draw all of it.
 */
export class CloudDetail {
  #door;
  #tell;
  #share = new Share();
  /** By node. @type {Map<string, Whole>} */
  #clouds = new Map();
  #answer = 1;
  #began_ms = 0;
  /** @type {WebGL2RenderingContext | null} */
  #gl = null;
  #measures = false;

  /** @param {Door} door @param {(oneIn: number) => void} tell one in so many points is drawn */
  constructor(door, tell) {
    this.#door = door;
    this.#tell = tell;
    // Who compares pictures wants the same ones however busy the machine is.
    if (document.documentElement.dataset.pixels === "fixed") return;
    door.onMessage((message) => this.#read(message));
    door.onPicture(
      (renderer) => {
        this.#began_ms = performance.now();
        this.#gl ??= contextOf(renderer);
      },
      () => this.#measure(),
    );
  }

  /** Take note of what a cloud holds, and leave viser a part of it. @param {Message} message */
  #read(message) {
    const { type, name, props, updates } = message;
    if (!name) return;
    if (props || type === "RemoveSceneNodeMessage") this.#clouds.delete(name);
    if (type === "PointCloudMessage" && props) message.props = this.#taken(name, props);
    else if (updates?.points && this.#clouds.has(name))
      message.updates = this.#taken(name, updates);
    this.#say();
  }

  /** @param {string} name @param {Record<string, unknown>} values */
  #taken(name, values) {
    const whole = /** @type {Whole} */ (/** @type {unknown} */ (values));
    this.#clouds.set(name, { points: whole.points, colors: whole.colors });
    return this.#share.value < 1 ? { ...values, ...partOf(whole, this.#share.value) } : values;
  }

  /** Which points of a cloud are drawn, by their numbers in all of it; null: all are. @param {string} name of its node */
  drawnRows(name) {
    const whole = this.#clouds.get(name);
    if (!whole || this.#share.value >= 1) return null;
    const order = orderOf(this.#share.value, whole.points.length / 3);
    return order.subarray(0, countBelow(order, whole.points.length / 3));
  }

  /** All points of a cloud as they came; null: it is not known here. @param {string} name of its node */
  wholePoints(name) {
    return this.#clouds.get(name)?.points ?? null;
  }

  #say() {
    const oneIn = this.#clouds.size ? 1 / this.#share.value : 1;
    if (oneIn === this.#answer) return;
    this.#answer = oneIn;
    this.#tell(oneIn);
  }

  /** Of all clouds that are seen. */
  #points() {
    let points = 0;
    for (const [name, { points: rows }] of this.#clouds)
      if (isSeen(this.#door.node(name))) points += rows.length / 3;
    return points;
  }

  /** What was asked of the graphics processor takes its time after all was asked. */
  #measure() {
    const gl = this.#gl;
    const points = this.#points();
    if (!gl || this.#measures || points <= ALWAYS) return;
    const done = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!done) return;
    gl.flush();
    this.#measures = true;
    const began_ms = this.#began_ms;
    const look = () => {
      if (!gl.isContextLost() && gl.getSyncParameter(done, gl.SYNC_STATUS) !== gl.SIGNALED) {
        setTimeout(look, POLL_MS);
        return;
      }
      gl.deleteSync(done);
      this.#measures = false;
      const now_ms = performance.now();
      if (!document.hidden && this.#share.took(now_ms - began_ms, now_ms, points)) this.#redraw();
    };
    setTimeout(look, POLL_MS);
  }

  /** Draw another part of each cloud from now on. */
  #redraw() {
    this.#door.inject(
      ...[...this.#clouds].map(([name, whole]) => ({
        type: "SceneNodeUpdateMessage",
        name,
        owner: "",
        updates: { ...partOf(whole, this.#share.value) },
      })),
    );
    this.#say();
  }
}

/** @param {any} renderer as three.js has it @returns {WebGL2RenderingContext | null} */
const contextOf = (renderer) => renderer.getContext?.() ?? null;
