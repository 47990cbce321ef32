/** @import { BridgeView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { bridgeLine, bridgeNotes, reasonsForEmpty } from "../../frontend_assets/app/ros-bridges.js";
import { recipeLines, SITUATIONS } from "../../frontend_assets/app/ros-recipes.js";
import { ddsMark } from "../../frontend_assets/lib/dds-tag.js";
import { LANGUAGES, wordsOf } from "./support/words.js";

/** @param {Partial<BridgeView>} [news] @returns {BridgeView} */
const bridge = (news = {}) => ({
  name: "/robot1",
  version: "1.10.0",
  domain: 0,
  namespace: "/robot1",
  node_count: 5,
  fast_dds_count: 0,
  hosts: ["robot1"],
  state: "used",
  twin: "",
  allows: false,
  rules: [],
  withheld: [],
  withheld_count: 0,
  slowed: [],
  localhost_only: false,
  ...news,
});

// Without its words the page shows their keys.
test("a bridge with which all is well has nothing to note", () => {
  assert.equal(bridgeLine(bridge()), "ros.bridge");
  assert.deepEqual(bridgeNotes(bridge(), 0), []);
});

test("what a bridge holds back is noted with the list that says so", () => {
  const withheld = ["/scan"];
  const kept = { withheld, withheld_count: 1 };
  const rules = ["publishers: /scan"];
  const noted = (/** @type {Partial<BridgeView>} */ news) => bridgeNotes(bridge(news), 0);
  assert.deepEqual(noted({ ...kept, rules }), ["ros.bridge.withheld.deny"]);
  assert.deepEqual(noted({ ...kept, rules, allows: true }), ["ros.bridge.withheld.allow"]);
  assert.deepEqual(noted(kept), ["ros.bridge.withheld"]);
  assert.deepEqual(noted({ rules }), ["ros.bridge.deny"]);
  assert.deepEqual(noted({ rules, allows: true }), ["ros.bridge.allow"]);
  assert.deepEqual(
    noted({ slowed: [{ topics: "/tf", rate_hz: 5 }], localhost_only: true, fast_dds_count: 2 }),
    ["ros.bridge.fast_dds", "ros.bridge.slowed", "ros.bridge.local"],
  );
});

test("why a bridge shows no nodes is noted", () => {
  const noted = (/** @type {Partial<BridgeView>} */ news) => bridgeNotes(bridge(news), 0);
  assert.deepEqual(noted({ state: "empty" }), ["ros.bridge.empty"]);
  assert.deepEqual(noted({ state: "other_domain", domain: 5 }), ["ros.bridge.other_domain"]);
  assert.deepEqual(noted({ state: "twin", twin: "/robot2" }), ["ros.bridge.twin"]);
  assert.deepEqual(noted({ twin: "/robot2" }), ["ros.bridge.partly_twin"]);
  const told = reasonsForEmpty([bridge({ localhost_only: true })]);
  assert.ok(told.includes("ros.report.bridge.local"));
  assert.ok(reasonsForEmpty([bridge({ domain: null })]).includes("ros.report.bridge.no_domain"));
});

test("each situation of a robot has its lines, and words in each language", () => {
  for (const one of SITUATIONS) assert.ok(recipeLines(one, "").length > 0);
  for (const words of LANGUAGES.map(wordsOf))
    for (const one of SITUATIONS)
      for (const part of ["", ".text", ".then"]) assert.ok(words[`ros.recipe.${one}${part}`]);
});

test("beside a router that runs here a bridge is its client, for the router has the port", () => {
  assert.deepEqual(recipeLines("here", ""), ["zenoh-bridge-ros2dds"]);
  assert.deepEqual(recipeLines("here", "tcp/localhost:7447"), [
    "zenoh-bridge-ros2dds client -e tcp/localhost:7447",
  ]);
});

test("a node on DDS is marked with its bridge", () => {
  assert.equal(ddsMark("/robot1"), "DDS · robot1");
  assert.equal(ddsMark("bridge 1a2b3c"), "DDS · bridge 1a2b3c");
});
