/** Something that is asked for again and again, for as long as somebody looks. */

/**
 * @template T
 * @param {() => Promise<T>} ask
 * @param {(answer: T) => void} take
 * @param {number} every_ms between an answer and the next question
 * @returns {() => void} the end of it: what comes later is not taken
 */
export function keepAsking(ask, take, every_ms) {
  let closed = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const look = async () => {
    const answer = await ask();
    if (closed) return;
    take(answer);
    if (!closed) timer = setTimeout(look, every_ms);
  };
  look();
  return () => {
    closed = true;
    clearTimeout(timer);
  };
}
