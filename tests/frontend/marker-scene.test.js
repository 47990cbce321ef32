import assert from "node:assert/strict";
import { test } from "node:test";
import { MarkerScene } from "../../frontend_assets/viser/marker-scene.js";

/** As much of three.js's as a ray without perspective needs: it looks down from 1000 m. */
class Vector {
  x = 0;
  y = 0;
  z = 0;
  clone = () => new Vector().set(this.x, this.y, this.z);
  normalize = () => this;
  setFromMatrixColumn = () => this.set(0, 0, 1);
  unproject = () => this.set(this.x, this.y, 1000);

  /** @param {number} x @param {number} y @param {number} z */
  set(x, y, z) {
    return Object.assign(this, { x, y, z });
  }

  /** @param {number} by */
  multiplyScalar(by) {
    return this.set(this.x * by, this.y * by, this.z * by);
  }

  /** @param {Vector} way @param {number} by */
  addScaledVector(way, by) {
    return this.set(this.x + way.x * by, this.y + way.y * by, this.z + way.z * by);
  }

  /** @param {Vector} other */
  distanceTo({ x, y, z }) {
    return Math.hypot(this.x - x, this.y - y, this.z - z);
  }
}

const ROOT = "/live/d1/m0";
const MARKER = {
  ...{ number: 0, name: "box", description: "", scale: 1, menu: [] },
  controls: [{ number: 0, mode: 7, facing: 0, wxyz: [1, 0, 0, 0], independent: false }],
};

/** With one control, a mesh of many bodies, whose hits are in its own axes.
 * @param {readonly {distance: number, point: Vector}[]} hits */
function sceneWith(hits) {
  /** @type {(message: object) => void} */
  let tell = () => undefined;
  const mesh = {
    geometry: { boundingBox: {} },
    raycast: (/** @type {unknown} */ _, /** @type {unknown[]} */ found) => found.push(...hits),
  };
  const door = {
    mutable: {
      canvas: { getBoundingClientRect: () => ({ left: 0, top: 0, width: 200, height: 200 }) },
      camera: {
        position: new Vector(),
        projectionMatrix: { elements: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1] },
      },
    },
    node: () => ({ traverseVisible: (/** @type {(one: object) => void} */ visit) => visit(mesh) }),
    onMessage: (/** @type {typeof tell} */ heard) => {
      tell = heard;
    },
    onPicture: () => undefined,
    redraw: () => undefined,
  };
  const scene = new MarkerScene(/** @type {any} */ (door), () => null);
  scene.set(/** @type {any} */ ([{ display: "d1", visual_aids: true, markers: [MARKER] }]));
  tell({ type: "BatchedMeshesMessage", name: `${ROOT}-c0/c0-box.many`, props: {} });
  return scene;
}

test("where a control of many bodies is met is said in the scene, without perspective too", () => {
  const inItsAxes = new Vector().set(0.1, 0, 0.2);
  const scene = sceneWith([
    { distance: 998.5, point: new Vector() },
    { distance: 998, point: inItsAxes },
  ]);
  const { point, distance } =
    /** @type {import("../../frontend_assets/viser/marker-scene.js").Handle} */ (
      scene.pick(150, 100)
    );
  assert.deepEqual([point.x, point.y, point.z, distance], [0.5, 0, 2, 998]);
});

test("how far a control was turned is forgotten with its marker", () => {
  const scene = sceneWith([]);
  const control = /** @type {any} */ ({ ...MARKER.controls[0], facing: 2 });
  const known = /** @type {any} */ (scene.known.get(ROOT));
  scene.keep(known, { turn: [1, 0, 0, 0], place: [0, 0, 0] }, control, 0.7);
  assert.equal(scene.radOf(known, control), 0.7);
  scene.set([]);
  assert.equal(scene.radOf(known, control), 0);
});
