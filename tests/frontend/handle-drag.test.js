import assert from "node:assert/strict";
import { test } from "node:test";
import {
  about,
  after,
  facing,
  HandleDrag,
  Mode,
  turned,
  turnTo,
} from "../../frontend_assets/viser/handle-drag.js";

/** @import { Vector } from "../../frontend_assets/lib/vectors.js" */
/** @import { Control, Mouse, Sight, Turn } from "../../frontend_assets/viser/handle-drag.js" */

const EYE = /** @type {Vector} */ ([0, -5, 0]);
const PX = 500;
/** @type {Turn} */
const STILL = [1, 0, 0, 0];

/** An eye 5 m before the origin that looks along y, with z up. @type {Sight} */
const sight = {
  rayAt: (x, y) => {
    const way = [(x - 400) / PX, 1, (300 - y) / PX];
    const size = Math.hypot(...way);
    const [dx = 0, dy = 0, dz = 0] = way.map((part) => part / size);
    return { origin: EYE, direction: [dx, dy, dz] };
  },
  placeOf: ([x, y, z]) => [400 + (PX * x) / (y + 5), 300 - (PX * z) / (y + 5)],
  axes: () => ({ forward: [0, 1, 0], up: [0, 0, 1], right: [1, 0, 0] }),
};

/** @param {Vector} point @param {Partial<Mouse>} [keys] @returns {Mouse} the mouse over a point */
function over(point, keys = {}) {
  const [x, y] = /** @type {[number, number]} */ (sight.placeOf(point));
  return { x, y, shift: false, ctrl: false, ...keys };
}

/** @param {number} mode @param {Vector} grab @param {Partial<Control>} [control] @param {Partial<Mouse>} [keys] */
function drag(mode, grab, control = {}, keys = {}) {
  const made = { mode, facing: 0, wxyz: STILL, ...control };
  const pose = { turn: STILL, place: /** @type {Vector} */ ([0, 0, 0]) };
  return new HandleDrag(made, sight, pose, 0, grab, over(grab, keys));
}

/** @param {readonly number[]} actual @param {readonly number[]} wanted */
function near(actual, wanted) {
  assert.ok(
    actual.every((part, at) => Math.abs(part - (wanted[at] ?? Number.NaN)) < 1e-6),
    `${actual} is not ${wanted}`,
  );
}

/** @param {Vector} axis @param {number} degrees */
const turn = (axis, degrees) => about(axis, (degrees * Math.PI) / 180);

test("a marker moves along an axis by as much as the mouse goes beside it", () => {
  const one = drag(Mode.MOVE_AXIS, [0.5, 0, 0]);
  assert.ok(one.follow(over([0.9, 0, 0.7])));
  near(one.pose.place, [0.4, 0, 0]);
  const slanted = drag(Mode.MOVE_AXIS, [0, 0, 0], { wxyz: turn([0, 0, 1], 45) });
  slanted.follow(over([1, 1, 0]));
  near(slanted.pose.place, [1, 1, 0]);
});

test("an axis that is seen end-on moves nothing", () => {
  const one = drag(Mode.MOVE_AXIS, [0, 0, 0], { wxyz: turn([0, 0, 1], 90) });
  assert.ok(!one.follow({ x: 450, y: 250, shift: false, ctrl: false }));
});

test("a marker moves in the plane of its control", () => {
  const upright = drag(Mode.MOVE_PLANE, [0, 0, 0], { wxyz: turn([0, 0, 1], 90) });
  upright.follow(over([0.3, 0, -0.2]));
  near(upright.pose.place, [0.3, 0, -0.2]);
});

test("a marker turns about its axis by the angle of the mouse around it", () => {
  const facingUs = { wxyz: turn([0, 0, 1], -90) }; // its x looks at the eye
  const one = drag(Mode.ROTATE_AXIS, [0.5, 0, 0], facingUs);
  one.follow(over([0, 0, 0.7]));
  near(one.pose.place, [0, 0, 0]);
  near(turned(one.pose.turn, [1, 0, 0]), [0, 0, 1]);
  assert.ok(Math.abs(Math.abs(one.rad) - Math.PI / 2) < 1e-6);
  one.follow(over([0.5, 0, 0]));
  near(turned(one.pose.turn, [1, 0, 0]), [1, 0, 0]);
});

