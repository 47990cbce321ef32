import assert from "node:assert/strict";
import { test } from "node:test";
import { newOnes, readPart, toldPart } from "../../frontend_assets/app/page-part.js";
import { series, span_s } from "../../frontend_assets/model/plotting.js";
import { isConfig, lossGroups } from "../../frontend_assets/model/rviz-configs.js";

test("files of RViz and of the studio are configs", () => {
  assert.ok(isConfig("view.rviz"));
  assert.ok(isConfig("lab.studio.yaml"));
  assert.ok(!isConfig("params.yaml"));
  assert.ok(!isConfig("robot.urdf"));
});

test("what is only kept is said by reason, the most telling first, without RViz's own packages", () => {
  assert.deepEqual(
    lossGroups([
      { reason: "window", what: "Window Geometry", names: [] },
      { reason: "no_property", what: "rviz_default_plugins/LaserScan", names: ["Selectable", "X"] },
      { reason: "no_display", what: "moveit_rviz_plugin/MotionPlanning", names: [] },
      { reason: "no_property", what: "rviz/Map", names: ["Y"] },
    ]),
    [
      { reason: "no_display", classes: ["moveit_rviz_plugin/MotionPlanning"] },
      { reason: "no_property", classes: ["LaserScan: Selectable, X", "Map: Y"] },
      { reason: "window", classes: ["Window Geometry"] },
    ],
  );
});

const isKnown = (/** @type {string} */ id) => ["scene", "plot"].includes(id);
const PANELS = { parts: [{ tabs: ["scene", "plot"], size: 3 }], upright: false };

test("what a page tells of itself is what it takes", () => {
  series.value = [{ topic: "/odom", path: ".x" }];
  span_s.value = 45;
  const told = readPart(JSON.stringify(toldPart(PANELS)), isKnown);
  assert.deepEqual(told.arrangement, PANELS);
  assert.deepEqual(told.plots, [{ topic: "/odom", path: ".x" }]);
  assert.equal(told.span_s, 45);
  assert.deepEqual(told.layouts, []);
});

test("nothing of a file is believed", () => {
  const nothing = { arrangement: null, layouts: [], open: [], plots: null, span_s: null };
  for (const text of [
    "",
    "[",
    "5",
    "null",
    "[]",
    '{"Panels": 7, "Plots": {}, "Open": 3, "Plot span": -1}',
  ])
    assert.deepEqual(readPart(text, isKnown), nothing);
  const told = readPart(
    JSON.stringify({
      Panels: { parts: [{ tabs: ["nowhere", "scene", 7], size: "x" }] },
      Plots: [{ topic: 5 }, { topic: "/a", path: ".b", more: 1 }],
      Layouts: [{ name: "Mine", arrangement: PANELS }, 5],
      Open: ["plot", "nowhere", 5],
    }),
    isKnown,
  );
  assert.deepEqual(told.arrangement?.parts, [{ tabs: ["scene"], size: 1 }]);
  assert.deepEqual(told.plots, [{ topic: "/a", path: ".b" }]);
  assert.deepEqual(told.layouts, [{ name: "Mine", arrangement: PANELS }]);
  assert.deepEqual(told.open, ["plot"]);
});

test("a layout of a file that got another name here is not added again", () => {
  const other = { parts: [{ tabs: ["plot"], size: 1 }], upright: false };
  const own = [{ name: "Mine 2", arrangement: PANELS }];
  const layouts = [
    { name: "Mine", arrangement: PANELS },
    { name: "Mine", arrangement: other },
  ];
  assert.deepEqual(newOnes(layouts, own), [{ name: "Mine", arrangement: other }]);
});
