/** @import { Paper } from "../../frontend_assets/panels/turtlesim/drawing.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  FIELD_M,
  hexOf,
  pixelOf,
  placeAt,
  turtleAt,
} from "../../frontend_assets/panels/turtlesim/drawing.js";
import {
  BACKGROUND,
  bytesOf,
  colorOf,
  FIRST_PEN,
  groundsOf,
  penOf,
  serviceNamed,
  Trail,
  World,
} from "../../frontend_assets/panels/turtlesim/world.js";

const INK = FIRST_PEN.color;
const STEP_S = 0.016;

/** @param {string} name @param {string} type @param {number} publishers */
const topic = (name, type, publishers = 1) => ({
  ...{ name, types: [type], publishers, subscribers: 1, kind: "" },
});
/** @param {string} name @param {string} type @param {string} node */
const service = (name, type, node) => ({ name, types: [type], nodes: [node] });

const TOPICS = [
  topic("/turtle1/pose", "turtlesim/msg/Pose"),
  topic("/turtle1/color_sensor", "turtlesim/msg/Color"),
  topic("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", 0),
  topic("/left/turtle1/pose", "turtlesim_msgs/msg/Pose"),
  topic("/robot/pose", "geometry_msgs/msg/Pose"),
  topic("/gone/pose", "turtlesim/msg/Pose", 0),
];
const SERVICES = [
  service("/spawn", "turtlesim/srv/Spawn", "/turtlesim"),
  service("/left/spawn", "turtlesim_msgs/srv/Spawn", "/left/turtlesim"),
];

test("each namespace is a ground of its own, with the turtles that tell where they are", () => {
  const [here, left, ...others] = groundsOf(TOPICS, SERVICES);
  assert.deepEqual(others, []);
  assert.deepEqual(here, {
    ...{ prefix: "", node: "/turtlesim" },
    turtles: [
      {
        ...{ name: "turtle1", path: "/turtle1", pose: "/turtle1/pose" },
        ...{ color: "/turtle1/color_sensor", drive: { name: "/turtle1/cmd_vel", stamped: false } },
      },
    ],
  });
  assert.equal(left?.node, "/left/turtlesim");
  assert.deepEqual(
    left?.turtles.map(({ path, color, drive }) => ({ path, color, drive })),
    [{ path: "/left/turtle1", color: "", drive: null }],
  );
});

test("a ground without turtles is there as long as its services are, and one turtle needs no services", () => {
  assert.deepEqual(groundsOf([], SERVICES)[0]?.turtles, []);
  assert.equal(groundsOf(TOPICS.slice(0, 1), [])[0]?.node, "");
  assert.deepEqual(groundsOf([], []), []);
});

test("of more turtles than a page can hear the first are taken", () => {
  const many = Array.from({ length: 500 }, (_, n) => topic(`/t${n}/pose`, "turtlesim/msg/Pose"));
  assert.equal(groundsOf(many, [])[0]?.turtles.length, 60);
});

test("turtles are listed as they are counted", () => {
  const names = [10, 9, 1].map((n) => topic(`/turtle${n}/pose`, "turtlesim/msg/Pose"));
  const listed = groundsOf(names, [])[0]?.turtles.map(({ name }) => name);
  assert.deepEqual(listed, ["turtle1", "turtle9", "turtle10"]);
});

test("a service is called with the type that it has", () => {
  assert.equal(serviceNamed(SERVICES, "/left/spawn")?.type, "turtlesim_msgs/srv/Spawn");
  assert.equal(serviceNamed(SERVICES, "/right/spawn"), null);
});

test("a pen is read from the request that set it, however that was written", () => {
  const pen = { color: colorOf(255, 0, 16), width: 5, isDown: true };
  assert.deepEqual(penOf("{r: 255, g: 0, b: 16, width: 5, off: 0}"), pen);
  assert.deepEqual(penOf("r: 255\nb: 16\nwidth: 5\n'off': 1\n"), { ...pen, isDown: false });
  assert.deepEqual(penOf(JSON.stringify({ r: 255, b: 16, width: 5 })), pen);
});

