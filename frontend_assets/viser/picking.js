/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Hit, Object3D, Pointing, Vector3 } from "./viser.d.ts" */

/** @typedef {{ link: string, point: Vector3 }} Pick */

/** The ray through a place of the window: from the eye, or with all others parallel where there is no
 * perspective, from behind all that is drawn. @param {Door} door @param {number} x @param {number} y */
export function rayThrough(door, x, y) {
  const { canvas, camera } = door.mutable ?? {};
  if (!canvas || !camera) return null;
  const frame = canvas.getBoundingClientRect();
  const right = ((x - frame.left) / frame.width) * 2 - 1;
  const up = 1 - ((y - frame.top) / frame.height) * 2;
  const e = camera.projectionMatrix.elements;
  if (e[11] === 0) {
    const nearest = (e[10] ?? 0) > 0 ? 1 : -1; // reversed, or as usual
    const origin = camera.position.clone().set(right, up, nearest).unproject(camera);
    const direction = origin.clone().setFromMatrixColumn(camera.matrixWorld, 2).multiplyScalar(-1);
    return { origin, direction: direction.normalize() };
  }
  const origin = camera.position.clone().setFromMatrixPosition(camera.matrixWorld);
  // Depth is reversed in viser's renderer; any depth between the planes gives the same ray.
  const direction = camera.position.clone().set(right, up, 0.5).unproject(camera);
  return { origin, direction: direction.sub(origin).normalize() };
}

/** The link under a place of the window, or null. @param {Door} door @param {RobotView} robot
 * @param {number} x @param {number} y @returns {Pick | null} */
export function pick(door, robot, x, y) {
  const found = nearestHit(door, robot, x, y);
  return found && { link: found.link, point: found.hit.point };
}

/**
 * The surface under a place of the window: the point, the way it faces and the corners of the triangle
 * there, all in the scene. Null: there is none.
 * @param {Door} door @param {RobotView} robot @param {number} x @param {number} y
 * @returns {{ link: string, point: Vector3, normal: Vector3 | null, corners: Vector3[] } | null}
 */
export function pickSurface(door, robot, x, y) {
  const found = nearestHit(door, robot, x, y);
  if (!found) return null;
  const { link, hit } = found;
  return { link, point: hit.point, normal: normalOf(hit), corners: cornersOf(hit) };
}

/** @param {Hit} hit @returns {Vector3 | null} of length 1, in the scene; scaled meshes too */
function normalOf({ face, object }) {
  if (!face) return null;
  const { x, y, z } = face.normal;
  const e = object.matrixWorld.clone().invert().elements;
  const row = (/** @type {number} */ at) =>
    (e[at] ?? 0) * x + (e[at + 1] ?? 0) * y + (e[at + 2] ?? 0) * z;
  return face.normal.clone().set(row(0), row(4), row(8)).normalize();
}

/** @param {Hit} hit @returns {Vector3[]} */
function cornersOf({ face, object, point }) {
  const places = object.geometry?.attributes?.position;
  if (!face || !places || object.isInstancedMesh) return [];
  return [face.a, face.b, face.c].map((at) =>
    point
      .clone()
      .set(places.getX(at), places.getY(at), places.getZ(at))
      .applyMatrix4(object.matrixWorld),
  );
}

/** The nearest surface of what is shown of an object that a ray meets; null: it meets none.
 * @param {Door} door @param {Object3D} object @param {Pointing["ray"]} ray @returns {Hit | null} */
export function hitOf(door, object, ray) {
  const camera = door.mutable?.camera;
  if (!camera) return null;
  /** @type {Pointing} */
  const pointing = { ray, near: 0, far: Number.POSITIVE_INFINITY, camera, params: {} };
  /** @type {Hit[]} */
  const hits = [];
  object.traverseVisible((one) => {
    if (!one.isMesh || !one.geometry) return;
    if (!one.geometry.boundingBox) one.geometry.computeBoundingBox();
    one.raycast(pointing, hits);
  });
  return hits.sort((one, other) => one.distance - other.distance)[0] ?? null;
}

/** @param {Door} door @param {RobotView} robot @param {number} x @param {number} y @returns {{ link: string, hit: Hit } | null} */
function nearestHit(door, robot, x, y) {
  const ray = rayThrough(door, x, y);
  const camera = door.mutable?.camera;
  if (!ray || !camera) return null;
  /** @type {Pointing} */
  const pointing = { ray, near: 0, far: Number.POSITIVE_INFINITY, camera, params: {} };
  /** @type {{ link: string, hit: Hit } | null} */
  let nearest = null;
  for (const link of robot.drawn) {
    robot.eachMesh(link, (mesh) => {
      /** @type {Hit[]} */
      const hits = [];
      if (mesh.geometry && !mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
      mesh.raycast(pointing, hits);
      for (const hit of hits)
        if (!nearest || hit.distance < nearest.hit.distance) nearest = { link, hit };
    });
  }
  return /** @type {{ link: string, hit: Hit } | null} */ (nearest);
}
