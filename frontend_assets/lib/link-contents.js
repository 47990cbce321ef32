/** What a link to a robot holds, read here so that it can be told before anything is opened. */

const VERSION = "1";
/** The studio packs no more into one. */
const UNPACKED_CHARACTERS = 2 << 20;

/** @typedef {{file: string, arguments: Record<string, string>, edits: number}} LinkContents `file` with its package, where it has one */

/** @param {string} text as it stands in the address @returns {Promise<LinkContents | null>} null: it cannot be read */
export async function linkContents(text) {
  if (!text.startsWith(VERSION)) return null;
  try {
    const { entry, arguments: given = {}, files = [] } = JSON.parse(await unpacked(text.slice(1)));
    return {
      file: entry.package ? `${entry.package}/${entry.inside}` : entry.path,
      arguments: Object.fromEntries(
        Object.entries(given).map(([name, one]) => [name, String(one)]),
      ),
      edits: files.flatMap((/** @type {{edits: unknown[]}} */ one) => one.edits).length,
    };
  } catch {
    return null;
  }
}

/** @param {string} packed base64url of compressed text @returns {Promise<string>} */
async function unpacked(packed) {
  const bytes = Uint8Array.from(atob(packed.replaceAll("-", "+").replaceAll("_", "/")), (one) =>
    one.charCodeAt(0),
  );
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = stream.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    text += part.value;
    if (text.length > UNPACKED_CHARACTERS) throw new RangeError("too large");
  }
  return text;
}
