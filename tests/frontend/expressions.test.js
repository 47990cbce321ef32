import assert from "node:assert/strict";
import { test } from "node:test";
import {
  completions,
  isExpression,
  parseArguments,
  shownText,
  splitVector,
  writtenText,
} from "../../frontend_assets/lib/expressions.js";

test("what xacro would compute is an expression, an escaped dollar is not", () => {
  assert.equal(isExpression("${a / 2}"), true);
  assert.equal(isExpression("0 0 $(arg z)"), true);
  assert.equal(isExpression("0.5"), false);
  assert.equal(isExpression("$${a}"), false);
});

test("the braces of a lone expression are not shown", () => {
  assert.equal(shownText("${wheel_radius / 2.1}"), "wheel_radius / 2.1");
  assert.equal(shownText("${dict(a={'b': 1})}"), "dict(a={'b': 1})");
  assert.equal(shownText("${a}${b}"), "${a}${b}");
  assert.equal(shownText("$(arg name)"), "$(arg name)");
  assert.equal(shownText("${open"), "${open");
});

test("a bare expression gets its braces where the file computes, and only there", () => {
  assert.equal(writtenText("wheel_radius / 2", true), "${wheel_radius / 2}");
  assert.equal(writtenText(" 0.25 ", true), "0.25");
  assert.equal(writtenText("${a}", true), "${a}");
  assert.equal(writtenText("$(arg a)", true), "$(arg a)");
  assert.equal(writtenText("left wheel", false), "left wheel");
});

test("blanks inside an expression do not part a vector", () => {
  assert.deepEqual(splitVector("0.1  ${a + b} -2"), ["0.1", "${a + b}", "-2"]);
  assert.deepEqual(splitVector("$(arg x) ${d['a b']}0"), ["$(arg x)", "${d['a b']}0"]);
  assert.deepEqual(splitVector(" "), []);
  assert.deepEqual(splitVector("${never closed"), ["${never", "closed"]);
});

test("arguments are read as on the command line", () => {
  assert.deepEqual(parseArguments("ur_type:=ur10e name:=ur"), { ur_type: "ur10e", name: "ur" });
  assert.deepEqual(parseArguments(`a:="two words" b:=x:=y c`), { a: "two words", b: "x:=y" });
  assert.deepEqual(parseArguments("  "), {});
});

test("the word that is being typed is completed, the rest of the expression stays", () => {
  const names = ["wheel_radius", "wheel_width", "base_length", "wheel"];
  assert.deepEqual(completions("2 * wheel", names), ["2 * wheel_radius", "2 * wheel_width"]);
  assert.deepEqual(completions("BASE", names), ["base_length"]);
  assert.deepEqual(completions("0.5", names), []);
  assert.deepEqual(completions("wheel * ", names), []);
});
