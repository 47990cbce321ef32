import assert from "node:assert/strict";
import { test } from "node:test";
import {
  matchingOffers,
  shortOf,
  tookText,
  turnedRad,
  withOperations,
} from "../../frontend_assets/model/operations.js";

test("what changed takes the place of what was known, and new ones come last", () => {
  const known = [
    { operation: 1, state: "calling" },
    { operation: 2, state: "answered" },
  ];
  const news = [
    { operation: 3, state: "calling" },
    { operation: 1, state: "failed" },
  ];
  assert.deepEqual(
    withOperations(known, { whole: false, operations: news }).map(({ operation, state }) => [
      operation,
      state,
    ]),
    [
      [1, "failed"],
      [2, "answered"],
      [3, "calling"],
    ],
  );
  assert.equal(withOperations(known, { whole: true, operations: [] }).length, 0);
});

test("feedback is put together in its order, each once, the last ones kept", () => {
  const goal = (/** @type {number[]} */ ...numbers) => ({
    operation: 1,
    feedback: numbers.map((number) => ({ number })),
  });
  const told = withOperations([goal(1, 2, 3)], { whole: false, operations: [goal(3, 4)] });
  assert.deepEqual(
    told[0]?.feedback?.map(({ number }) => number),
    [1, 2, 3, 4],
  );
  const quiet = withOperations(told, { whole: false, operations: [goal()] });
  assert.equal(quiet[0]?.feedback?.length, 4);
  const many = goal(...Array.from({ length: 60 }, (_, n) => n + 5));
  const last = withOperations(quiet, { whole: false, operations: [many] })[0]?.feedback ?? [];
  assert.deepEqual([last.length, last.at(-1)?.number], [50, 64]);
});

test("what every node serves is left out until it is asked for", () => {
  const offer = (/** @type {string} */ name) => ({ name, types: ["a/srv/B"], nodes: ["/n"] });
  const offers = ["/add", "/n/get_parameters", "/x/_action/send_goal"].map(offer);
  assert.deepEqual(
    matchingOffers(offers, "", false).map(({ name }) => name),
    ["/add"],
  );
  assert.equal(matchingOffers(offers, "", true).length, 3);
  assert.equal(matchingOffers(offers, "ADD srv/b /n", false).length, 1);
  assert.equal(matchingOffers(offers, "nothing", true).length, 0);
});

test("plain values are told on a line, times in the unit that fits", () => {
  assert.equal(shortOf({ a: 1, b: { c: [1, "x"] } }), "a: 1, b: {c: [1, x]}");
  assert.deepEqual([0.0104, 1.25, 250].map(tookText), ["10 ms", "1.3 s", "250 s"]);
});

test("turtlesim's delta is told as a turn to the left, and no other action's is", () => {
  assert.equal(turnedRad("turtlesim/action/RotateAbsolute", { delta: -1.5 }), 1.5);
  assert.equal(turnedRad("turtlesim/action/RotateAbsolute", undefined), null);
  assert.equal(turnedRad("arm/action/Turn", { delta: -1.5 }), null);
});
