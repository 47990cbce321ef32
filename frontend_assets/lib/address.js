/** Addresses of the studio, which may be reached below a path of a proxy. */

/** @returns {string} that path, without a slash at its end; mostly empty */
function root() {
  const page = globalThis.document?.documentElement;
  // A worker knows where its own file lies.
  if (page) return page.dataset?.root ?? "";
  const own = globalThis.location?.pathname ?? "";
  return own.slice(0, Math.max(0, own.lastIndexOf("/a/")));
}

/** @param {string} path from the studio's root, with its slash @returns {string} */
export const address = (path) => root() + path;

/** @param {string} id of a document; empty: the one that is shown first @returns {string} */
export const documentAddress = (id) => address(id ? `/d/${encodeURIComponent(id)}` : "/");

/** @param {string} pathname @returns {string} id of the document that a page's address names */
export function documentOf(pathname) {
  const found = /^\/d\/([^/]+)/.exec(pathname.slice(root().length));
  return found?.[1] ? decodeURIComponent(found[1]) : "";
}
