/** @import { OriginAttribute } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  byElement,
  countedAspects,
  referredPart,
  valueText,
} from "../../frontend_assets/model/origin.js";
import { offsetAt, replacement } from "../../frontend_assets/panels/origin/origin.js";
import { elementsByLine } from "../../frontend_assets/panels/urdf/urdf.js";

/** @param {string} element @param {string} attribute @returns {OriginAttribute} */
const attribute = (element, attribute) => ({
  element,
  attribute,
  value: "1",
  text: "1",
  unit: "",
  place: { file: "a", line: 1, column: 1 },
  site: "",
  inputs: [],
});

test("attributes of one element stand together, of two of the same name apart", () => {
  const groups = byElement([
    attribute("", "name"),
    attribute("visual[1]/origin", "xyz"),
    attribute("visual[1]/origin", "rpy"),
    attribute("visual[2]/origin", "xyz"),
  ]);
  assert.deepEqual(
    groups.map(({ element, attributes }) => [element, attributes.length]),
    [
      ["", 1],
      ["visual[1]/origin", 2],
      ["visual[2]/origin", 1],
    ],
  );
});

test("numbers are shortened and have a unit, other texts stay as they are", () => {
  assert.equal(valueText("0.1234567", "m", false), "0.123457 m");
  assert.equal(valueText("1.5707963267948966 0 0", "rad", true), "90  0  0 °");
  assert.equal(valueText("package://a/b c.stl", "", true), "package://a/b c.stl");
  assert.equal(valueText("", "m", false), "");
});

test("what is counted is told in one order, and nothing that is not there", () => {
  assert.deepEqual(countedAspects({ pose: 2, other: 0, size: 4 }), [
    { aspect: "size", count: 4 },
    { aspect: "pose", count: 2 },
  ]);
});

const URDF = `<?xml version="1.0" ?>
<robot name="r">
  <link name="a &lt;b&gt;">
    <visual>
      <origin xyz="0 0 0" />
    </visual>
    <visual />
  </link>
  <gazebo>
    <plugin name="p">text
      of two lines</plugin>
  </gazebo>
  <gazebo reference="a" />
  <joint name="j" type="fixed" />
  <joint name="j" type="fixed" />
</robot>`;

test("a line of the URDF is told as the studio names its part and element", () => {
  const found = elementsByLine(URDF.split("\n"));
  assert.deepEqual(
    [...found],
    [
      [2, { part: "link:a <b>", element: "" }],
      [3, { part: "link:a <b>", element: "visual[1]" }],
      [4, { part: "link:a <b>", element: "visual[1]/origin" }],
      [6, { part: "link:a <b>", element: "visual[2]" }],
      [8, { part: "other:0", element: "" }],
      [9, { part: "other:0", element: "plugin" }],
      [12, { part: "other:1", element: "" }],
      [13, { part: "joint:j", element: "" }],
      [14, { part: "joint:j#2", element: "" }],
    ],
  );
});

test("a text that is cut off is read as far as it goes", () => {
  assert.deepEqual(
    [...elementsByLine(["<robot>", '  <link name="a">', "</a></b></c>"])],
    [[1, { part: "link:a", element: "" }]],
  );
  assert.equal(elementsByLine([]).size, 0);
});

test("a written text is found by line and column, whatever stands before it", () => {
  const file = '<a>\n  <b n="ä" t="🦀" x=\'1 &lt; 2\'/>\n</a>';
  const column = '  <b n="ä" t="'.length + 1;
  assert.deepEqual(replacement(file, { line: 2, column }, "🦀", "\"'&<"), {
    start: file.indexOf("🦀"),
    end: file.indexOf("🦀") + 2,
    text: "&quot;'&amp;&lt;",
  });
  const later = [...'  <b n="ä" t="🦀" x=\''].length + 1;
  assert.deepEqual(replacement(file, { line: 2, column: later }, "1 < 2", "'"), {
    start: file.indexOf("1 &lt;"),
    end: file.indexOf("1 &lt;") + "1 &lt; 2".length,
    text: "&apos;",
  });
});

test("where something else stands by now, nothing is written", () => {
  const file = '<a x="1"/>';
  const place = { line: 1, column: 7 };
  assert.equal(replacement(file, place, "2", "3"), null);
  assert.equal(replacement(file, { line: 1, column: 2 }, "a", "b"), null);
  assert.equal(replacement(file, { line: 5, column: 1 }, "1", "3"), null);
  assert.equal(replacement(file, { line: 1, column: 99 }, "1", "3"), null);
  assert.equal(offsetAt(file, place), 6);
});

test("an attribute that names another part leads there", () => {
  assert.equal(referredPart({ ...attribute("child", "link"), value: "arm" }), "link:arm");
  assert.equal(referredPart({ ...attribute("mimic", "joint"), value: "a" }), "joint:a");
  assert.equal(referredPart(attribute("", "name")), null);
});
