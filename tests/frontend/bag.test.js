import assert from "node:assert/strict";
import { test } from "node:test";
import {
  filledForm,
  formFault,
  rateOf,
  recordingAsked,
} from "../../frontend_assets/model/recording.js";

const PLAIN = filledForm({});

test("without a word all topics are recorded, as by ros2 with --all", () => {
  assert.equal(PLAIN.which, "all");
  assert.deepEqual(recordingAsked(PLAIN), {
    type: "start_recording",
    topics: [],
    regex: "",
    exclude_regex: "",
    name: "",
    storage: "mcap",
    compression: "none",
    max_bag_bytes: 0,
    max_bag_s: 0,
  });
});

test("a line's topics and its expression are recorded, and nothing of a form before it", () => {
  const named = recordingAsked(filledForm({ topics: ["/tf", "/scan"], storage: "sqlite3" }));
  assert.deepEqual([named.topics, named.regex, named.storage], [["/tf", "/scan"], "", "sqlite3"]);
  const both = recordingAsked(filledForm({ topics: ["/tf"], regex: "/arm/.*" }));
  assert.deepEqual([both.topics, both.regex], [["/tf"], "/arm/.*"]);
  const all = recordingAsked(filledForm({ all: true, topics: ["/tf"], exclude: ".*image" }));
  assert.deepEqual([all.topics, all.exclude_regex], [[], ".*image"]);
});

test("what was chosen before is not sent with another choice", () => {
  const form = {
    ...filledForm({ topics: ["/tf"], regex: "x" }),
    which: /** @type {const} */ ("topics"),
  };
  assert.equal(recordingAsked(form).regex, "");
});

test("a form says what is missing in it", () => {
  assert.equal(formFault(PLAIN), "");
  assert.equal(formFault({ ...PLAIN, which: "topics" }), "bag.fault.topics");
  assert.equal(formFault({ ...PLAIN, which: "regex" }), "bag.fault.regex");
  for (const name of ["a/b", "..", "a\\b"])
    assert.equal(formFault({ ...PLAIN, name }), "bag.fault.name");
  assert.equal(formFault({ ...PLAIN, name: "first drive" }), "");
});

test("the rate is that of late, and nothing once it has ended", () => {
  const state = { recording: true, path: "/b", seconds: 10, bytes: 1000 };
  assert.equal(rateOf(null, state), 100);
  assert.equal(rateOf(state, { ...state, seconds: 12, bytes: 5000 }), 2000);
  assert.equal(rateOf({ ...state, path: "/a" }, state), 100);
  assert.equal(rateOf(state, { ...state, recording: false }), 0);
});
