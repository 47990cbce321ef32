/** The modules of the page as texts. */

import { readdirSync, readFileSync } from "node:fs";

const ASSETS = new URL("../../../frontend_assets/", import.meta.url);

/** @param {readonly string[]} folders @returns {[string, string][]} path and text of each module below them */
export function sourcesIn(folders) {
  return folders.flatMap((folder) =>
    readdirSync(new URL(folder, ASSETS), { recursive: true, withFileTypes: true })
      .filter((entry) => entry.isFile() && entry.name.endsWith(".js"))
      .map((entry) => `${entry.parentPath}/${entry.name}`)
      .map((path) => /** @type {[string, string]} */ ([path, readFileSync(path, "utf8")])),
  );
}