test("colours become what a page writes, and bytes again", () => {
  assert.equal(hexOf(colorOf(1, 2, 3)), "#010203");
  assert.deepEqual(bytesOf("#4556ff"), [69, 86, 255]);
});

test("a place has its pixel, y upwards, and what is off the field is its edge", () => {
  assert.deepEqual(pixelOf({ x: 0, y: FIELD_M }, 500), { x: 0, y: 0 });
  assert.deepEqual(pixelOf({ x: FIELD_M, y: 0 }, 500), { x: 500, y: 500 });
  const { x, y } = placeAt(pixelOf({ x: 2, y: 9 }, 333), 333);
  assert.ok(Math.abs(x - 2) < 1e-9 && Math.abs(y - 9) < 1e-9);
  assert.deepEqual(placeAt({ x: -40, y: 9999 }, 333), { x: 0, y: 0 });
});

test("a click finds the nearest turtle in reach", () => {
  const turtles = [
    { name: "a", x: 1, y: 1 },
    { name: "b", x: 1.4, y: 1 },
  ];
  assert.equal(turtleAt(turtles, { x: 1.3, y: 1 })?.name, "b");
  assert.equal(turtleAt(turtles, { x: 3, y: 1 }), null);
});

/** A turtle that walks one metre a second along x, with what its ground looks like at each step. @param {Trail} trail @param {readonly number[]} colors @param {number} from_s @param {(n: number) => number} x */
function walk(trail, colors, from_s, x) {
  const times = colors.map((_, n) => from_s + n * STEP_S);
  trail.addPoses(
    times,
    colors.map((_, n) => x(n)),
    colors.map(() => 0),
  );
  trail.addColors(times, colors);
}

/** @param {Trail} trail */
const taken = (trail) => trail.take((color) => color === BACKGROUND, INK);
const of = (/** @type {number} */ count, /** @type {number} */ color) =>
  Array.from({ length: count }, () => color);

test("a turtle that draws leaves one line, stroke by stroke, in the colour of its pen", () => {
  const trail = new Trail();
  walk(trail, of(50, INK), 10, (n) => n * STEP_S);
  const { strokes } = taken(trail);
  assert.ok(strokes.length > 35, String(strokes.length));
  strokes.slice(1).forEach(({ from, color }, n) => {
    assert.equal(from, strokes[n]?.to);
    assert.equal(color, INK);
  });
});

test("over bare ground no line is drawn, and what comes piece by piece is the same as all at once", () => {
  const trail = new Trail();
  walk(trail, of(50, BACKGROUND), 10, (n) => n * STEP_S);
  assert.deepEqual(taken(trail).strokes, []);
  const pieces = new Trail();
  const whole = new Trail();
  walk(whole, of(60, INK), 10, (n) => n * STEP_S);
  const found = [];
  for (let at = 0; at < 60; at += 4) {
    walk(pieces, of(4, INK), 10 + at * STEP_S, (n) => (at + n) * STEP_S);
    found.push(...taken(pieces).strokes);
  }
  const places = (/** @type {any[]} */ strokes) => strokes.map(({ to }) => to.x.toFixed(3));
  assert.deepEqual(places(found), places(taken(whole).strokes));
});

test("a node that tells the colour before it draws has a line without gaps", () => {
  const trail = new Trail();
  const flickering = Array.from({ length: 60 }, (_, n) => (n % 4 === 0 ? INK : BACKGROUND));
  walk(trail, flickering, 10, (n) => n * STEP_S);
  const { strokes } = taken(trail);
  assert.ok(strokes.length > 8);
  strokes.slice(1).forEach(({ from }, n) => {
    assert.equal(from, strokes[n]?.to);
  });
});

test("a turtle that is put elsewhere draws a line there with its pen, and none without", () => {
  for (const [color, count] of /** @type {const} */ ([
    [INK, 1],
    [BACKGROUND, 0],
  ])) {
    const trail = new Trail();
    walk(trail, [...of(10, BACKGROUND), ...of(30, color)], 10, (n) => (n < 10 ? 1 : 9));
    assert.equal(taken(trail).strokes.length, count);
  }
});

