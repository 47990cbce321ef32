import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { linkContents } from "../../frontend_assets/app/share.js";

/** @param {unknown} shared @returns {string} as the studio packs it */
function packed(shared) {
  return `1${deflateSync(JSON.stringify(shared)).toString("base64url")}`;
}

test("a link tells its file, its arguments and how much is edited", async () => {
  const edits = [{ at: 1, old: "1", new: "2" }];
  const entry = {
    path: "/data/me/ws/mast/urdf/mast.xacro",
    package: "mast",
    inside: "urdf/mast.xacro",
  };
  const files = [{ file: entry, digest: "", edits: [...edits, ...edits] }];
  assert.deepEqual(await linkContents(packed({ entry, arguments: { name: "Größe" }, files })), {
    file: "mast/urdf/mast.xacro",
    arguments: { name: "Größe" },
    edits: 2,
    bag: "",
  });
});

test("a link to a moment tells its bag, which is what is opened where the robot is the bag's own", async () => {
  const entry = { path: "/data/from_ros/run.urdf" };
  const bag = { path: "/bags/run", package: "", inside: "" };
  const told = async (/** @type {boolean} */ own) =>
    linkContents(packed({ entry, moment: { bag, at_ns: 1, own } }));
  assert.deepEqual(await told(false), { file: entry.path, arguments: {}, edits: 0, bag: "run" });
  assert.equal((await told(true))?.file, "/bags/run");
});

test("of a file in no package its path is told", async () => {
  const entry = { path: "/tmp/one.xacro", package: "", inside: "" };
  assert.equal((await linkContents(packed({ entry })))?.file, "/tmp/one.xacro");
});

test("what is cut off, of another version or far too large tells nothing", async () => {
  const whole = packed({ entry: { path: "/tmp/one.xacro" } });
  const bomb = packed({ entry: { path: "x".repeat(3 << 20) } });
  for (const text of [whole.slice(0, -9), `2${whole.slice(1)}`, "1", "1%%%", bomb])
    assert.equal(await linkContents(text), null);
});
