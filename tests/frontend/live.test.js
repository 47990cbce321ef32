import assert from "node:assert/strict";
import { test } from "node:test";
import { edgeOf, isPlain, Live, lookOf } from "../../frontend_assets/viser/live.js";

/** A door with one node, and what Live asked of it. @param {Record<string, object>} nodes */
function doorOf(nodes) {
  /** @type {{ read: (message: object) => void, draw: () => void }} */
  const hooks = { read: () => undefined, draw: () => undefined };
  const door = {
    mutable: null,
    onMessage: (/** @type {(message: object) => void} */ read) => {
      hooks.read = read;
    },
    onPicture: (/** @type {() => void} */ draw) => {
      hooks.draw = draw;
    },
    node: (/** @type {string} */ name) => nodes[name],
    inject: () => undefined,
  };
  return { door: /** @type {any} */ (door), hooks };
}

/** A material as viser makes them. @param {object} [more] */
function material(more) {
  return { opacity: 1, transparent: false, depthWrite: true, needsUpdate: false, ...more };
}

/** A node with one object of that material. @param {object} object */
const nodeOf = (object) => ({
  traverse: (/** @type {(one: object) => void} */ visit) => visit(object),
});

test("what nobody asked for is left as viser makes it", () => {
  assert.ok(isPlain(lookOf("ArrowMessage", { studio_opacity: 1 })));
  assert.ok(isPlain(lookOf("LabelMessage", { studio_rgb: null, font_size_mode: "screen" })));
  assert.equal(isPlain(lookOf("ImageMessage", { studio_sharp: true })), false);
});

test("an opacity is held between nothing and all, and a word is one or the other size", () => {
  assert.equal(lookOf("", { studio_opacity: 7 }).opacity, 1);
  assert.equal(lookOf("", { studio_opacity: -1 }).opacity, 0);
  assert.equal(lookOf("", { studio_opacity: "much" }).opacity, 1);
  assert.equal(lookOf("", { studio_rgb: [1, 2, 3], font_size_mode: "scene" }).words, "scene");
});

test("a fading that ends leaves the material as it was", () => {
  const steel = material();
  const { door, hooks } = doorOf({ "/live/1/a/b": nodeOf({ material: steel, visible: true }) });
  new Live(door);
  const message = { type: "ArrowMessage", name: "/live/1/a/b", props: { studio_opacity: 0.5 } };
  hooks.read(message);
  hooks.draw();
  assert.deepEqual([steel.opacity, steel.transparent, steel.depthWrite], [0.5, true, false]);
  hooks.read({
    type: "SceneNodeUpdateMessage",
    name: "/live/1/a/b",
    updates: { studio_opacity: 1 },
  });
  hooks.draw();
  assert.deepEqual([steel.opacity, steel.transparent, steel.depthWrite], [1, false, true]);
});

test("of a see-through line only the soft one of its two drawings is left", () => {
  const hard = {
    isMesh: true,
    visible: true,
    material: material({ isLineMaterial: true, worldUnits: true }),
  };
  const { door, hooks } = doorOf({ "/live/1/a/b": nodeOf(hard) });
  new Live(door);
  hooks.read({ type: "LineSegmentsMessage", name: "/live/1/a/b", props: { studio_opacity: 0.5 } });
  hooks.draw();
  assert.equal(hard.visible, false);
});

test("nodes of the robot and nodes that went are nobody's business", () => {
  const steel = material();
  const { door, hooks } = doorOf({
    "/robot/a": nodeOf({ material: steel }),
    "/live/1/a/b": nodeOf({ material: steel }),
  });
  new Live(door);
  hooks.read({ type: "ArrowMessage", name: "/robot/a", props: { studio_opacity: 0.5 } });
  hooks.read({ type: "ArrowMessage", name: "/live/1/a/b", props: { studio_opacity: 0.5 } });
  hooks.read({ type: "RemoveSceneNodeMessage", name: "/live/1/a/b" });
  hooks.draw();
  assert.equal(steel.opacity, 1);
});

test("points of a size in metres are three pixels wide at least, on a fine screen too", () => {
  const points = material({
    uniforms: {},
    fragmentShader: "gl_FragColor = vec4(col, 1.0);",
    vertexShader: "gl_PointSize = (scale / -world_pos.z);",
  });
  const { door, hooks } = doorOf({
    "/live/1/scan/a.points": nodeOf({ isPoints: true, material: points }),
  });
  door.mutable = { canvas: { clientWidth: 100, width: 200 } };
  new Live(door);
  hooks.read({ type: "PointCloudMessage", name: "/live/1/scan/a.points", props: {} });
  hooks.draw();
  const { uniforms, vertexShader } = /** @type {any} */ (points);
  assert.match(vertexShader, /max\(scale \* .* \/ gl_Position\.w, studioLeastPixels\)/);
  assert.deepEqual([uniforms.studioPixels.value, uniforms.studioLeastPixels.value], [0, 6]);
});

test("bright words have a dark edge and dark ones a bright edge", () => {
  assert.match(edgeOf([255, 255, 0]), /^rgb\(0 0 0/);
  assert.match(edgeOf([0, 0, 160]), /^rgb\(255 255 255/);
});