test("what was not heard for a while is no line", () => {
  const trail = new Trail();
  walk(trail, of(20, INK), 10, () => 1);
  walk(trail, of(30, INK), 20, () => 9);
  assert.deepEqual(taken(trail).strokes, []);
});

test("ground that turns bare below a standing turtle was wiped, and a new background is none", () => {
  const trail = new Trail();
  walk(trail, of(60, INK), 10, () => 1);
  assert.equal(taken(trail).wiped, false);
  walk(trail, of(60, BACKGROUND), 10 + 60 * STEP_S, () => 1);
  assert.equal(taken(trail).wiped, true);
  const other = new Trail();
  walk(other, of(60, INK), 10, () => 1);
  taken(other);
  other.forgetGround();
  walk(other, of(60, BACKGROUND), 10 + 60 * STEP_S, () => 1);
  assert.equal(taken(other).wiped, false);
});

test("poses that are no numbers are left out, and what waits for a colour is bounded", () => {
  const trail = new Trail();
  trail.addPoses([1, 2], [Number.NaN, Number.POSITIVE_INFINITY], [0, 0]);
  assert.equal(trail.poses.length, 0);
  const many = Array.from({ length: 20_000 }, (_, n) => n / 1e6);
  trail.addPoses(many, many, many);
  trail.addColors(many, many);
  assert.ok(trail.poses.length <= 4000 && trail.colors.length <= 4000);
});

class DrawnOn {
  /** @type {number[]} */
  widths = [];
  wiped = 0;

  /** @param {readonly unknown[]} _strokes @param {number} width */
  draw(_strokes, width) {
    this.widths.push(width);
  }

  wipe() {
    this.wiped += 1;
  }
}

function world() {
  const paper = new DrawnOn();
  const made = new World(/** @type {Paper} */ (/** @type {unknown} */ (paper)));
  made.keepOnly(["turtle1"]);
  return { made, paper };
}

/** @param {World} made @param {number} count @param {number} color */
function wander(made, count, color) {
  const times = Float64Array.from({ length: count }, (_, n) => n * STEP_S);
  const zeros = new Float64Array(count);
  made.addPoses("turtle1", times, [times, zeros, zeros, zeros, zeros]);
  const [red, green, blue] = bytesOf(hexOf(color)).map((one) => new Float64Array(count).fill(one));
  made.addColors(
    "turtle1",
    times,
    [red, green, blue].map((one) => one ?? zeros),
  );
}

test("lines are as wide as the pen that was set, and a lifted one draws none", () => {
  const { made, paper } = world();
  made.setPen("turtle1", { color: INK, width: 8, isDown: true });
  wander(made, 30, INK);
  assert.equal(made.settle(), true);
  assert.deepEqual(paper.widths, [8]);
  const lifted = world();
  lifted.made.setPen("turtle1", { color: INK, width: 8, isDown: false });
  wander(lifted.made, 30, INK);
  lifted.made.settle();
  assert.deepEqual(lifted.paper.widths, []);
});

test("ground that reads white is bare as well, for some tell that of what nobody drew on", () => {
  const { made, paper } = world();
  wander(made, 30, colorOf(255, 255, 255));
  made.settle();
  assert.deepEqual(paper.widths, []);
});

test("a turtle that stands still asks for no drawing", () => {
  const { made } = world();
  wander(made, 30, BACKGROUND);
  made.settle();
  assert.equal(made.settle(), false);
  made.setBackground(BACKGROUND);
  assert.equal(made.settle(), false);
  made.setBackground(0);
  assert.equal(made.settle(), true);
});

test("a turtle that is gone takes its pen along, and a reset gives all the first one", () => {
  const { made, paper } = world();
  made.setPen("turtle1", { color: 0, width: 9, isDown: true });
  made.reset();
  assert.equal(made.turtles.get("turtle1")?.pen, FIRST_PEN);
  assert.equal(paper.wiped, 1);
  made.setPen("turtle1", { color: 0, width: 9, isDown: true });
  made.keepOnly([]);
  made.keepOnly(["turtle1"]);
  assert.equal(made.turtles.get("turtle1")?.pen, FIRST_PEN);
});
