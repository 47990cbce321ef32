import assert from "node:assert/strict";
import { test } from "node:test";
import { Plates } from "../../frontend_assets/viser/theme.js";

/** @param {string} colour */
const material = (colour) => ({
  isShaderMaterial: true,
  vertexShader: "float depth = -(viewMatrix * vec4(labelPos, 1.0)).z;",
  fragmentShader: `void main() { gl_FragColor = ${colour}; }`,
  uniforms: /** @type {Record<string, { value: unknown }>} */ ({}),
  needsUpdate: false,
});

/** A scene with one group of labels, and what Plates hangs on. @param {object[]} children */
function sceneOf(children) {
  const group = { renderOrder: 0, parent: {}, children };
  const hooks = {
    read: (/** @type {object} */ _message) => undefined,
    draw: () => undefined,
  };
  const door = {
    onMessage: (/** @type {typeof hooks.read} */ read) => {
      hooks.read = read;
    },
    onPicture: (/** @type {typeof hooks.draw} */ draw) => {
      hooks.draw = draw;
    },
    mutable: {
      scene: {
        traverse: (/** @type {(one: object) => void} */ visit) => {
          for (const one of children) visit({ ...one, parent: group });
        },
      },
    },
  };
  return { door: /** @type {any} */ (door), hooks };
}

test("plates and letters have the colours of the theme, also letters that came later", () => {
  const plate = material("vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)");
  const letters = material("vec4(0.0, 0.0, 0.0, a)");
  /** @type {object[]} */
  const children = [{ renderOrder: 10_001, material: plate }];
  const { door, hooks } = sceneOf(children);
  const plates = new Plates(door);
  plates.set("dark");
  hooks.draw();
  assert.equal(plate.needsUpdate, false); // nothing to be read yet
  hooks.read({ type: "LabelMessage" });
  hooks.draw();
  assert.match(plate.fragmentShader, /vec4\(studioPlate, 0.85 \* vAlpha\)/);
  assert.match(plate.vertexShader, /projectionMatrix \* viewMatrix .+\.w;/); // without perspective, too
  children.push({ renderOrder: 10_002, material: letters });
  hooks.draw();
  assert.match(letters.fragmentShader, /vec4\(studioInk, a\)/);
  const shown = () => [plate.uniforms.studioPlate?.value, letters.uniforms.studioInk?.value];
  const dark = shown();
  plates.set("light");
  assert.deepEqual(shown(), [
    [1, 1, 1],
    [0, 0, 0],
  ]);
  assert.notDeepEqual(dark, shown());
  const before = plate.fragmentShader;
  hooks.draw();
  assert.equal(plate.fragmentShader, before);
});
