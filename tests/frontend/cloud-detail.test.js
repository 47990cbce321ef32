import assert from "node:assert/strict";
import { test } from "node:test";

/** @type {Record<string, string>} */
const dataset = {};
Object.assign(globalThis, { document: { documentElement: { dataset }, hidden: false } });
const { CloudDetail, countBelow, orderOf, partOf, Share } = await import(
  "../../frontend_assets/viser/cloud-detail.js"
);

const MILLION = 1_000_000;

/**
 * Pictures that take long with all points, on top of what the rest of the scene takes.
 * @param {InstanceType<typeof Share>} share @param {{ points: number, all_ms: number, rest_ms?: number, from_ms?: number, lasting_ms: number }} times
 */
function draw(share, { points, all_ms, rest_ms = 5, from_ms = 0, lasting_ms }) {
  for (let now = from_ms; now < from_ms + lasting_ms; now += 100)
    share.took(rest_ms + all_ms * share.value, now, points);
  return share.value;
}

test("of a million points so many are drawn that the picture follows the hand", () => {
  const share = new Share();
  assert.equal(draw(share, { points: MILLION, all_ms: 1600, lasting_ms: 3000 }), 1 / 16);
});

test("one slow picture alone is none", () => {
  const share = new Share();
  for (const took of [10, 900, 10, 900, 10]) assert.equal(share.took(took, 0, MILLION), false);
  assert.equal(share.value, 1);
});

test("points that are not the reason are all drawn, or so many that they could be none", () => {
  assert.equal(draw(new Share(), { points: 50_000, all_ms: 0, rest_ms: 500, lasting_ms: 9000 }), 1);
  const many = draw(new Share(), { points: MILLION, all_ms: 0, rest_ms: 500, lasting_ms: 9000 });
  assert.ok(many * MILLION >= 30_000);
});

test("when there is room again all are drawn, and what proved wrong is tried more seldom", () => {
  const share = new Share();
  draw(share, { points: MILLION, all_ms: 1600, lasting_ms: 3000 });
  assert.equal(draw(share, { points: MILLION, all_ms: 20, from_ms: 3000, lasting_ms: 20_000 }), 1);
  let changes = 0;
  for (let now = 23_000; now < 123_000; now += 100) {
    // Whatever is more than half of them is suddenly slow.
    const took = share.value > 0.5 ? 200 : 10;
    if (share.took(took, now, MILLION)) changes += 1;
  }
  assert.ok(changes >= 2 && changes <= 10, String(changes));
});

test("which points are drawn is spread evenly, and those of a smaller part are among them", () => {
  const [half, quarter] = [orderOf(0.5, MILLION), orderOf(0.25, MILLION)];
  assert.equal(orderOf(0.25, 70_000), quarter);
  const all = new Set(half);
  assert.ok(quarter.every((point) => all.has(point)));
  for (const count of [1000, 70_001, MILLION]) {
    const drawn = countBelow(quarter, count);
    assert.ok(Math.abs(drawn - count / 4) <= 2, `${drawn} of ${count}`);
    assert.ok(drawn === 0 || /** @type {number} */ (quarter[drawn - 1]) < count);
  }
  const gaps = half.slice(1, 5000).map((point, at) => point - /** @type {number} */ (half[at]));
  assert.ok(Math.max(...gaps) <= 3);
});

/** Points along x, one after the other, each in a colour of its own. @param {number} count */
function cloudOf(count) {
  const points = new Float32Array(3 * count);
  const colors = new Uint8Array(3 * count);
  for (let at = 0; at < count; at += 1) {
    points[3 * at] = at;
    colors[3 * at] = at % 256;
  }
  return { points, colors };
}

test("each point of a part keeps its colour, and one colour of all stays one", () => {
  const whole = cloudOf(1000);
  const part = partOf(whole, 0.25);
  const drawn = countBelow(orderOf(0.25, 1000), 1000);
  assert.deepEqual([part.points.length, part.colors.length], [3 * drawn, 3 * drawn]);
  for (let at = 0; at < part.points.length; at += 3)
    assert.equal(part.colors[at], /** @type {number} */ (part.points[at]) % 256);
  const colors = new Uint8Array([1, 2, 3]);
  assert.equal(partOf({ ...whole, colors }, 0.5).colors, colors);
  assert.equal(partOf(whole, 1).points, whole.points);
});

