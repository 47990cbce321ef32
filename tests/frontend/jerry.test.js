import assert from "node:assert/strict";
import { test } from "node:test";
import {
  distanceOf,
  formulaText,
  gridLines,
  isSame,
  jerriesOf,
  moveOf,
  placeText,
  viewOf,
  Walk,
} from "../../frontend_assets/panels/jerry/world.js";

/** @param {string} name @param {string} type @param {number} publishers */
const topic = (name, type, publishers = 1) => ({
  ...{ name, types: [type], publishers, subscribers: 1, kind: "" },
});
const COMMAND = "pkg_with_interfaces/msg/JerryCommand";
const DISTANCE = "pkg_with_interfaces/srv/Distance";

test("a Jerry is what takes commands, tells where he is and serves distances in one namespace", () => {
  const topics = [
    topic("/jerry_command", COMMAND, 0),
    topic("/jerry/pose", "geometry_msgs/msg/Point"),
    topic("/two/jerry_command", "my_interfaces/msg/JerryCommand"),
    topic("/clicked_point", "geometry_msgs/msg/Point"),
  ];
  const found = jerriesOf(topics, [{ name: "/distance", types: [DISTANCE], nodes: ["/jerry"] }]);
  assert.deepEqual(found, [
    {
      prefix: "",
      command: { name: "/jerry_command", type: COMMAND },
      pose: { name: "/jerry/pose", type: "geometry_msgs/msg/Point" },
      distance: { name: "/distance", type: DISTANCE },
    },
    {
      prefix: "/two",
      command: { name: "/two/jerry_command", type: "my_interfaces/msg/JerryCommand" },
      ...{ pose: null, distance: null },
    },
  ]);
  assert.deepEqual(jerriesOf([topic("/clicked_point", "geometry_msgs/msg/Point")], []), []);
});

test("forward is along x and left along y; what he does not know moves him not at all", () => {
  assert.deepEqual(moveOf({ direction: "forward", steps: 3 }), { x: 3, y: 0 });
  assert.deepEqual(moveOf({ direction: "right", steps: 2 }), { x: 0, y: -2 });
  assert.deepEqual(moveOf({ direction: "backward", steps: 0 }), { x: 0, y: 0 });
  for (const steps of [-1, 0.5, Number.NaN])
    assert.equal(moveOf({ direction: "left", steps }), null);
  assert.equal(moveOf({ direction: "constructor", steps: 1 }), null);
});

test("a distance is exact but for the last bits, and its formula can be followed", () => {
  assert.equal(distanceOf({ x: 0, y: 0 }, { x: 3, y: 4 }), 5);
  assert.ok(isSame(Math.hypot(1.1, 2.2), distanceOf({ x: 0, y: 0 }, { x: 1.1, y: 2.2 })));
  assert.ok(!isSame(5, 5.0001));
  assert.equal(formulaText({ x: 1, y: -2 }, { x: 3, y: 4.5 }), "√((3 − 1)² + (4.5 − (−2))²)");
  assert.equal(placeText({ x: -0, y: -1.25 }), "(0, −1.25)");
});

test("the view is a square with all places in it, and few lines", () => {
  const far = [
    { x: 900, y: -40 },
    { x: -3, y: 5 },
  ];
  const { low, size, step } = viewOf(far);
  for (const { x, y } of [...far, { x: 0, y: 0 }])
    assert.ok(x > low.x && x < low.x + size && y > low.y && y < low.y + size);
  assert.ok(gridLines(low.x, size, step).length <= 17);
  assert.deepEqual(viewOf([{ x: 5, y: -4 }]), viewOf([]));
  assert.deepEqual(viewOf([]), { low: { x: -6, y: -6 }, size: 12, step: 1 });
  assert.deepEqual(gridLines(-2.5, 5, 1), [-2, -1, 0, 1, 2]);
});

/** @param {Walk} walk */
const fates = (walk) => walk.commands.map(({ fate }) => fate);

test("a command is followed by the very step that it asks for, whichever is heard first", () => {
  const walk = new Walk();
  walk.stand({ x: 0, y: 0 }, 1);
  walk.hear({ direction: "forward", steps: 2 }, 2);
  assert.deepEqual(fates(walk), ["pending"]);
  walk.stand({ x: 2, y: 0 }, 2.1);
  assert.deepEqual(fates(walk), ["followed"]);
  walk.stand({ x: 2, y: 3 }, 3);
  walk.hear({ direction: "left", steps: 3 }, 3.1);
  assert.deepEqual(fates(walk), ["followed", "followed"]);
  assert.deepEqual(walk.way, [
    { x: 0, y: 0 },
    { x: 2, y: 0 },
    { x: 2, y: 3 },
  ]);
});

test("of two equal commands each has its own step", () => {
  const walk = new Walk();
  walk.stand({ x: 0, y: 0 }, 1);
  for (const heard_s of [2, 2.1]) walk.hear({ direction: "forward", steps: 1 }, heard_s);
  walk.stand({ x: 1, y: 0 }, 2.2);
  assert.deepEqual(fates(walk), ["pending", "followed"]);
  walk.stand({ x: 2, y: 0 }, 2.3);
  assert.deepEqual(fates(walk), ["followed", "followed"]);
});

test("who goes the wrong way, or nowhere, has not followed once his time is over", () => {
  const walk = new Walk();
  walk.stand({ x: 0, y: 0 }, 1);
  walk.hear({ direction: "left", steps: 1 }, 2);
  walk.stand({ x: 0, y: -1 }, 2.1);
  assert.equal(walk.expire(3), false);
  assert.equal(walk.expire(4.5), true);
  assert.deepEqual(fates(walk), ["ignored"]);
});

test("an unknown command is no fault of his, and no step was asked for is none that he took", () => {
  const walk = new Walk();
  walk.hear({ direction: "up", steps: 1 }, 1);
  walk.hear({ direction: "left", steps: 0 }, 1);
  assert.deepEqual(fates(walk), ["followed", "unknown"]);
});

test("places that are no numbers are left out, and nothing grows without bound", () => {
  const walk = new Walk();
  walk.stand({ x: Number.NaN, y: 0 }, 1);
  assert.equal(walk.place, null);
  for (let n = 0; n < 5000; n += 1) {
    walk.stand({ x: n, y: 0 }, n);
    walk.hear({ direction: "left", steps: n + 1 }, n);
  }
  assert.ok(walk.way.length <= 1000 && walk.commands.length <= 40 && walk.steps.length <= 40);
  walk.clear();
  assert.deepEqual(walk.way, [{ x: 4999, y: 0 }]);
});
