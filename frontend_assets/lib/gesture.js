/** Gestures: all edits of one drag, or of one burst of key presses, carry one id and undo as one. */

const IDLE_MS = 900;
const own = Math.random().toString(36).slice(2, 8);
let count = 0;

/**
 * @typedef {object} Gesture
 * @property {() => string} id renews itself after a pause, but never while it is held
 * @property {() => void} hold a drag goes on, however long the pointer rests
 * @property {() => void} release of what was held; more of the same may follow
 * @property {() => void} end the next edit begins a new gesture
 */

/** @param {() => number} [now] milliseconds @returns {Gesture} */
export function createGesture(now = () => performance.now()) {
  let id = "";
  let held = false;
  let last = Number.NEGATIVE_INFINITY;
  return {
    id() {
      if (id === "" || (!held && now() - last > IDLE_MS)) {
        count += 1;
        id = `${own}-${count}`;
      }
      last = now();
      return id;
    },
    hold() {
      held = true;
    },
    release() {
      held = false;
    },
    end() {
      id = "";
      held = false;
    },
  };
}