/** A page whose pictures take so long. @param {Record<string, object>} nodes */
function pageOf(nodes) {
  const gl = {
    SYNC_STATUS: 1,
    SIGNALED: 2,
    fenceSync: () => ({}),
    flush: () => undefined,
    deleteSync: () => undefined,
    isContextLost: () => false,
    getSyncParameter: () => 2,
  };
  const hooks = {
    read: (/** @type {object} */ _) => {},
    before: (/** @type {object} */ _) => {},
    after: () => {},
  };
  /** @type {any[]} */
  const injected = [];
  const door = {
    onMessage: (/** @type {any} */ read) => Object.assign(hooks, { read }),
    onPicture: (/** @type {any} */ before, /** @type {any} */ after) =>
      Object.assign(hooks, { before, after }),
    node: (/** @type {string} */ name) => nodes[name],
    inject: (/** @type {any[]} */ ...messages) => injected.push(...messages),
  };
  return { door: /** @type {any} */ (door), hooks, renderer: { getContext: () => gl }, injected };
}

test("a slow page draws a part of each cloud and says so, and all again once it can", async (context) => {
  let now = 0;
  context.mock.method(performance, "now", () => now);
  const [large, small] = [cloudOf(MILLION), cloudOf(1000)];
  const seen = { visible: true, parent: null };
  const { door, hooks, renderer, injected } = pageOf({ "/live/1/a": seen, "/live/2/a": seen });
  /** @type {number[]} */
  const told = [];
  new CloudDetail(door, (oneIn) => told.push(oneIn));
  hooks.read({ type: "PointCloudMessage", name: "/live/1/a", props: large });
  hooks.read({ type: "PointCloudMessage", name: "/live/2/a", props: small });
  const picture = async (/** @type {number} */ took) => {
    hooks.before(renderer);
    hooks.after();
    now += took;
    await new Promise((done) => setTimeout(done, 10));
  };
  for (let count = 0; count < 5; count += 1) await picture(400);
  assert.deepEqual(told, [2, 4]);
  const drawn = injected.slice(-2).map(({ name, updates }) => [name, updates.points]);
  assert.deepEqual(drawn, [
    ["/live/1/a", partOf(large, 1 / 4).points],
    ["/live/2/a", partOf(small, 1 / 4).points],
  ]);
  const message = { type: "SceneNodeUpdateMessage", name: "/live/2/a", updates: cloudOf(2000) };
  hooks.read(message);
  assert.deepEqual(message.updates, partOf(cloudOf(2000), 1 / 4));
  const look = { type: "SceneNodeUpdateMessage", name: "/live/2/a", updates: { point_size: 1 } };
  hooks.read(look);
  assert.deepEqual(look.updates, { point_size: 1 });
  hooks.read({ type: "RemoveSceneNodeMessage", name: "/live/2/a" });
  for (let count = 0; count < 12; count += 1) {
    now += 1000;
    await picture(5);
  }
  assert.deepEqual(told, [2, 4, 2, 1]);
  assert.deepEqual(injected.at(-1)?.name, "/live/1/a");
  assert.equal(injected.at(-1)?.updates.points, large.points);
});

test("clouds that are hidden cost nothing, and without clouds nothing is left out", async () => {
  const hidden = { visible: true, parent: { visible: false, parent: null } };
  const { door, hooks, renderer } = pageOf({ "/live/1/a": hidden });
  new CloudDetail(door, () => assert.fail());
  hooks.read({ type: "PointCloudMessage", name: "/live/1/a", props: cloudOf(MILLION) });
  for (let count = 0; count < 5; count += 1) {
    hooks.before(renderer);
    await new Promise((done) => setTimeout(done, 150));
    hooks.after();
  }
});

test("where pictures are compared, all points are drawn", () => {
  dataset.pixels = "fixed";
  const { door, hooks } = pageOf({});
  const before = hooks.before;
  new CloudDetail(door, () => assert.fail());
  assert.equal(hooks.before, before);
  delete dataset.pixels;
});
