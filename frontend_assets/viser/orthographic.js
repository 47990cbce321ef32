/** @import { Door } from "./door.js" */
/** @import { Camera, Material, Object3D, Vector3 } from "./viser.d.ts" */

/** m before and behind the eye that are drawn, and more of them when more is seen. */
const DEPTH_M = 1000;
const DEPTH_SHARE = 20;

/**
 * Lets viser's camera see without perspective. viser has one that sees with it and no other, so its
 * matrix of projection is changed whenever it was computed.
 *
 * The matrix is that of parallel rays times the distance to what is looked at. To the picture that is
 * the same, but `w` of a place is then as it is with perspective in that distance, and so are the sizes
 * that shaders compute by it: of points, of lines and of words.
 */
export class Orthographic {
  /** How far away it is what has the same size with perspective, m; null: with perspective. @type {number | null} */
  #distance = null;
  /** @type {Camera | null} */
  #camera = null;
  #door;
  #lines = new FlatLines();

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onPicture(
      () => this.#begin(),
      () => this.#end(),
    );
  }

  /** @param {number | null} distance null: with perspective */
  set(distance) {
    const camera = this.#door.mutable?.camera;
    if (!camera || (distance === this.#distance && camera === this.#camera)) return;
    this.#distance = distance;
    this.#tap(camera);
    camera.updateProjectionMatrix();
  }

  /** @param {Camera} camera */
  #tap(camera) {
    if (camera === this.#camera) return;
    this.#camera = camera;
    const compute = camera.updateProjectionMatrix.bind(camera);
    camera.updateProjectionMatrix = () => {
      compute();
      if (this.#distance !== null) flatten(camera, this.#distance);
    };
  }

  /** For the time of a picture the light falls on surfaces as it does without perspective. */
  #begin() {
    const { camera, scene } = this.#door.mutable ?? {};
    if (this.#distance === null || !camera || !scene) return;
    camera.isOrthographicCamera = true;
    scene.traverseVisible((object) => this.#lines.dress(object));
  }

  /** viser's own way to fit the camera to the window asks which of both it is. */
  #end() {
    if (this.#camera) this.#camera.isOrthographicCamera = false;
  }
}

/** @param {Camera} camera whose matrix has just been computed @param {number} distance m */
function flatten(camera, distance) {
  const e = camera.projectionMatrix.elements;
  const isReversed = (e[10] ?? 0) > 0;
  const depth = Math.max(DEPTH_M, DEPTH_SHARE * distance);
  // Reversed, depth is 1 at the nearest and 0 at the farthest; else from -1 to 1.
  e[10] = (isReversed ? 0.5 : -1) * (distance / depth);
  e[14] = isReversed ? distance / 2 : 0;
  e[11] = 0;
  e[15] = distance;
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
}

/** How far a place is before the eye, as sizes on the screen count it, m; without perspective the same for all.
 * @param {Camera} camera @param {Vector3} place in the scene */
export function depthOf(camera, place) {
  const e = camera.projectionMatrix.elements;
  const eye = place.clone().setFromMatrixPosition(camera.matrixWorld);
  const back = place.clone().setFromMatrixColumn(camera.matrixWorld, 2);
  return (e[11] ?? 0) * place.clone().sub(eye).dot(back) + (e[15] ?? 0);
}

/** How far before the eye that is what is drawn nearest, and some more than that, m; without perspective it
 * is behind the eye. @param {Camera} camera @param {number} share more than 1, by which it is farther */
export function nearestOf(camera, share) {
  const e = camera.projectionMatrix.elements;
  if (e[11] !== 0) return camera.near * share;
  const [scale = 1, offset = 0, distance = 1] = [e[10], e[14], e[15]];
  return (scale > 0 ? -offset / scale : distance / scale) / share;
}

/** Metres that a pixel shows in that depth. @param {Camera} camera @param {number} depth @param {number} height of the picture, px */
export const pixelAt = (camera, depth, height) =>
  (2 * depth) / ((camera.projectionMatrix.elements[5] ?? 1) * (height || 1));

/** Ways of sight to the ends of a line. */
const SIGHTS = ["cross( start.xyz, worldDir )", "cross( end.xyz, worldDir )"];
const FLAT_SIGHT = "cross( isOrthographic ? vec3( 0.0, 0.0, - 1.0 ) : ";
const RAY = "vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;";
const FLAT_RAY = `vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;
  vec3 rayBegin = vec3( 0.0 );
  if ( isOrthographic ) {
    float reach = 8.0 * linewidth + distance( worldStart, worldEnd );
    rayBegin = worldPos.xyz + vec3( 0.0, 0.0, reach );
    rayEnd = worldPos.xyz - vec3( 0.0, 0.0, reach );
  }`;
const FROM_EYE = "vec3( 0.0, 0.0, 0.0 ), rayEnd";
const FROM_RAY = "rayBegin, rayEnd";
const ON_RAY = "vec3 p2 = rayEnd * params.y;";
const ON_FLAT_RAY = "vec3 p2 = mix( rayBegin, rayEnd, params.y );";

/** Lines whose width is in metres are drawn by the ray from the eye: without perspective there is no eye. */
class FlatLines {
  /** @type {WeakSet<Material>} */
  #known = new WeakSet();

  /** @param {Object3D} object */
  dress(object) {
    const { material } = object;
    if (!material || Array.isArray(material) || !material.isLineMaterial) return;
    if (this.#known.has(material)) return;
    this.#known.add(material);
    for (const sight of SIGHTS)
      material.vertexShader = material.vertexShader.replace(sight, sight.replace("cross( ", FLAT_SIGHT));
    material.fragmentShader = flatRays(material.fragmentShader);
    material.needsUpdate = true;
  }
}

/** @param {string} shader */
const flatRays = (shader) =>
  shader.includes("rayBegin")
    ? shader
    : shader.replace(RAY, FLAT_RAY).replace(FROM_EYE, FROM_RAY).replace(ON_RAY, ON_FLAT_RAY);
