import assert from "node:assert/strict";
import { test } from "node:test";
import { isShown, planParts, withPrinted } from "../../frontend_assets/model/programs.js";
import { plannedGraph } from "../../frontend_assets/panels/launch/launch-graph.js";
import { detailsOf, parameterText } from "../../frontend_assets/panels/launch/plan.js";

const where = { file: "/ws/a.launch.py", line: 3 };

/** @param {object} some of its fields */
const node = (some) =>
  /** @type {any} */ ({
    id: 1,
    package: "talk",
    executable: "speaker",
    name: "",
    namespace: "/",
    full_name: "",
    include: null,
    condition: null,
    remaps: [],
    where,
    ...some,
  });

/** @param {object} some of its fields */
const plan = (some) =>
  /** @type {any} */ ({ file: "/ws/a.launch.py", nodes: [], processes: [], includes: [], ...some });

test("what an included file names stands below that file, each once", () => {
  const includes = [
    { id: 7, file: "/ws/b.launch.py", parent: null },
    { id: 8, file: "/ws/c.launch.py", parent: 7 },
  ];
  const nodes = [node({ id: 1 }), node({ id: 2, include: 8 })];
  const parts = planParts(plan({ includes, nodes }));
  assert.deepEqual(
    parts.map((one) => [one.file, one.level, one.nodes.length]),
    [
      ["/ws/a.launch.py", 0, 1],
      ["/ws/b.launch.py", 1, 0],
      ["/ws/c.launch.py", 2, 1],
    ],
  );
});

test("a file that includes itself ends the tree", () => {
  const includes = [{ id: 7, file: "/ws/a.launch.py", parent: 7 }];
  assert.equal(planParts(plan({ includes })).length, 1);
});

test("the graph has the nodes that start, and the names that their remaps give them", () => {
  const drawn = plannedGraph(
    plan({
      nodes: [
        node({ namespace: "/hall", remaps: [{ source: "said", target: "heard" }] }),
        node({ id: 2, condition: { text: "if x", holds: false } }),
      ],
    }),
  );
  assert.deepEqual(
    drawn.boxes.map(({ name }) => name),
    ["/hall/speaker", "/hall/heard"],
  );
  assert.equal(drawn.arrows.length, 1);
});

test("with includes, each node hangs on the file that names it", () => {
  const includes = [{ id: 7, file: "/ws/b.launch.py", parent: null }];
  const drawn = plannedGraph(plan({ includes, nodes: [node({ include: 7, full_name: "/one" })] }));
  assert.deepEqual(
    drawn.arrows.map(({ from, to }) => [from, to]),
    [["service:b.launch.py", "node:1"]],
  );
});

test("a parameter is shown as its value, with the file that it comes from, and not too long", () => {
  const one = { name: "x", value: /** @type {any} */ ([1, 2]), file: "/ws/p.yaml", robot: null };
  assert.equal(parameterText(one), "[1,2] (p.yaml)");
  assert.ok(parameterText({ ...one, value: "x".repeat(1000), file: "" }).length < 300);
});

/** @param {number} number @param {object} some @returns {any} */
const line = (number, some = {}) => ({ number, process: 1, stream: "stdout", text: "hi", ...some });

test("a node's details are all that it is given, also by a prefix, a folder and its environment", () => {
  const none = { parameters: [], files: [], arguments: [], ros_arguments: [], prefix: [], cwd: "" };
  assert.deepEqual(detailsOf(node({ ...none, environment: {} })), []);
  const given = {
    ...none,
    remaps: [{ source: "said", target: "heard" }],
    arguments: ["--fast"],
    ros_arguments: ["--log-level", "debug"],
    prefix: ["gdb", "--args"],
    cwd: "/ws",
    environment: { LOUD: "1" },
  };
  const texts = detailsOf(node(given)).map(([, text]) => text);
  assert.deepEqual(texts, ["→ heard", "--fast --log-level debug", "gdb --args", "/ws", "1"]);
});

test("lines are added to those that are known, and another run takes their place", () => {
  const known = { run: 1, lines: [line(1)], last: 1, dropped: 0 };
  const more = withPrinted(known, { run: 1, lines: [line(2)], last: 2, dropped: 0 });
  assert.equal(more.lines.length, 2);
  const other = { run: 2, lines: [line(1)], last: 1, dropped: 0 };
  assert.equal(withPrinted(more, other), other);
  assert.equal(withPrinted(more, { run: 1, lines: [], last: 2, dropped: 3 }).dropped, 3);
});

test("lines are filtered by words, process and stream", () => {
  const all = { words: "", process: null, errors: false };
  assert.ok(isShown(line(1), all));
  assert.ok(isShown(line(1, { text: "Hello" }), { ...all, words: "hell" }));
  assert.ok(!isShown(line(1), { ...all, process: 2 }));
  assert.ok(!isShown(line(1), { ...all, errors: true }));
  assert.ok(isShown(line(1, { stream: "stderr" }), { ...all, errors: true }));
});
