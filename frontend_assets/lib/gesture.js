/** Gestures: all edits of one drag, or of one burst of key presses, carry one id and undo as one. */

const IDLE_MS = 900;
const own = Math.random().toString(36).slice(2, 8);
let count = 0;

/**
 * @param {() => number} [now] milliseconds
 * @returns {{id: () => string, end: () => void}} `id` renews itself after a pause or an end
 */
export function createGesture(now = () => performance.now()) {
  let id = "";
  let last = Number.NEGATIVE_INFINITY;
  return {
    id() {
      if (id === "" || now() - last > IDLE_MS) {
        count += 1;
        id = `${own}-${count}`;
      }
      last = now();
      return id;
    },
    end() {
      id = "";
    },
  };
}
