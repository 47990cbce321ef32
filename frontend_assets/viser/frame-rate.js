/** Two pictures may come this much early: screens do not keep their time to the microsecond. */
const EARLY_MS = 2;

/**
 * Draws at most so many pictures a second: whatever in this frame asks for the next picture waits
 * its turn. 0: as many as the screen shows.
 */
export class FrameRate {
  #interval_ms = 0;
  #last_ms = Number.NEGATIVE_INFINITY;
  #ask;
  #cancel;
  /** By the handle that was given out: the one it waits with now. @type {Map<number, number>} */
  #waiting = new Map();

  /** @param {Pick<Window, "requestAnimationFrame" | "cancelAnimationFrame">} view its own frame */
  constructor(view) {
    this.#ask = view.requestAnimationFrame.bind(view);
    this.#cancel = view.cancelAnimationFrame.bind(view);
    view.requestAnimationFrame = (callback) => this.#wait(callback);
    view.cancelAnimationFrame = (handle) => {
      this.#cancel(this.#waiting.get(handle) ?? handle);
      this.#waiting.delete(handle);
    };
  }

  /** Pictures per second; 0: no limit. */
  get hz() {
    return this.#interval_ms > 0 ? 1000 / this.#interval_ms : 0;
  }

  /** @param {number} hz pictures per second; 0: no limit */
  set(hz) {
    this.#interval_ms = hz > 0 ? 1000 / hz : 0;
  }

  /** @param {FrameRequestCallback} callback @returns {number} */
  #wait(callback) {
    /** @type {number | null} */
    let handle = null;
    /** @param {number} now_ms */
    const turn = (now_ms) => {
      if (!this.#isDue(now_ms)) {
        const next = this.#ask(turn);
        if (handle !== null) this.#waiting.set(handle, next);
        return;
      }
      if (handle !== null) this.#waiting.delete(handle);
      callback(now_ms);
    };
    handle = this.#ask(turn);
    return handle;
  }

  /** All that was asked for the same picture is drawn with it. @param {number} now_ms */
  #isDue(now_ms) {
    if (now_ms === this.#last_ms) return true;
    if (now_ms - this.#last_ms < this.#interval_ms - EARLY_MS) return false;
    this.#last_ms = now_ms;
    return true;
  }
}
