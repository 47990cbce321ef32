/** The Camera panel, and the projection of its view beside a pinhole written out by hand. */

import assert from "node:assert/strict";
import { test } from "node:test";
import { sizeFor } from "../../frontend_assets/panels/cameraview/cameraview.js";
import {
  CameraPictures,
  depthsOf,
  placeOfPicture,
  projectionOf,
} from "../../frontend_assets/viser/camera-pictures.js";

const PICTURE = { width: 640, height: 480 };
/** fx 500, fy 520, cx 300, cy 260 of that picture. */
const LENS = /** @type {const} */ ([500 / 640, 520 / 480, 300 / 640, 260 / 480, 0, 0]);

/** @param {object} [more] @returns {any} */
const viewWith = (more) => ({
  lens: LENS,
  rendering: "background and overlay",
  overlay_alpha: 0.5,
  zoom: 1,
  near_m: 0.01,
  far_m: 100,
  hidden: [],
  ...more,
});

/** Where the projection puts a place of the camera (z forward, y down) on the canvas, px.
 * @param {any} view @param {{width: number, height: number}} canvas @param {readonly [number, number, number]} place */
function pixelOf(view, canvas, [x, y, z]) {
  const [m0, m5, m8, m9] = projectionOf(view, PICTURE, canvas);
  const [gx, gy, gz] = [x, -y, -z];
  const [clipX, clipY, clipW] = [m0 * gx + m8 * gz, m5 * gy + m9 * gz, -gz];
  return [((clipX / clipW + 1) / 2) * canvas.width, ((1 - clipY / clipW) / 2) * canvas.height];
}

/** Where the pixel of the picture, which a pinhole puts the place at, lies on the canvas.
 * @param {any} view @param {{width: number, height: number}} canvas @param {readonly [number, number, number]} place */
function byHand(view, canvas, [x, y, z]) {
  const [u, v] = [(500 * x) / z + 300, (520 * y) / z + 260];
  const at = placeOfPicture(view, PICTURE, canvas);
  return [at.x + (u / 640) * at.width, at.y + (v / 480) * at.height];
}

for (const [name, canvas] of Object.entries({
  wide: { width: 1200, height: 400 },
  tall: { width: 300, height: 900 },
  same: PICTURE,
}))
  for (const zoom of [0.5, 1, 3])
    test(`on a ${name} canvas at zoom ${zoom} the scene lies on its pixels`, () => {
      const view = viewWith({ zoom });
      for (const place of /** @type {const} */ ([
        [0, 0, 1],
        [0.5, -0.3, 2],
        [-1, 0.7, 3],
      ])) {
        const [ours, theirs] = [pixelOf(view, canvas, place), byHand(view, canvas, place)];
        for (const axis of [0, 1])
          assert.ok(Math.abs((ours[axis] ?? 0) - (theirs[axis] ?? 0)) < 1e-9, `${ours} ${theirs}`);
      }
    });

test("depths go from near to far, or the other way round where they are reversed", () => {
  /** @param {number} distance @param {boolean} isReversed */
  const depth = (distance, isReversed) => {
    const [scale, shift] = depthsOf(0.5, 100, isReversed);
    return (scale * -distance + shift) / distance;
  };
  assert.ok(Math.abs(depth(0.5, true) - 1) < 1e-9);
  assert.ok(Math.abs(depth(100, true)) < 1e-9);
  assert.ok(Math.abs(depth(0.5, false) + 1) < 1e-9);
  assert.ok(Math.abs(depth(100, false) - 1) < 1e-9);
});

test("pixels that are square in front of the lens are square on the canvas", () => {
  const at = placeOfPicture(viewWith({}), PICTURE, { width: 1000, height: 300 });
  assert.equal(at.height, 300);
  // A step of one to the right is 500 pixels of 640, one down 520 of 480.
  assert.ok(Math.abs((500 / 640) * at.width - (520 / 480) * at.height) < 1e-9);
});

test("without a lens the picture keeps its own proportions", () => {
  const at = placeOfPicture(viewWith({ lens: null }), PICTURE, { width: 1000, height: 240 });
  assert.deepEqual([Math.round(at.x), at.y, Math.round(at.width), at.height], [340, 0, 320, 240]);
});

test("a canvas is as large as the screen has pixels, within bounds", () => {
  assert.deepEqual(sizeFor({ width: 400, height: 300 }, 2), { width: 800, height: 600 });
  assert.deepEqual(sizeFor({ width: 4000, height: 1000 }, 2), { width: 1600, height: 400 });
  assert.deepEqual(sizeFor({ width: 0, height: 0 }, 2), { width: 1, height: 1 });
});

/** A door, and what reads its messages and draws its pictures. */
function doorWith() {
  /** @type {{read: (message: object) => void, draw: (renderer: object) => void, redraws: number}} */
  const hooks = { read: () => undefined, draw: () => undefined, redraws: 0 };
  const door = {
    mutable: null,
    onMessage: (/** @type {any} */ read) => {
      hooks.read = read;
    },
    onPicture: (/** @type {any} */ draw) => {
      hooks.draw = draw;
    },
    redraw: () => {
      hooks.redraws += 1;
    },
    node: () => undefined,
  };
  return {
    cameras: new CameraPictures(/** @type {any} */ (door), { faceEye: () => () => undefined }),
    hooks,
  };
}

/** A canvas that counts how often it is emptied. */
function canvasOf() {
  const counted = { cleared: 0 };
  const paint = { clearRect: () => (counted.cleared += 1) };
  return {
    canvas: /** @type {any} */ ({ width: 10, height: 10, getContext: () => paint }),
    counted,
  };
}

test("the picture of a camera is taken out of its message, so that viser makes no texture of it", () => {
  const { hooks } = doorWith();
  const props = { studio_camera: viewWith({}), _image_data: new Uint8Array(4) };
  hooks.read({ type: "CameraFrustumMessage", name: "/live/d1/camera/view.camera", props });
  assert.equal(props._image_data, null);
});

test("a view is drawn when a message came, and not when only the eye of the person moved", (context) => {
  let now_ms = 1000;
  context.mock.method(performance, "now", () => now_ms);
  const tick = (/** @type {number} */ by_ms) => {
    now_ms += by_ms;
  };
  const { cameras, hooks } = doorWith();
  const { canvas, counted } = canvasOf();
  hooks.draw({});
  const sight = cameras.show({ display: "d1", canvas, told: () => undefined });
  hooks.draw({});
  assert.equal(counted.cleared, 1);
  hooks.draw({});
  assert.equal(counted.cleared, 1);
  tick(600);
  hooks.read({ type: "SetPositionMessage", name: "/robot/arm" });
  hooks.draw({});
  assert.equal(counted.cleared, 2);
  tick(100);
  hooks.draw({});
  assert.equal(counted.cleared, 3, "what React makes of a message comes a picture later");
  tick(600);
  hooks.draw({});
  assert.equal(counted.cleared, 3);
  sight.leave();
  hooks.read({ type: "SetPositionMessage", name: "/robot/arm" });
  hooks.draw({});
  assert.equal(counted.cleared, 3);
});
