/** @import { JointView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { documentOf } from "../../frontend_assets/lib/address.js";
import { matches, shortcutText } from "../../frontend_assets/lib/commands.js";
import { createGesture } from "../../frontend_assets/lib/gesture.js";
import { movableJoints, rangeOf, unitsOf } from "../../frontend_assets/lib/joints.js";
import { placeText, shortPath } from "../../frontend_assets/lib/paths.js";
import { readJointFrame, readView } from "../../frontend_assets/model/wire.js";
import { sourcesIn } from "./support/sources.js";
import { filesOfWords, LANGUAGES, wordsOf } from "./support/words.js";

/** @param {Partial<JointView>} [more] @returns {JointView} */
const joint = (more = {}) => ({
  name: "j",
  type: "revolute",
  parent: "a",
  child: "b",
  axis: [0, 0, 1],
  lower: -1,
  upper: 2,
  mimic: "",
  multiplier: 1,
  file: "",
  line: 0,
  ...more,
});

/** @param {string} key @param {Partial<import("../../frontend_assets/lib/commands.js").Stroke>} [more] */
const stroke = (key, more = {}) => ({
  key,
  ctrlKey: false,
  metaKey: false,
  shiftKey: false,
  altKey: false,
  ...more,
});

test("a joint frame gives its revision and its positions", () => {
  const bytes = new ArrayBuffer(8 + 16);
  const view = new DataView(bytes);
  view.setUint8(0, 1);
  view.setUint32(4, 70_000, true);
  view.setFloat64(8, 0.25, true);
  view.setFloat64(16, -1.5, true);
  const frame = readJointFrame(bytes);
  assert.equal(frame?.revision, 70_000);
  assert.deepEqual([...(frame?.positions ?? [])], [0.25, -1.5]);
});

test("a frame of another kind or cut short is not taken for joints", () => {
  assert.equal(readJointFrame(new ArrayBuffer(4)), null);
  assert.equal(readJointFrame(new ArrayBuffer(16)), null);
  const cut = new ArrayBuffer(13);
  new DataView(cut).setUint8(0, 1);
  assert.equal(readJointFrame(cut), null);
});

test("a view frame gives the presenter's camera, and the pointer where there is one", () => {
  const bytes = new ArrayBuffer(60);
  const view = new DataView(bytes);
  view.setUint8(0, 2);
  view.setUint8(1, 1);
  for (let at = 0; at < 13; at += 1) view.setFloat32(8 + 4 * at, at, true);
  assert.deepEqual(readView(bytes), {
    ...{ eye: [0, 1, 2], target: [3, 4, 5], pointer: [6, 7, 8] },
    ...{ up: [9, 10, 11], field: 12, flat: true },
  });
  view.setUint8(1, 0);
  view.setFloat32(8 + 4 * 6, Number.NaN, true);
  assert.deepEqual([readView(bytes)?.pointer, readView(bytes)?.flat], [null, false]);
  assert.equal(readView(new ArrayBuffer(44)), null);
});

test("joints of frames are those that turn or slide, followers too", () => {
  const joints = ["fixed", "revolute", "planar", "prismatic", "floating", "continuous"].map(
    (type) =>
      joint({
        type: /** @type {JointView["type"]} */ (type),
        mimic: type === "prismatic" ? "j" : "",
      }),
  );
  assert.deepEqual(
    movableJoints(joints).map(({ type }) => type),
    ["revolute", "prismatic", "continuous"],
  );
});

test("a joint without usable limits gets a turn, or a metre to each side", () => {
  assert.deepEqual(rangeOf(joint()), { lower: -1, upper: 2, limited: true });
  assert.deepEqual(rangeOf(joint({ type: "continuous" })), {
    lower: -Math.PI,
    upper: Math.PI,
    limited: false,
  });
  assert.deepEqual(rangeOf(joint({ type: "prismatic", lower: null })), {
    lower: -1,
    upper: 1,
    limited: false,
  });
  assert.equal(rangeOf(joint({ lower: 0, upper: 0 })).limited, false);
});

test("degrees are for angles only", () => {
  assert.equal(unitsOf(joint(), true).show(Math.PI / 2), 90);
  assert.equal(unitsOf(joint(), false).unit, "rad");
  assert.equal(unitsOf(joint({ type: "prismatic" }), true).unit, "m");
});

test("a joint that turns without end is shown within one turn", () => {
  const wheel = joint({ type: "continuous" });
  const { show } = unitsOf(wheel, false);
  assert.deepEqual([show(0.5), show(Math.PI), show(-Math.PI)], [0.5, Math.PI, -Math.PI]);
  assert.ok(Math.abs(show(100.5 * Math.PI * 2) + Math.PI) < 1e-9);
  assert.ok(Math.abs(show(-2 * Math.PI - 0.25) + 0.25) < 1e-9);
  assert.ok(Math.abs(unitsOf(wheel, true).show(2.5 * Math.PI) - 90) < 1e-9);
  assert.equal(unitsOf(joint({ type: "revolute" }), false).show(7), 7);
});

