/** @import { OwnLayout } from "../../frontend_assets/app/layouts.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  FILE_LARGEST,
  freeName,
  LAYOUTS_MOST,
  LayoutFileError,
  layoutFile,
  readLayoutFile,
  tidyName,
} from "../../frontend_assets/app/layouts.js";

/** @param {string} name @returns {OwnLayout} */
const layout = (name) => ({
  name,
  arrangement: { upright: false, parts: [{ tabs: ["scene", "plot"], size: 10 }] },
});

/** @param {string} id */
const isKnown = (id) => id === "scene";

/** @param {unknown} content @returns {string} the reason why it was not taken */
function reasonAgainst(content) {
  try {
    readLayoutFile(typeof content === "string" ? content : JSON.stringify(content), isKnown);
  } catch (error) {
    assert.ok(error instanceof LayoutFileError);
    return error.reason;
  }
  return "";
}

test("what is saved comes back, without panels that this studio lacks, which are told", () => {
  const read = readLayoutFile(layoutFile([layout("Mine")]), isKnown);
  assert.deepEqual(read.dropped, ["plot"]);
  assert.deepEqual(read.layouts, [
    { name: "Mine", arrangement: { upright: false, parts: [{ tabs: ["scene"], size: 10 }] } },
  ]);
});

test("each file that cannot be read is refused for its own reason", () => {
  assert.equal(reasonAgainst("{"), "layouts.import.no_json");
  for (const wrong of [
    null,
    3,
    [],
    {},
    { studio_layouts: "1", layouts: [] },
    { studio_layouts: 1 },
  ])
    assert.equal(reasonAgainst(wrong), "layouts.import.no_layouts");
  assert.equal(
    reasonAgainst({ studio_layouts: 1, layouts: [{ name: "", arrangement: {} }] }),
    "layouts.import.no_layouts",
  );
  assert.equal(
    reasonAgainst({ studio_layouts: 99, layouts: [layout("x")] }),
    "layouts.import.newer",
  );
  assert.equal(reasonAgainst(" ".repeat(FILE_LARGEST + 1)), "layouts.import.too_large");
});

test("no more are read than can be kept", () => {
  const many = Array.from({ length: LAYOUTS_MOST + 9 }, () => layout("same"));
  const { layouts } = readLayoutFile(layoutFile(many), isKnown);
  assert.equal(layouts.length, LAYOUTS_MOST);
  assert.equal(new Set(layouts.map(({ name }) => name)).size, LAYOUTS_MOST);
});

test("a name is one short line, and none takes the place of another", () => {
  assert.equal(tidyName("  my\n layout\t2 "), "my layout 2");
  assert.equal(tidyName("x".repeat(500)).length, 60);
  assert.equal(freeName("a", [layout("b")]), "a");
  assert.equal(freeName("a", [layout("a"), layout("a 2")]), "a 3");
});
