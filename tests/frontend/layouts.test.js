/** @import { Arrangement } from "../../frontend_assets/lib/arrangement.js" */
/** @import { Dock } from "../../frontend_assets/lib/dock.js" */
/** @import { DocumentState } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { followSize } from "../../frontend_assets/app/layouts.js";
import { tabsOf } from "../../frontend_assets/lib/arrangement.js";
import { recall } from "../../frontend_assets/lib/remembered.js";
import { connection, documentId, role } from "../../frontend_assets/model/connection.js";
import { documentState } from "../../frontend_assets/model/document.js";
import { PANEL_FILES } from "./support/panels.js";

/** @type {Map<string, string>} */
const stored = new Map();
Object.assign(globalThis, {
  innerWidth: 1600,
  innerHeight: 950,
  addEventListener() {},
  localStorage: {
    getItem: (/** @type {string} */ name) => stored.get(name) ?? null,
    setItem: (/** @type {string} */ name, /** @type {string} */ text) => stored.set(name, text),
    removeItem: (/** @type {string} */ name) => stored.delete(name),
  },
});

/** A dock without a page: it knows where its panels stand, and shows one that is missing at the left. */
function newDock() {
  /** @type {Arrangement} */
  let now = { parts: [] };
  const dock = /** @type {Dock} */ (
    /** @type {unknown} */ ({
      arrange: (/** @type {Arrangement} */ arrangement) => {
        now = structuredClone(arrangement);
      },
      arrangement: () => now,
      nameAll() {},
      setSingle() {},
      show(/** @type {string} */ id) {
        if (!now.parts.flatMap(tabsOf).includes(id)) leaves(now)[0]?.tabs.push(id);
        for (const leaf of leaves(now)) if (leaf.tabs.includes(id)) leaf.shown = id;
      },
    })
  );
  const isSeen = (/** @type {string} */ id) =>
    leaves(now).some(({ tabs, shown }) => (shown ?? tabs[0]) === id);
  return { dock, isSeen, tabs: () => now.parts.flatMap(tabsOf) };
}

/** @param {Arrangement} arrangement @returns {{tabs: string[], shown?: string}[]} */
function leaves({ parts }) {
  /** @param {import("../../frontend_assets/lib/arrangement.js").Split} part @returns {{tabs: string[], shown?: string}[]} */
  const of = (part) => ("split" in part ? part.split.flatMap(of) : [part]);
  return parts.flatMap(of);
}

const ELEMENT = /** @type {HTMLElement} */ ({ clientWidth: 1600, clientHeight: 860 });

test("what is opened before the document has come stays open when that brings other panels", async () => {
  connection.value = "connected";
  role.value = "presenter";
  documentId.value = "cart";
  const { dock, isSeen, tabs } = newDock();
  const { keep } = followSize(dock, ELEMENT, PANEL_FILES);
  assert.ok(!tabs().includes("launch"), "nothing may be run as far as is known");
  dock.show("topics");
  dock.show("problems");
  keep();
  assert.equal(recall("layout.4.wide"), undefined, "it is not known yet whose layout that is");
  documentState.value = /** @type {DocumentState} */ ({ may_run: true, is_bare: false });
  assert.ok(tabs().includes("launch"));
  assert.ok(isSeen("topics") && isSeen("problems"));
  await Promise.resolve();
  assert.deepEqual(recall("layout.4.wide"), dock.arrangement());
  // Another document asks for its own layout, and nothing of this one is in its way.
  documentState.value = /** @type {DocumentState} */ ({ may_run: true, is_bare: true });
  assert.ok(!isSeen("problems"));
  assert.ok(isSeen("packages"));
});
