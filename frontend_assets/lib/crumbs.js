/** The way from a served folder down to the one that is shown. */

/**
 * @param {string} path
 * @param {readonly string[]} roots the served folders
 * @returns {{name: string, path: string}[]} the served folder first; nothing for the list of these
 */
export function crumbsOf(path, roots) {
  if (path === "") return [];
  const root = roots.filter((one) => isAtOrBelow(path, one)).sort((a, b) => a.length - b.length)[0];
  const begin = root ?? path;
  const separator = path.includes("\\") && !path.includes("/") ? "\\" : "/";
  const steps = path.slice(begin.length).split(separator).filter(Boolean);
  const crumbs = [{ name: lastStep(begin), path: begin }];
  for (const step of steps) {
    const above = crumbs.at(-1)?.path ?? begin;
    crumbs.push({ name: step, path: `${above.replace(/[/\\]$/, "")}${separator}${step}` });
  }
  return crumbs;
}

/** @param {string} path @param {string} root @returns {boolean} */
function isAtOrBelow(path, root) {
  return path === root || (path.startsWith(root) && /[/\\]/.test(path[root.length] ?? ""));
}

/** @param {string} path @returns {string} */
const lastStep = (path) => path.split(/[/\\]/).filter(Boolean).at(-1) ?? path;
