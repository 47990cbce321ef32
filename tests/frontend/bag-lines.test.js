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
    const read = readBagLine(line);
    assert.deepEqual(read?.verb === "record" && read.form, { ...PLAIN, ...form });
  });

/** @type {readonly [string, string[]][]} */
const LEFT_OUT = [
  ["ros2 bag record <topic_name> -o <save_path> -d <seconds>", []],
  ["ros2 bag record -a -o x -e a -x b -s sqlite3 -b 5 -d 6 --compression-format zstd", []],
  ["ros2 bag record -a --compression-mode file --compression-format zstd", []],
  ["ros2 bag record -a --compression-mode file", ["--compression-mode file"]],
  ["ros2 bag record -a --exclude-topics /a /b -o x", ["--exclude-topics /a /b"]],
  [
    "ros2 bag record --topic-types std_msgs/msg/String --services /add --snapshot-mode",
    ["--topic-types std_msgs/msg/String", "--services /add", "--snapshot-mode"],
  ],
  [
    "ros2 bag record /a --max-cache-size=5 --node-name me",
    ["--max-cache-size=5", "--node-name me"],
  ],
  ["ros2 bag record /a 'no topic' -b many -s rosbag1", ["no topic", "-b many", "-s rosbag1"]],
  ["ros2 bag play bag1", []],
  ["ros2 bag play -i bag1 mcap -i bag2", []],
  ["ros2 bag play -s mcap bag1 --loop -r 2 --clock", ["--loop", "-r 2", "--clock"]],
  ["ros2 bag play --clock 40 bag1 --topics /a /b", ["--clock 40", "--topics /a /b"]],
  ["ros2 bag play bag1 bag2", ["bag2"]],
  ["ros2 bag info bag1 --verbose", ["--verbose"]],
];

for (const [line, words] of LEFT_OUT)
  test(`what the page leaves out of ${line}`, () => {
    assert.deepEqual(readBagLine(line)?.leftOut, words);
  });

test("values of what is left out are no topics", () => {
  const read = readBagLine("ros2 bag record /a --exclude-topics /b /c --services /add");
  assert.deepEqual(read?.verb === "record" && read.form.topics, ["/a"]);
});

/** @type {readonly [string, string[]][]} */
const OPENED = [
  ["ros2 bag play ~/bags/bag1/", ["~/bags/bag1/"]],
  ["ros2 bag info bag1", ["bag1"]],
  ["ros2 bag play --loop bag1", ["bag1"]],
  ["ros2 bag play --rate 2 bag1", ["bag1"]],
  ["ros2 bag play -i bag1 -i bag2 sqlite3 --input bag3", ["bag1", "bag2", "bag3"]],
  [" ros2 bag play <rosbag_filename>", []],
];

for (const [line, paths] of OPENED)
  test(`which bags are played or told of by ${line}`, () => {
    const read = readBagLine(line);
    assert.deepEqual(read && read.verb !== "record" && read.paths, paths);
  });

test("other lines are none of these", () => {
  for (const line of ["ros2 bag", "ros2 bag reindex bag1", "ros2 topic list", "bag play x", "'"])
    assert.equal(readBagLine(line), null);
});
