/** Short names for the tabs of files, with as much of the folder as tells two apart. */

import { baseName } from "./paths.js";

/** @param {readonly string[]} files @returns {Map<string, {name: string, folder: string}>} `folder` only where needed */
export function tabNames(files) {
  /** @type {Map<string, number>} */
  const counts = new Map();
  for (const file of files) counts.set(baseName(file), (counts.get(baseName(file)) ?? 0) + 1);
  return new Map(
    files.map((file) => {
      const name = baseName(file);
      return [file, { name, folder: (counts.get(name) ?? 0) > 1 ? lastFolder(file, files) : "" }];
    }),
  );
}

/** @param {string} file @param {readonly string[]} files @returns {string} */
function lastFolder(file, files) {
  const parts = file.split(/[/\\]/);
  const rivals = files.filter((one) => one !== file && baseName(one) === baseName(file));
  for (let depth = 2; depth < parts.length; depth += 1) {
    const tail = parts.slice(-depth).join("/");
    if (!rivals.some((one) => one.split(/[/\\]/).slice(-depth).join("/") === tail))
      return parts.slice(-depth, -1).join("/");
  }
  return parts.slice(0, -1).join("/");
}
