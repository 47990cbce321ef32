import assert from "node:assert/strict";
import { test } from "node:test";
import { fitted, resized, zoomed } from "../../frontend_assets/lib/pan-zoom.js";
import { layOut } from "../../frontend_assets/panels/graph/layout.js";
import {
  byNamespace,
  drawnGraph,
  namespacesOf,
  USUAL,
} from "../../frontend_assets/panels/graph/nodes.js";

/** @param {string} name @param {boolean} [own] @param {string} [bridge] */
const node = (name, own = false, bridge = "") => ({ name, count: 1, own, bridge });
/**
 * @param {string} name @param {number[]} sources @param {number[]} targets
 * @param {Partial<import("../../frontend_assets/types/wire.d.ts").GraphLinkView>} [news]
 */
const link = (name, sources, targets, news = {}) => ({
  kind: /** @type {const} */ ("topic"),
  name,
  types: ["std_msgs/msg/String"],
  sources,
  targets,
  hidden: false,
  ...news,
});
const GRAPH = {
  nodes: [node("/listener"), node("/talker"), node("/studio", true)],
  links: [
    link("/chatter", [1], [0]),
    link("/rosout", [0, 1, 2], [2]),
    link("/unheard", [1], []),
    link("/turn/_action/status", [0], [1], { hidden: true }),
    link("/add", [0], [1], { kind: "service" }),
    link("/talker/get_parameters", [0], [1], { kind: "service" }),
  ],
};
/** @param {Partial<import("../../frontend_assets/panels/graph/nodes.js").GraphOptions>} news */
const drawn = (news) => drawnGraph(GRAPH, { ...USUAL, ...news });
/** @param {{boxes: {id: string}[]}} graph */
const ids = ({ boxes }) => boxes.map(({ id }) => id);

test("N4: talker and listener are two nodes with one edge", () => {
  const { boxes, arrows } = drawn({ form: "nodes" });
  assert.deepEqual(ids({ boxes }), ["node:/listener", "node:/talker"]);
  assert.deepEqual(arrows, [
    {
      id: "node:/talker node:/listener",
      from: "node:/talker",
      to: "node:/listener",
      names: ["/chatter"],
    },
  ]);
  assert.deepEqual(ids(drawn({})), ["node:/listener", "node:/talker", "topic:/chatter"]);
});

test("noise, dead ends and calls come when they are asked for", () => {
  assert.ok(ids(drawn({ noise: true })).includes("topic:/rosout"));
  assert.ok(ids(drawn({ noise: true })).includes("node:/studio"));
  assert.ok(!ids(drawn({ noise: true })).includes("topic:/unheard"));
  assert.ok(ids(drawn({ sinks: true })).includes("topic:/unheard"));
  const called = ids(drawn({ services: true }));
  assert.ok(called.includes("service:/add") && !called.includes("service:/talker/get_parameters"));
});

test("a search and a focus leave what is near", () => {
  const graph = {
    nodes: ["/a", "/b", "/c", "/d"].map((name) => node(name)),
    links: [link("/ab", [0], [1]), link("/bc", [1], [2]), link("/cd", [2], [3])],
  };
  const near = drawnGraph(graph, { ...USUAL, focus: "node:/a" });
  assert.deepEqual(ids(near).toSorted(), ["node:/a", "node:/b", "topic:/ab"]);
  const found = drawnGraph(graph, { ...USUAL, words: "CD" });
  assert.deepEqual(ids(found).toSorted(), ["node:/c", "node:/d", "topic:/cd"]);
  const carried = drawnGraph(graph, { ...USUAL, form: "nodes", words: "CD" });
  assert.deepEqual(ids(carried), ["node:/c", "node:/d"]);
  assert.equal(drawnGraph(graph, { ...USUAL, focus: "node:/gone" }).boxes.length, 7);
});

