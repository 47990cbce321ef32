/** Something that is asked for again and again, for as long as somebody looks. */

/**
 * @param {() => Promise<boolean | void>} ask gives whether there is more to be asked for at once
 * @param {number} everyMs from an answer to the next question
 * @returns {() => void} the end of it
 */
export function keepAsking(ask, everyMs) {
  let over = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const look = async () => {
    const more = await ask();
    if (!over) timer = setTimeout(look, more ? 0 : everyMs);
  };
  look();
  return () => {
    over = true;
    clearTimeout(timer);
  };
}
