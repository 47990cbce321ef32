import assert from "node:assert/strict";
import { test } from "node:test";
import {
  asText,
  countOf,
  filteredFindings,
  keyed,
  shownPlaces,
} from "../../frontend_assets/panels/doctor/doctor.js";

/** @typedef {import("../../frontend_assets/types/wire.d.ts").Finding} Finding */

/** @param {Partial<Finding>} news @returns {Finding} */
const finding = (news) => ({
  code: "qos",
  level: "warn",
  subject: "qos",
  sentence: "/scan: it does not fit.",
  evidence: ["/lidar offers best effort"],
  mend: null,
  line: "",
  about: [{ kind: "topic", name: "/scan" }],
  talk: null,
  ...news,
});

test("words are looked for in sentence, evidence and code, and levels can be hidden", () => {
  const all = [finding({}), finding({ code: "type", level: "error", sentence: "/x has 2 types." })];
  const codes = (/** @type {string} */ words, /** @type {any[]} */ hidden = []) =>
    filteredFindings(all, { words, hidden: new Set(hidden) }).map(({ code }) => code);
  assert.deepEqual(codes(""), ["qos", "type"]);
  assert.deepEqual(codes("LIDAR fit"), ["qos"]);
  assert.deepEqual(codes("types"), ["type"]);
  assert.deepEqual(codes("nothing like it"), []);
  assert.deepEqual(codes("", ["error"]), ["qos"]);
  assert.equal(countOf(all, "error"), 1);
});

test("a finding keeps its key while the numbers in its sentence change", () => {
  const keys = (/** @type {Finding[]} */ some) => keyed(some).map(([key]) => key);
  const before = keys([finding({ sentence: "5 Hz" }), finding({ sentence: "twice" })]);
  assert.deepEqual(keys([finding({ sentence: "6 Hz" }), finding({ sentence: "twice" })]), before);
  assert.equal(new Set(before).size, 2);
  assert.notDeepEqual(keys([finding({ about: [] })]), before.slice(0, 1));
});

test("each place is shown by one button", () => {
  const about = [
    { kind: "topic", name: "/scan" },
    { kind: "topic", name: "/scan" },
    { kind: "display", name: "1" },
    { kind: "display", name: "2" },
    { kind: "connection", name: "" },
    { kind: "graphics", name: "" },
  ];
  const shown = shownPlaces(/** @type {Finding["about"]} */ (about));
  assert.deepEqual(
    shown.map(({ kind }) => kind),
    ["topic", "display", "connection", "graphics"],
  );
});

test("what is copied holds all that helps somebody else", () => {
  const text = asText([finding({ line: "ros2 topic info -v /scan" })]);
  assert.match(text, /: \/scan: it does not fit\. \[qos\]\n {2}\/lidar offers best effort\n/);
  assert.match(text, /\$ ros2 topic info -v \/scan$/);
});
