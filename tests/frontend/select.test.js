import assert from "node:assert/strict";
import { test } from "node:test";
import { Lens, rectOf, touches } from "../../frontend_assets/viser/lens.js";
import { groupName, meshName, namesIn } from "../../frontend_assets/viser/live-nodes.js";
import {
  axesEnds,
  isBetter,
  lineAt,
  linesIn,
  meshAlong,
  pointAt,
  pointsIn,
  solidAt,
  solidsIn,
} from "../../frontend_assets/viser/live-picking.js";
import { gathered, keptOf, sharesOf, spread } from "../../frontend_assets/viser/tools/select.js";

/** A window of 200 by 100 px at (10, 20), and a camera 5 m above the origin that looks down the z axis. */
const FRAME = { left: 10, top: 20, width: 200, height: 100 };
const VIEW = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -5, 1];
/** 90 degrees high; at 5 m a metre is 10 px. */
const perspective = () =>
  new Lens([0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 5], VIEW, FRAME, 1);
/** Without perspective: a metre is 10 px everywhere. */
const flat = () => new Lens([0.1, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1], VIEW, FRAME, 0.2);
const MIDDLE = { x: 110, y: 70 };
const BOX = {
  vertices: [
    -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1,
  ].map((part) => part / 2),
  faces: [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 2, 3, 7, 2, 7, 6],
};

/** @param {Iterable<number | null>} rows */
const rowsOf = (rows) => [...rows].filter((row) => row !== null);

test("places are seen by the camera's own matrices, with perspective and without", () => {
  for (const lens of [perspective(), flat()]) {
    assert.ok(lens.at(1, 2, 0));
    assert.deepEqual([lens.x, lens.y, lens.depth_m], [120, 50, 5]);
    assert.equal(lens.perMetre, 10);
  }
  const [near, far] = [perspective(), flat()];
  assert.ok(near.at(1, 0, 4) && far.at(1, 0, 4));
  assert.equal(near.x, 160);
  assert.equal(far.x, 120);
  assert.equal(perspective().at(0, 0, 6), false, "what is behind the eye is not seen");
  assert.equal(flat().at(0, 0, 6), true, "without perspective there is no behind");
});

test("a rectangle touches what it crosses, and not what only its sides would reach", () => {
  const rect = rectOf({ x: 20, y: 20 }, { x: 10, y: 10 });
  assert.deepEqual(rect, { left: 10, top: 10, right: 20, bottom: 20 });
  assert.ok(touches(rect, [0, 0, 30, 30], [30, 30]), "a line through it");
  assert.ok(touches(rect, [0, 22, 22, 0], [22, -22]), "across its corner");
  assert.ok(!touches(rect, [0, 18, 18, 0], [18, -18]), "a line past its corner");
  assert.ok(touches(rect, [-90, -90, 90, -90, 0, 120], [180, 0, -90, 210, -90, -210]), "around it");
});

test("of points the nearest to the eye that is met counts, else the nearest to the mouse", () => {
  const points = new Float32Array([0, 0, 0, 0, 0, 1, 1, 0, 0]);
  const met = pointAt(perspective(), { points, point_size: 0.1 }, null, MIDDLE, 6);
  assert.deepEqual([met?.row, met?.miss_px], [1, 0]);
  const beside = pointAt(perspective(), { points, point_size: 0.1 }, null, { x: 125, y: 70 }, 6);
  assert.equal(beside?.row, 2);
  assert.ok((beside?.miss_px ?? 0) > 0);
  assert.equal(
    pointAt(perspective(), { points, point_size: 0.1 }, null, { x: 150, y: 70 }, 6),
    null,
  );
});

test("points that grow with their z are met as large as they are", () => {
  const cloud = { points: new Float32Array([0, 0, 2]), point_size: 0.3 };
  const beside = { x: 118, y: 70 };
  assert.notEqual(pointAt(perspective(), cloud, null, beside, 6)?.miss_px, 0);
  const growing = { ...cloud, studio_size_by_z: true };
  assert.equal(pointAt(perspective(), growing, null, beside, 6)?.miss_px, 0);
});

test("of a cloud that is drawn in part the row is that of the whole, in half precision, too", () => {
  const points = new Uint16Array([0x3c00, 0, 0, 0, 0, 0]);
  const drawn = new Uint32Array([3, 8]);
  assert.equal(pointAt(perspective(), { points, point_size: 0.1 }, drawn, MIDDLE, 6)?.row, 8);
  assert.equal(
    pointAt(perspective(), { points, point_size: 0.1 }, drawn, { x: 120, y: 70 }, 6)?.row,
    3,
  );
});

test("what is met goes before what is missed, and the nearer before the farther", () => {
  const met = (/** @type {number} */ miss_px, /** @type {number} */ depth_m) => ({
    ...{ row: 0, miss_px, depth_m, place: null },
  });
  assert.ok(isBetter(met(0, 9), met(1, 1)));
  assert.ok(!isBetter(met(1, 1), met(0, 9)));
  assert.ok(isBetter(met(0, 1), met(0, 2)));
  assert.ok(isBetter(met(1, 9), met(2, 1)));
});

