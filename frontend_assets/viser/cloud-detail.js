/** @import { Door } from "./door.js" */
/** @import { Message, Renderer } from "./viser.d.ts" */

/**
 * What three.js knows of a geometry beside what others here lean on.
 * @typedef {object} Ordered
 * @property {{ array: Uint32Array, count: number } | null} index
 * @property {{ position?: { count: number } }} attributes
 * @property {(index: number[] | null) => void} setIndex
 * @property {(start: number, count: number) => void} setDrawRange
 * @property {() => void} dispose
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
/** A number that makes three.js take an index of 32 bits. */
const WIDE = 65_536;

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
  const most = 2 ** Math.ceil(Math.log2(Math.max(count, WIDE)));
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
 * Where pictures with many points come too slowly, a part of each cloud is drawn: half, a quarter, ...
 * of its points, spread evenly. The data is there whole; another browser may draw all of it.
 */
export class CloudDetail {
  #door;
  #tell;
  #share = new Share();
  /** Nodes of points. @type {Set<string>} */
  #clouds = new Set();
  #points = 0;
  #told = 1;
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
      (renderer) => this.#begin(renderer),
      () => this.#end(),
    );
  }

  /** @param {Message} message */
  #read({ type, name, props }) {
    if (!name) return;
    if (type === "PointCloudMessage") this.#clouds.add(name);
    else if (props || type === "RemoveSceneNodeMessage") this.#clouds.delete(name);
  }

  /** @param {Renderer} renderer */
  #begin(renderer) {
    this.#began_ms = performance.now();
    this.#gl ??= contextOf(renderer);
    this.#points = 0;
    for (const geometry of this.#geometries()) this.#points += thin(geometry, this.#share.value);
    this.#say(this.#points ? 1 / this.#share.value : 1);
  }

  /** Of the points that are seen. */
  #geometries() {
    /** @type {Ordered[]} */
    const found = [];
    for (const name of this.#clouds) {
      this.#door.node(name)?.traverseVisible(({ isPoints, geometry }) => {
        if (isPoints && geometry) found.push(/** @type {any} */ (geometry));
      });
    }
    return found;
  }

  /** @param {number} oneIn */
  #say(oneIn) {
    if (oneIn === this.#told) return;
    this.#told = oneIn;
    this.#tell(oneIn);
  }

  /** What was asked of the graphics processor takes its time after all was asked. */
  #end() {
    const gl = this.#gl;
    if (!gl || this.#measures || this.#points <= ALWAYS) return;
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
      this.#took(performance.now() - began_ms);
    };
    setTimeout(look, POLL_MS);
  }

  /** @param {number} picture_ms */
  #took(picture_ms) {
    if (document.hidden) return;
    if (this.#share.took(picture_ms, performance.now(), this.#points)) this.#door.redraw();
  }
}

/** @param {any} renderer as three.js has it @returns {WebGL2RenderingContext | null} */
const contextOf = (renderer) => renderer.getContext?.() ?? null;

/**
 * Draw so large a part of a cloud; answers how many points it has.
 * @param {Ordered} geometry @param {number} share
 */
function thin(geometry, share) {
  const count = geometry.attributes.position?.count ?? 0;
  if (share < 1) setOrder(geometry, orderOf(share, count), count);
  else if (geometry.index) setOrder(geometry, null, Number.POSITIVE_INFINITY);
  return count;
}

/** @param {Ordered} geometry @param {Uint32Array | null} order null: all as they come @param {number} count */
function setOrder(geometry, order, count) {
  if ((geometry.index?.array ?? null) !== order) {
    // The memory of the index before is only given back with all of the geometry's.
    geometry.dispose();
    geometry.setIndex(order && [WIDE]);
    Object.assign(geometry.index ?? {}, order && { array: order, count: order.length });
  }
  geometry.setDrawRange(0, order ? countBelow(order, count) : count);
}