const FLEET = {
  nodes: ["/a/arm/left", "/a/arm/right", "/a/eye", "/b/eye", "/pilot"].map((name) => node(name)),
  links: [
    link("/a/joints", [0], [1]),
    link("/a/seen", [2], [0, 4]),
    link("/b/seen", [3], [4]),
    link("/go", [4], [0, 2, 3]),
  ],
};

test("nodes of one namespace are one box, until it is opened", () => {
  assert.deepEqual(namespacesOf("/a/arm/left"), ["/a/", "/a/arm/"]);
  assert.deepEqual(namespacesOf("/a/arm/"), ["/a/"]);
  const fleet = { ...USUAL, form: /** @type {const} */ ("nodes"), spaces: true };
  const { boxes, arrows } = drawnGraph(FLEET, fleet);
  assert.deepEqual(
    boxes.map(({ kind, name, count }) => [kind, name, count]),
    [
      ["space", "/a/", 3],
      ["node", "/b/eye", 1],
      ["node", "/pilot", 1],
    ],
  );
  const toPilot = arrows.find(({ from }) => from === "node:/a/");
  assert.deepEqual(toPilot?.names, ["/a/seen"], "what only its own nodes hear is not seen");
  const opened = drawnGraph(FLEET, { ...fleet, opened: new Set(["/a/"]) });
  assert.ok(ids(opened).includes("node:/a/arm/") && ids(opened).includes("node:/a/eye"));
  const found = drawnGraph(FLEET, { ...fleet, words: "left" });
  assert.ok(ids(found).includes("node:/a/arm/left"), "who seeks a node finds it");
});

test("a box is marked with the bridge to DDS that all its nodes are behind", () => {
  const nodes = [node("/a/one", false, "/a"), node("/a/two", false, "/a"), node("/pilot")];
  const mixed = [...nodes, node("/a/three")];
  const marks = (/** @type {typeof nodes} */ those, spaces = false) =>
    drawnGraph({ nodes: those, links: [] }, { ...USUAL, spaces }).boxes.map(({ bridge }) => bridge);
  assert.deepEqual(marks(nodes), ["/a", "/a", ""]);
  assert.deepEqual(marks(nodes, true), ["/a", ""]);
  assert.deepEqual(marks(mixed, true), ["", ""]);
});

test("a topic that a namespace publishes to itself and to others keeps both of its ends", () => {
  const { links } = byNamespace(FLEET, new Set());
  assert.deepEqual(
    links.map(({ name, sources, targets }) => [name, sources, targets]),
    [
      ["/a/seen", [0], [0, 2]],
      ["/b/seen", [1], [2]],
      ["/go", [2], [0, 1]],
    ],
  );
});

test("a drawing too large to be read whole shows what is around its heart", () => {
  const frame = { width: 400, height: 300 };
  const small = fitted({ width: 200, height: 100 }, frame);
  assert.deepEqual([small.x, small.y, small.scale], [100, 100, 1]);
  const wide = fitted({ width: 4000, height: 100 }, frame, { x: 2000, y: 50 });
  assert.equal(wide.scale, 0.55);
  assert.equal(wide.x + 2000 * wide.scale, 200, "it is in the middle");
  const corner = fitted({ width: 4000, height: 100 }, frame, { x: 0, y: 0 });
  assert.ok(corner.x > 0 && corner.x < 100, "no more is empty than around it");
  const tight = fitted({ width: 100, height: 500 }, frame, { x: 50, y: 250 });
  assert.ok(tight.scale > 0.55 && tight.y > 0, "it is seen whole, with less around it");
  assert.ok(tight.y + 500 * tight.scale < frame.height);
});

/** @param {string} id */
const box = (id) => ({ id, width: 80, height: 24 });
/** @param {string} from @param {string} to */
const arrow = (from, to) => ({ id: `${from}-${to}`, from, to });

