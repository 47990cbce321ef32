/** Paths as people read them: short, against the folder that the document lies in. */

/** @param {string} path @returns {string} the last part */
export function baseName(path) {
  return (
    path
      .replace(/[/\\]+$/, "")
      .split(/[/\\]/)
      .at(-1) ?? path
  );
}

/** @param {string} path @param {string} root @returns {string} below the root without it, else as it is */
export function shortPath(path, root) {
  const folder = root.replace(/[/\\]+$/, "");
  const inside =
    folder !== "" && path.startsWith(folder) && /[/\\]/.test(path[folder.length] ?? "");
  return inside ? path.slice(folder.length + 1) : path;
}

/**
 * @param {{file: string, line: number, column?: number} | null} place
 * @returns {string} `name.xacro:12`, as far as it is known
 */
export function placeText(place) {
  if (!place?.file) return "";
  return place.line ? `${baseName(place.file)}:${place.line}` : baseName(place.file);
}

/** @param {string} text @returns {string} the one path that it is, without quotes and `file://`; empty: it is none */
export function pastedPath(text) {
  const path = text
    .trim()
    .replace(/^(["'])(.*)\1$/, "$2")
    .replace(/^file:\/\/(?=\/)/, "");
  return /^(~?\/|[A-Za-z]:[\\/])/.test(path) && !/[\n\r<>]/.test(path) ? path : "";
}

/** @param {string} path @returns {boolean} by its ending it is a file that can be opened, no folder */
export const isFilePath = (path) => /\.(xacro|urdf|xml|zip)$/i.test(path);