test("a burst of edits is one gesture; a pause or an end begins a new one", () => {
  let now = 0;
  const gesture = createGesture(() => now);
  const first = gesture.id();
  now += 500;
  assert.equal(gesture.id(), first);
  now += 2000;
  const second = gesture.id();
  assert.notEqual(second, first);
  gesture.end();
  assert.notEqual(gesture.id(), second);
  assert.notEqual(createGesture(() => now).id(), gesture.id());
});

test("a drag is one gesture, however long the pointer rests", () => {
  let now = 0;
  const gesture = createGesture(() => now);
  const first = gesture.id();
  gesture.hold();
  now += 60_000;
  assert.equal(gesture.id(), first);
  gesture.release();
  now += 100;
  assert.equal(gesture.id(), first);
  gesture.hold();
  gesture.end();
  assert.notEqual(gesture.id(), first);
});

test("a shortcut matches its own keys and no others", () => {
  assert.ok(matches("Mod+S", stroke("s", { ctrlKey: true })));
  assert.ok(matches("Mod+S", stroke("s", { metaKey: true })));
  assert.ok(matches("Mod+Shift+Z", stroke("Z", { ctrlKey: true, shiftKey: true })));
  assert.ok(!matches("Mod+Z", stroke("Z", { ctrlKey: true, shiftKey: true })));
  assert.ok(!matches("F", stroke("f", { ctrlKey: true })));
  assert.ok(matches("?", stroke("?", { shiftKey: true })));
  assert.ok(!matches("F6", stroke("F6", { shiftKey: true })));
  assert.equal(shortcutText("Mod+Shift+Z", false), "Ctrl Shift Z");
  assert.equal(shortcutText("Mod+Shift+Z", true), "⌘⇧Z");
});

test("paths are short below the root and whole elsewhere", () => {
  assert.equal(shortPath("/ws/rover/urdf/a.xacro", "/ws/rover"), "urdf/a.xacro");
  assert.equal(shortPath("/ws/rover2/a.xacro", "/ws/rover"), "/ws/rover2/a.xacro");
  assert.equal(shortPath("/a.xacro", ""), "/a.xacro");
  assert.equal(placeText({ file: "/ws/a.xacro", line: 12 }), "a.xacro:12");
  assert.equal(placeText({ file: "/ws/a.xacro", line: 0 }), "a.xacro");
  assert.equal(placeText(null), "");
});

test("the document is named by the page's address", () => {
  assert.equal(documentOf("/d/rover-1"), "rover-1");
  assert.equal(documentOf("/d/a%20b/"), "a b");
  assert.equal(documentOf("/"), "");
});

test("every language says the same things, with the same blanks to fill", () => {
  for (const { file, words: all } of filesOfWords()) {
    assert.deepEqual(Object.keys(all), LANGUAGES, file);
    const english = all.en ?? {};
    for (const [language, words] of Object.entries(all)) {
      assert.deepEqual(Object.keys(words), Object.keys(english), `${file} ${language}`);
      for (const [key, text] of Object.entries(english)) {
        const blanks = (/** @type {string} */ one) => (one.match(/\{\w+\}/g) ?? []).toSorted();
        assert.deepEqual(blanks(words[key] ?? ""), blanks(text), `${file} ${language}: ${key}`);
      }
    }
  }
});

test("no word is written twice", () => {
  const keys = filesOfWords().flatMap(({ words }) => Object.keys(words.en ?? {}));
  assert.equal(new Set(keys).size, keys.length);
});

test("every word that the page asks for is there, and none lies about unused", () => {
  const sources = sourcesIn(["app/", "model/", "panels/", "lib/"])
    .map(([, text]) => text)
    .join("\n");
  const keys = Object.keys(wordsOf("en"));
  const asked = [...sources.matchAll(/\bt\(\s*"([\w.]+)"/g)].map(([, key]) => key ?? "");
  for (const key of asked) assert.ok(keys.includes(key), `${key} has no words`);
  const families = [...sources.matchAll(/`([\w.]+\.)(?:to_)?\$\{/g)].map(
    ([, start]) => start ?? "",
  );
  families.push("join."); // in the form that the server writes, studio/server/pages.py
  for (const key of keys) {
    const plain = key.replace(/\.(one|touch)$/, "");
    const used = sources.includes(`"${plain}"`) || families.some((start) => key.startsWith(start));
    assert.ok(used, `${key} is said nowhere`);
  }
});
