import assert from "node:assert/strict";
import { test } from "node:test";
import {
  callOf,
  fileRows,
  macrosOf,
  valuesOf,
} from "../../frontend_assets/panels/outline/outline.js";

const place = { file: "/r/a.xacro", line: 1, column: 1, length: 0 };

/** @param {string} name @param {number} inside */
const file = (name, inside) => ({
  file: `/r/${name}`,
  inside,
  place: inside < 0 ? null : place,
  namespace: "",
  is_yaml: false,
});
const FILES = [
  file("main.xacro", -1),
  file("arm.xacro", 0),
  file("hand.xacro", 1),
  file("w.yaml", 0),
];

/** @param {string} name @param {Partial<import("../../frontend_assets/types/wire.d.ts").Parameter>} [more] */
const parameter = (name, more) => ({
  name,
  kind: "value",
  default: null,
  forwards: false,
  ...more,
});
/** @param {string} name @param {string} doc @param {ReturnType<typeof parameter>[]} parameters */
const macro = (name, doc, parameters) => ({
  name,
  doc,
  parameters,
  place,
  calls: 0,
  called_at: [],
});

/** @param {import("../../frontend_assets/panels/outline/outline.js").FileRow[]} rows */
const shown = (rows) => rows.map(({ file: one, level }) => `${level} ${one.file.slice(3)}`);

test("files stand below the one that includes them", () => {
  const rows = fileRows(FILES, new Set(), "");
  assert.deepEqual(shown(rows), ["1 main.xacro", "2 arm.xacro", "3 hand.xacro", "2 w.yaml"]);
  assert.deepEqual(
    rows.map(({ expandable }) => expandable),
    [true, true, false, false],
  );
});

test("a closed file hides those that it includes", () => {
  assert.deepEqual(shown(fileRows(FILES, new Set(["1"]), "")), [
    "1 main.xacro",
    "2 arm.xacro",
    "2 w.yaml",
  ]);
});

test("a filter shows matching files and the way to them, whatever is closed", () => {
  assert.deepEqual(shown(fileRows(FILES, new Set(["0", "1"]), "HAND")), [
    "1 main.xacro",
    "2 arm.xacro",
    "3 hand.xacro",
  ]);
  assert.deepEqual(fileRows(FILES, new Set(), "r/"), []);
});

test("files that name each other as their includer end the list, not the page", () => {
  assert.deepEqual(fileRows([file("a", 1), file("b", 0)], new Set(), ""), []);
});

test("macros are found by all words of name, documentation and parameters", () => {
  const macros = [macro("wheel", "Turns about y", [parameter("side")]), macro("arm", "", [])];
  const outline = { files: [], macros, values: [], is_current: true };
  const names = (/** @type {string} */ words) => macrosOf(outline, words).map(({ name }) => name);
  assert.deepEqual(names(""), ["arm", "wheel"]);
  assert.deepEqual(names("turns SIDE"), ["wheel"]);
  assert.deepEqual(names("turns arm"), []);
});

test("args come before properties, each by name", () => {
  const value = (/** @type {"arg" | "property"} */ kind, /** @type {string} */ name) => ({
    kind,
    name,
    place,
    text: "",
    values: [],
    doc: "",
  });
  const values = [value("property", "b"), value("arg", "c"), value("property", "a")];
  const found = valuesOf({ files: [], macros: [], values, is_current: true }, "");
  assert.deepEqual(
    found.map(({ name }) => name),
    ["c", "a", "b"],
  );
});

test("a call has what it must have, and places to type it", () => {
  const given = [
    parameter("a"),
    parameter("b", { default: "1" }),
    parameter("c", { forwards: true }),
  ];
  assert.deepEqual(callOf(macro("m", "", given)), { text: '<xacro:m a=""/>', stops: [[12, 12]] });
  const block = callOf(macro("ns.m", "", [parameter("o", { kind: "block" })]));
  assert.deepEqual(block, { text: "<xacro:ns.m></xacro:ns.m>", stops: [[12, 12]] });
});