/** @param {ReturnType<typeof layOut>} layout @param {number} [count] */
function checkBoxes(layout, count) {
  const places = [...layout.boxes.values()];
  assert.equal(places.length, count ?? places.length);
  for (const [at, one] of places.entries()) {
    assert.ok(Number.isFinite(one.x) && Number.isFinite(one.y));
    assert.ok(one.x >= 0 && one.x <= layout.width && one.y >= 0 && one.y <= layout.height);
    for (const other of places.slice(at + 1))
      assert.ok(Math.abs(one.x - other.x) >= 79 || Math.abs(one.y - other.y) >= 23);
  }
}

test("arrows point down where there is no loop", () => {
  const layout = layOut("abcd".split("").map(box), [
    arrow("a", "b"),
    arrow("b", "c"),
    arrow("a", "d"),
    arrow("d", "c"),
    arrow("a", "c"),
  ]);
  checkBoxes(layout, 4);
  const y = (/** @type {string} */ id) => layout.boxes.get(id)?.y ?? 0;
  assert.ok(y("a") < y("b") && y("b") < y("c") && y("d") < y("c"));
  assert.equal(layout.arrows.get("a-c")?.length, 3, "it passes the layer between");
});

test("loops, an arrow to oneself and boxes without arrows are laid out, too", () => {
  const boxes = "abcdefgh".split("").map(box);
  const loops = [
    arrow("a", "b"),
    arrow("b", "c"),
    arrow("c", "a"),
    arrow("d", "d"),
    arrow("b", "a"),
  ];
  checkBoxes(layOut(boxes, loops), 8);
  checkBoxes(layOut([], []), 0);
});

test("no two boxes lie over one another, whatever the graph", () => {
  let seed = 7;
  const random = (/** @type {number} */ below) => {
    seed = (seed * 1103515245 + 12345) % 2147483648;
    return seed % below;
  };
  for (let turn = 0; turn < 30; turn += 1) {
    const count = 1 + random(40);
    const boxes = Array.from({ length: count }, (_, at) => box(`n${at}`));
    const arrows = new Map();
    for (let n = random(80); n > 0; n -= 1) {
      const one = arrow(`n${random(count)}`, `n${random(count)}`);
      arrows.set(one.id, one);
    }
    const layout = layOut(boxes, [...arrows.values()]);
    checkBoxes(layout, count);
    for (const way of layout.arrows.values())
      assert.ok(way.every(({ x, y }) => Number.isFinite(x) && Number.isFinite(y)));
  }
});

test("four hundred boxes are laid out in a moment", () => {
  const boxes = Array.from({ length: 460 }, (_, at) => box(`n${at}`));
  const arrows = Array.from({ length: 648 }, (_, at) =>
    arrow(`n${(at * 7) % 200}`, `n${200 + ((at * 13) % 260)}`),
  );
  const began = performance.now();
  checkBoxes(layOut(boxes, [...new Map(arrows.map((one) => [one.id, one])).values()]));
  assert.ok(performance.now() - began < 20_000);
});

test("what a hand moved into sight stays in sight when the frame changes its size", () => {
  const before = { width: 800, height: 600 };
  const view = zoomed({ x: -120, y: 40, scale: 1 }, 1.5, { x: 300, y: 200 });
  const inDrawing = (
    /** @type {typeof view} */ { x, y, scale },
    /** @type {number[]} */ [a, b],
  ) => [((a ?? 0) - x) / scale, ((b ?? 0) - y) / scale];
  const now = { width: 400, height: 500 };
  const small = resized(view, before, now);
  assert.deepEqual(inDrawing(small, [200, 250]), inDrawing(view, [400, 300]));
  const [left = 0, top = 0] = inDrawing(small, [0, 0]);
  const [oldLeft = 0, oldTop = 0] = inDrawing(view, [0, 0]);
  assert.ok(left <= oldLeft && top <= oldTop, "nothing that was seen is lost");
  assert.deepEqual(resized(view, before, before), view);
});
