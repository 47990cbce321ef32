/**
 * The line that a turtle draws, as far as the wire tells it.
 *
 * A turtle tells where it is and, on a topic of its own, the colour of the ground below it. Nobody
 * tells of the pen: where a turtle has moved and the ground below it is not bare, it drew in that
 * colour, or crossed a line of it, which looks the same.
 */

/**
 * @typedef {{x: number, y: number}} Point metres, from the lower left corner
 * @typedef {{from: Point, to: Point, color: number}} Stroke
 * @typedef {{time: number, x: number, y: number}} Placed
 * @typedef {{time: number, color: number}} Seen
 */

/** The colour counts that is told so much later: it is that of where the turtle then is. */
const LATER_S = 0.03;
/** So long a colour is waited for. */
const PATIENCE_S = 0.15;
/** A line goes on over bare ground that is seen for no longer: some tell the colour before they draw. */
const BRIDGE_S = 0.1;
/** What was not heard for so long is not known. */
const GAP_S = 0.5;
/** Who stood for so long and has bare ground below it now was not moved: the ground was wiped. */
const STANDING_S = 0.1;
const KEPT = 4000;

export class Trail {
  constructor() {
    /** @type {Placed[]} */
    this.poses = [];
    /** @type {Seen[]} */
    this.colors = [];
    /** @type {Placed | null} */
    this.last = null;
    /** @type {Placed | null} */
    this.drawn = null;
    this.stoodSince_s = Number.POSITIVE_INFINITY;
    this.isOnLine = false;
  }

  /** @param {ArrayLike<number>} times s @param {ArrayLike<number>} x m @param {ArrayLike<number>} y m; what is no number is left out */
  addPoses(times, x, y) {
    for (let n = 0; n < times.length; n += 1) {
      const one = { time: times[n] ?? 0, x: x[n] ?? Number.NaN, y: y[n] ?? Number.NaN };
      if (Number.isFinite(one.x) && Number.isFinite(one.y)) this.poses.push(one);
    }
    this.poses.splice(0, this.poses.length - KEPT);
  }

  /** @param {ArrayLike<number>} times s @param {readonly number[]} colors 0xrrggbb */
  addColors(times, colors) {
    colors.forEach((color, n) => {
      this.colors.push({ time: times[n] ?? 0, color });
    });
    this.colors.splice(0, this.colors.length - KEPT);
  }

  /** The bare ground looks otherwise now. */
  forgetGround() {
    this.isOnLine = false;
  }

  /**
   * @param {(color: number) => boolean} isBare
   * @param {number} unseen the colour of a line where nobody tells any
   * @returns {{strokes: Stroke[], wiped: boolean}} what was drawn since the last time
   */
  take(isBare, unseen) {
    /** @type {{strokes: Stroke[], wiped: boolean}} */
    const found = { strokes: [], wiped: false };
    const newest_s = this.poses.at(-1)?.time ?? 0;
    let [taken, seen] = [0, 0];
    for (const pose of this.poses) {
      while ((this.colors[seen]?.time ?? Number.POSITIVE_INFINITY) < pose.time + LATER_S) seen += 1;
      if (seen === this.colors.length && newest_s - pose.time < PATIENCE_S) break;
      const color = (this.colors[seen] ?? this.colors.at(-1))?.color ?? unseen;
      this.step(pose, color, isBare(color), found);
      taken += 1;
    }
    this.poses.splice(0, taken);
    this.colors.splice(0, Math.min(seen, this.colors.length - 1));
    return found;
  }

  /** @param {Placed} pose @param {number} color @param {boolean} bare @param {{strokes: Stroke[], wiped: boolean}} found */
  step(pose, color, bare, found) {
    const before = this.last && pose.time - this.last.time < GAP_S ? this.last : null;
    const isThere = this.last?.x === pose.x && this.last.y === pose.y;
    this.last = pose;
    if (isThere) this.stand(pose.time, bare, found);
    else if (before) this.move(before, pose, color, bare, found);
    if (!isThere) [this.stoodSince_s, this.isOnLine] = [pose.time, false];
  }

  /** @param {number} time_s @param {boolean} bare @param {{wiped: boolean}} found */
  stand(time_s, bare, found) {
    if (time_s - this.stoodSince_s < STANDING_S) return;
    if (this.isOnLine && bare) found.wiped = true;
    this.isOnLine = !bare;
  }

  /** @param {Placed} before @param {Placed} pose @param {number} color @param {boolean} bare @param {{strokes: Stroke[]}} found */
  move(before, pose, color, bare, found) {
    if (bare) return;
    const goesOn = this.drawn !== null && pose.time - this.drawn.time < BRIDGE_S;
    found.strokes.push({ from: (goesOn && this.drawn) || before, to: pose, color });
    this.drawn = pose;
  }
}
