/** Texts that come with the page, each fetched when it is first asked for, and then kept. */

/**
 * @template T
 * @param {string} folder its address
 * @param {(text: string) => T} read is given an empty text when there is none now
 * @returns {(name: string) => Promise<T>} by the name of a file in the folder
 */
export function textFiles(folder, read) {
  /** @type {Map<string, Promise<T>>} */
  const known = new Map();
  const fetched = async (/** @type {string} */ name) => {
    const text = await fetch(`${folder}${name}`)
      .then((answer) => (answer.ok ? answer.text() : ""))
      .catch(() => "");
    // What failed is asked for anew the next time.
    if (text === "") known.delete(name);
    return read(text);
  };
  return (name) => {
    const asked = known.get(name) ?? fetched(name);
    known.set(name, asked);
    return asked;
  };
}