test("lines are met along their whole way, and axes by each of three", () => {
  const points = new Float32Array([-2, 1, 0, -2, -1, 0, -2, 0, 0, 2, 0, 0]);
  assert.equal(
    lineAt(perspective(), { points, thickness: 1.8, thickness_units: "screen" }, MIDDLE, 6)?.row,
    1,
  );
  const ends = axesEnds({
    batched_positions: [1, 0, 0],
    batched_wxyzs: [Math.SQRT1_2, 0, 0, Math.SQRT1_2],
    axes_length: 2,
  });
  const round = [...ends].map((part) => Math.round(part * 1e6) / 1e6 + 0);
  assert.deepEqual(round, [1, 0, 0, 1, 2, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 2]);
});

test("of many solids that one is met whose triangles are, however it is turned and stretched", () => {
  const props = {
    ...BOX,
    batched_positions: [0, 0, 0, 0, 0, 2, 3, 0, 0],
    batched_wxyzs: [1, 0, 0, 0, 1, 0, 0, 0, Math.SQRT1_2, 0, 0, Math.SQRT1_2],
    batched_scales: [1, 1, 1, 0.1, 0.1, 0.1, 4, 0.2, 0.2],
  };
  const down = (/** @type {number} */ x, /** @type {number} */ y) =>
    solidAt(perspective(), props, { origin: [x, y, 5], direction: [0, 0, -1] });
  assert.deepEqual([down(0, 0)?.row, down(0, 0)?.depth_m], [1, 2.95]);
  assert.equal(down(0.3, 0)?.row, 0);
  assert.equal(down(3, 1.9)?.row, 2, "it is long along y");
  assert.equal(down(3.5, 0), null);
  assert.equal(
    meshAlong({ origin: [0, 0, 5], direction: [0, 0, 1] }, BOX.vertices, BOX.faces),
    null,
  );
});

test("a rectangle has all points, lines and solids that it touches, behind each other too", () => {
  const rect = { left: 100, top: 60, right: 121, bottom: 80 };
  const points = new Float32Array([0, 0, 0, 0, 0, -9, 1, 0, 0, 2, 0, 0, 0, 0, 9]);
  assert.deepEqual(rowsOf(pointsIn(perspective(), points, rect)), [0, 1, 2]);
  const lines = new Float32Array([-9, 0, 0, 9, 0, 0, 3, 3, 0, 4, 4, 0]);
  assert.deepEqual(rowsOf(linesIn(perspective(), lines, rect, 1)), [0]);
  assert.deepEqual(rowsOf(linesIn(perspective(), lines, rect, 2)), [0]);
  const props = {
    ...BOX,
    batched_positions: [1.5, 0, 0, 3, 0, 0],
    batched_wxyzs: [1, 0, 0, 0, 1, 0, 0, 0],
  };
  assert.deepEqual(rowsOf(solidsIn(perspective(), { ...props, batched_scales: null }, rect)), [0]);
});

test("others have their turn often while a million points are looked at", async () => {
  const points = new Uint16Array(3_000_000).map((_, at) => 0x3000 + ((at * 2_654_435) % 0x0c00));
  const all = { left: -1e6, top: -1e6, right: 1e6, bottom: 1e6 };
  let looked = 0;
  let most = 0;
  for (const row of pointsIn(perspective(), points, all)) {
    looked = row === null ? 0 : looked + 1;
    most = Math.max(most, looked);
  }
  assert.ok(most < 20_000, `${most} points`);
  let asked = 0;
  let waited = 0;
  const pause = () => {
    asked += 1;
    if (asked % 2) return null;
    return Promise.resolve().then(() => {
      waited += 1;
    });
  };
  const rows = await gathered(pointsIn(perspective(), points, all), pause);
  assert.equal(rows.length, 1_000_000);
  assert.equal(waited, Math.floor(asked / 2));
  assert.ok(waited > 25);
});

test("of too many those of few stay, and the others are spread evenly", () => {
  assert.deepEqual(
    sharesOf(
      [
        ["a", 10],
        ["b", 5000],
        ["b", 5000],
      ],
      1000,
    ),
    [10, 495, 495],
  );
  assert.deepEqual(
    sharesOf(
      [
        ["a", 10],
        ["b", 20],
      ],
      1000,
    ),
    [10, 20],
  );
  assert.deepEqual(spread([0, 1, 2, 3, 4, 5], 3), [0, 2, 4]);
});

test("nodes that a rectangle does not touch take no place, and what is left out is counted", () => {
  const found = ["a", "a", "b"].map((display) => ({ node: { display }, rows: [0, 1] }));
  assert.deepEqual(keptOf(found, 3, 100), { kept: found, left_out: 0 });
  assert.deepEqual(keptOf(found, 2, 100), { kept: found.slice(0, 2), left_out: 2 });
  const { kept, left_out } = keptOf(found, 3, 4);
  assert.deepEqual(
    kept.map(({ rows }) => rows),
    [[0], [0], [0, 1]],
  );
  assert.equal(left_out, 2);
});

test("names of nodes lead to displays, paths and shapes, whatever signs are in them", () => {
  const path = "names/a b#1";
  const name = `${groupName("d1", path)}/${encodeURIComponent("boxes.1.many")}`;
  assert.deepEqual(namesIn(name), { display: "d1", path, shape: "boxes.1", node: "many" });
  assert.deepEqual(namesIn("/live/d1/%/points.points")?.path, "");
  for (const other of ["/live/d1", "/live/d1/0", "/robot/base", "/live/d1/0/x", "/live/a/b/c.d/e"])
    assert.equal(namesIn(other), null);
  assert.equal(meshName("/live/d1/g0", "rest-mesh-3"), "/live/d1/g0/rest-mesh-3.mesh");
});