test("a ring that moves and turns goes with what was gripped", () => {
  const one = drag(Mode.MOVE_ROTATE, [0.5, 0, 0], { wxyz: turn([0, 0, 1], -90) });
  one.follow(over([0.8, 0, 0]));
  near(one.pose.place, [0.3, 0, 0]);
  near(one.pose.turn, STILL);
  one.follow(over([0.8, 0, 0.4]));
  // What was gripped is under the mouse again.
  const [x, , z] = turned(one.pose.turn, [0.5, 0, 0]);
  near([one.pose.place[0] + x, one.pose.place[2] + z], [0.8, 0.4]);
});

test("freely, a marker moves in the plane of the picture, and with Shift away from the eye", () => {
  const one = drag(Mode.MOVE_3D, [0, 0, 0]);
  one.follow(over([0.2, 0, 0.1]));
  near(one.pose.place, [0.2, 0, 0.1]);
  const mouse = over([0.2, 0, 0.1], { shift: true });
  one.follow(mouse);
  near(one.pose.place, [0.2, 0, 0.1]);
  one.follow({ ...mouse, y: mouse.y - 50 });
  assert.ok((one.pose.place[1] ?? 0) > 0.4, "up is away");
  const before = one.pose.place[1] ?? 0;
  one.follow({ ...mouse, y: mouse.y - 50, shift: false });
  assert.ok(
    Math.abs((one.pose.place[1] ?? 0) - before) < 1e-6,
    "letting go of Shift moves nothing",
  );
  assert.ok(one.wheel(1) && (one.pose.place[1] ?? 0) > before);
});

test("freely, a marker turns with the mouse, and in the picture with Shift", () => {
  const one = drag(Mode.ROTATE_3D, [0, 0, 0]);
  one.follow({ x: 475, y: 300, shift: false, ctrl: false });
  near(one.pose.turn, turn([0, 0, 1], 90)); // 300 px are a whole turn
  const rolled = drag(Mode.ROTATE_3D, [0, 0, 0], {}, { shift: true });
  rolled.follow({ x: 400, y: 375, shift: true, ctrl: false });
  near(rolled.pose.turn, turn([0, 1, 0], 90));
  assert.ok(!rolled.wheel(1), "the wheel turns nothing");
});

test("one that does both turns with Ctrl", () => {
  const one = drag(Mode.MOVE_ROTATE_3D, [0, 0, 0], {}, { ctrl: true });
  one.follow({ x: 400, y: 375, shift: false, ctrl: true });
  near(one.pose.turn, turn([1, 0, 0], 90));
  near(one.pose.place, [0, 0, 0]);
});

test("a control that keeps the axes of its frame moves along them, however the marker is turned", () => {
  const control = { mode: Mode.MOVE_AXIS, facing: 1, wxyz: STILL };
  const pose = { turn: turn([0, 0, 1], 90), place: /** @type {Vector} */ ([0, 0, 0]) };
  const one = new HandleDrag(control, sight, pose, 0, [0.5, 0, 0], over([0.5, 0, 0]));
  one.follow(over([0.8, 0, 0]));
  near(one.pose.place, [0.3, 0, 0]);
});

test("a control that faces the eye points away from it, with its z up", () => {
  const wxyz = after(turn([0, 1, 0], 90), turn([1, 0, 0], 30));
  const made = after(facing(wxyz, sight.axes(), 0), wxyz);
  near(turned(made, [1, 0, 0]), [0, 1, 0]);
  near(turned(made, [0, 0, 1]), [0, 0, 1]);
});

test("a turn is made of any three axes", () => {
  for (const wanted of [STILL, turn([1, 0, 0], 180), turn([0, 1, 0], 180), turn([0, 0, 1], 180)]) {
    const [x, y, z] = [
      turned(wanted, [1, 0, 0]),
      turned(wanted, [0, 1, 0]),
      turned(wanted, [0, 0, 1]),
    ];
    near(turned(turnTo(x, y, z), [1, 2, 3]), turned(wanted, [1, 2, 3]));
  }
});
