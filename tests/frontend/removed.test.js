import assert from "node:assert/strict";
import { test } from "node:test";

/** @type {Record<string, object>} */
const tree = {};
Object.assign(globalThis, { window: { __viserSceneTree: { getState: () => tree } } });
const { Removed } = await import("../../frontend_assets/viser/door.js");

test("a node that is gone leaves no name behind, one that came again stays", () => {
  /** @type {Record<string, object | null>} */
  const nodes = { "/gone": null, "/again": {}, "/still": {}, "/going": {} };
  const hooks = { read: (/** @type {object} */ _) => {}, after: () => {} };
  const door = {
    mutable: { nodeRefFromName: nodes },
    onMessage: (/** @type {any} */ read) => Object.assign(hooks, { read }),
    onPicture: (/** @type {any} */ _, /** @type {any} */ after) => Object.assign(hooks, { after }),
  };
  new Removed(/** @type {any} */ (door));
  for (const name of ["/gone", "/again", "/going"])
    hooks.read({ type: "RemoveSceneNodeMessage", name });
  Object.assign(tree, { "/again": {}, "/still": {} });
  hooks.after();
  assert.deepEqual(Object.keys(nodes), ["/again", "/still", "/going"]);
  nodes["/going"] = null;
  hooks.after();
  assert.deepEqual(Object.keys(nodes), ["/again", "/still"]);
});
