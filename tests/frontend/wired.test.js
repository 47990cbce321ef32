import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileOfWords, PARTS } from "./support/words.js";

const ASSETS = new URL("../../frontend_assets/", import.meta.url);
const IMPORTED = /(?:\bfrom|\bimport) ?\(?"(\.[^"]+\.js)"/g;
const WIRED = /wired\(\s*async \(\) => \(await import\("([^"]+)"\)/g;

/** @param {URL} url @returns {string} */
const textOf = (url) => readFileSync(url, "utf8");

/** @param {string} file @param {ReadonlySet<string>} apart not followed @returns {Set<string>} all that comes with it, now or later */
function allFrom(file, apart) {
  const found = new Set([new URL(file, ASSETS).href]);
  for (const one of found)
    for (const [, name] of textOf(new URL(one)).matchAll(IMPORTED)) {
      const other = new URL(name ?? "", one).href;
      if (!apart.has(other) && !other.includes("/vendor/")) found.add(other);
    }
  return found;
}

test("what is said outside of panels about ROS 2 is among the words of the page itself", () => {
  const panels = new URL("app/panels.js", ASSETS);
  const apart = new Set(
    [...textOf(panels).matchAll(WIRED)].map(([, name]) => new URL(name ?? "", panels).href),
  );
  assert.ok(apart.size > 10);
  // The palette sets what these panels show; what they say is read in the panels.
  for (const name of ["message-forms", "parameters", "topics"])
    apart.add(new URL(`model/${name}.js`, ASSETS).href);
  const page = [...allFrom("app/main.js", apart)].map((one) => textOf(new URL(one))).join("\n");
  const families = [...page.matchAll(/`([\w.]+\.)\$\{/g)].map(([, start]) => start ?? "");
  for (const part of PARTS.slice(1))
    for (const key of Object.keys(fileOfWords(`en${part}`))) {
      const plain = key.replace(/\.one$/, "");
      const said = page.includes(`"${plain}"`) || families.some((one) => key.startsWith(one));
      assert.ok(!said, `${key} is said before the panels about ROS 2 come`);
    }
});
