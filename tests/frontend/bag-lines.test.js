import assert from "node:assert/strict";
import { test } from "node:test";
import { readBagLine } from "../../frontend_assets/lib/bag-lines.js";

const PLAIN = {
  all: false,
  topics: [],
  regex: "",
  exclude: "",
  name: "",
  storage: "mcap",
  compression: "none",
  maxBytes: 0,
  maxSeconds: 0,
};

/** @type {readonly [string, object][]} */
const RECORDED = [
  ["ros2 bag record /number -o bag1", { topics: ["/number"], name: "bag1" }],
  ["studio bag record number", { topics: ["/number"] }],
  ["$ ros2 bag record -a", { all: true }],
  ["ros2 bag record <topic_name> -o <save_path>", {}],
  ["ros2 bag record -o ~/bags/run_2/ /a /b/c", { topics: ["/a", "/b/c"], name: "run_2" }],
  ["ros2 bag record --topics /a /b --output=x", { topics: ["/a", "/b"], name: "x" }],
  [
    'ros2 bag record -e "/arm/.*" -x ".*/raw" -s sqlite3 -b 1000000 -d 60',
    {
      regex: "/arm/.*",
      exclude: ".*/raw",
      storage: "sqlite3",
      maxBytes: 1000000,
      maxSeconds: 60,
    },
  ],
  [
    "ros2 bag record -a --compression-mode file --compression-format zstd --max-cache-size 5",
    { all: true, compression: "zstd" },
  ],
  ["ros2 bag record -a -b many", { all: true }],
];

for (const [line, form] of RECORDED)
  test(`what is recorded by ${line}`, () => {
    assert.deepEqual(readBagLine(line), { verb: "record", form: { ...PLAIN, ...form } });
  });

test("which bag is played or told of", () => {
  assert.deepEqual(readBagLine("ros2 bag play ~/bags/bag1/"), {
    verb: "play",
    path: "~/bags/bag1/",
  });
  assert.deepEqual(readBagLine("ros2 bag info bag1"), { verb: "info", path: "bag1" });
  assert.deepEqual(readBagLine("ros2 bag play --loop bag1"), { verb: "play", path: "bag1" });
  assert.deepEqual(readBagLine(" ros2 bag play <rosbag_filename>"), { verb: "play", path: "" });
});

test("other lines are none of these", () => {
  for (const line of ["ros2 bag", "ros2 bag reindex bag1", "ros2 topic list", "bag play x", "'"])
    assert.equal(readBagLine(line), null);
});
