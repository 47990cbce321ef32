import assert from "node:assert/strict";
import { test } from "node:test";
import { crumbsOf } from "../../frontend_assets/app/file-browser.js";
import { nameFault, robotOf } from "../../frontend_assets/app/place-form.js";
import { chosenFiles, droppedFiles } from "../../frontend_assets/lib/files.js";
import { isFilePath, pastedPath } from "../../frontend_assets/lib/paths.js";
import { timeAgo } from "../../frontend_assets/lib/times.js";

test("the way to a folder begins at the served folder that holds it", () => {
  const roots = ["/ws", "/ws/src/inner", "/wsx"];
  assert.deepEqual(crumbsOf("/ws/src/my pkg", roots), [
    { name: "ws", path: "/ws" },
    { name: "src", path: "/ws/src" },
    { name: "my pkg", path: "/ws/src/my pkg" },
  ]);
  assert.deepEqual(crumbsOf("/wsx", roots), [{ name: "wsx", path: "/wsx" }]);
  assert.deepEqual(crumbsOf("", roots), []);
});

test("a folder of Windows has its way, too", () => {
  const crumbs = crumbsOf("C:\\ws\\src", ["C:\\ws"]);
  assert.deepEqual(crumbs.at(-1), { name: "src", path: "C:\\ws\\src" });
});

test("each bad name of a package has its own sentence, a good one has none", () => {
  const said = { ab: "", my_rover_description: "", a: "name.short", "": "name.short" };
  const faults = {
    Rover: "name.capital",
    "my rover": "name.blank",
    "my-rover": "name.blank",
    räder: "name.sign",
    "../x": "name.sign",
    "2wheels": "name.first",
    _rover: "name.first",
    a__b: "name.double",
    rover_: "name.last",
    ["a".repeat(61)]: "name.long",
  };
  for (const [name, fault] of Object.entries({ ...said, ...faults }))
    assert.equal(nameFault(name), fault, name);
});

test("a robot is called as its package without the ending", () => {
  assert.equal(robotOf("my_rover_description"), "my_rover");
  assert.equal(robotOf("_description"), "_description");
});

test("times are told as people say them", () => {
  const now = Date.UTC(2026, 10, 21);
  assert.equal(timeAgo(now - 5_000, now, "en"), "now");
  assert.equal(timeAgo(now - 3 * 3_600_000, now, "en"), "3 hours ago");
  assert.equal(timeAgo(now - 86_400_000, now, "de"), "gestern");
  assert.equal(timeAgo(now + 60_000, now, "en"), "now");
});

/** @param {string} name @param {string} [path] @returns {File} */
const file = (name, path = "") => /** @type {File} */ ({ name, webkitRelativePath: path });

test("of a chosen folder hidden files stay away", () => {
  const files = [
    file("r.urdf", "ws/r.urdf"),
    file("x", "ws/.git/x"),
    file("y", "ws/__pycache__/y"),
  ];
  assert.deepEqual(
    chosenFiles(files).map(({ path }) => path),
    ["ws/r.urdf"],
  );
});

/** @param {string} name */
const fileEntry = (name) => ({
  name,
  isFile: true,
  /** @param {(one: File) => void} take */
  file: (take) => take(file(name)),
});

/** @param {string} name @param {object[][]} batches as a browser tells them */
const folderEntry = (name, batches) => ({
  name,
  isFile: false,
  createReader: () => {
    const left = [...batches, []];
    return {
      /** @param {(some: object[]) => void} take */
      readEntries: (take) => take(left.shift() ?? []),
    };
  },
});

test("a dropped folder is gone through to its last batch", async () => {
  const inner = folderEntry("meshes", [[fileEntry("a.stl")], [fileEntry("b.stl")]]);
  const top = folderEntry("robot", [[fileEntry("r.urdf"), inner, folderEntry(".git", [])]]);
  const transfer = /** @type {any} */ ({
    items: [{ webkitGetAsEntry: () => top }, { webkitGetAsEntry: () => fileEntry("beside.stl") }],
    files: [],
  });
  const paths = (await droppedFiles(transfer)).map(({ path }) => path);
  assert.deepEqual(paths, [
    "robot/r.urdf",
    "robot/meshes/a.stl",
    "robot/meshes/b.stl",
    "beside.stl",
  ]);
});

test("a path is known as one, as people copy them, and a word or a text is none", () => {
  assert.equal(pastedPath("  /ws/my robot/a.xacro\n"), "/ws/my robot/a.xacro");
  assert.equal(pastedPath('"C:\\ws\\arm.urdf"'), "C:\\ws\\arm.urdf");
  assert.equal(pastedPath("file:///ws/arm.urdf"), "/ws/arm.urdf");
  assert.equal(pastedPath("~/ws"), "~/ws");
  for (const other of ["arm", "arm/urdf", "", "/a\n/b", "<robot/>", "http://a/b.urdf"])
    assert.equal(pastedPath(other), "");
  assert.deepEqual(["/a/b.urdf.xacro", "/a/b.ZIP", "/a/b"].map(isFilePath), [true, true, false]);
});
