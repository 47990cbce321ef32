/** @import { CloudDetail } from "./cloud-detail.js" */
/** @import { Door } from "./door.js" */
/** @import { Lens, Numbers, Rect } from "./lens.js" */
/** @import { LiveNode, Props } from "./live-nodes.js" */
/** @import { Object3D, Pointing, Vector3 } from "./viser.d.ts" */

import { fromHalf } from "./extent.js";
import { inside, isIn, lensOf, touches } from "./lens.js";
import { liveNodes } from "./live-nodes.js";
import { hitOf, rayThrough } from "./picking.js";
import { pixelsToLine } from "./screen.js";
import { cross, dot, minus } from "../lib/vectors.js";

/** @typedef {[number, number, number]} Triple */
/**
 * What a click meets.
 *
 * @typedef {object} Met
 * @property {number} row of the node
 * @property {number} depth_m from the eye
 * @property {number} miss_px from what is drawn; 0: it was met
 * @property {Triple | null} place in the frame of the group, of a surface
 */

/** Rows looked at, until somebody else has a turn. */
const AT_ONCE = 16_384;
/** Of points that lie beside each other, as far away but for this share, the nearest to the mouse is meant. */
const AS_NEAR = 0.02;
/** What is thinner is met as if it were so wide to either side. */
const LEAST_PX = 3;
/** The numbers of half precision by their bits. @type {Float32Array | null} */
let halves = null;

/** @returns {Float32Array} */
function halfNumbers() {
  halves ??= Float32Array.from({ length: 65_536 }, (_, bits) => fromHalf(bits));
  return halves;
}

/** Numbers as they are meant: a cloud may have come in half precision. @param {Numbers} numbers @returns {(at: number) => number} */
export function reading(numbers) {
  const plain = /** @type {Float32Array} */ (numbers);
  if (!(numbers instanceof Uint16Array)) return (at) => /** @type {number} */ (plain[at]);
  const table = halfNumbers();
  return (at) => /** @type {number} */ (table[/** @type {number} */ (numbers[at])]);
}

/**
 * The nearest to the eye of what a click meets; else the nearest to the mouse within reach.
 * @param {Door} door @param {CloudDetail} detail @param {{ x: number, y: number }} spot @param {number} reach_px
 * @returns {{ node: LiveNode, met: Met } | null}
 */
export function liveAt(door, detail, spot, reach_px) {
  /** @type {{ node: LiveNode, met: Met } | null} */
  let best = null;
  for (const node of liveNodes(door)) {
    const met = metOf(door, detail, node, spot, reach_px);
    if (met && isBetter(met, best?.met ?? null)) best = { node, met };
  }
  return best;
}

/** @param {Met} met @param {Met | null} best */
export function isBetter(met, best) {
  if (!best) return true;
  if (met.miss_px > 0 || best.miss_px > 0) return met.miss_px < best.miss_px;
  return met.depth_m < best.depth_m;
}

/** @param {Door} door @param {CloudDetail} detail @param {LiveNode} node @param {{ x: number, y: number }} spot @param {number} reach_px @returns {Met | null} */
function metOf(door, detail, node, spot, reach_px) {
  const lens = lensOf(door, node.object);
  if (!lens) return null;
  const { kind, props } = node;
  if (kind === "PointCloudMessage")
    return pointAt(lens, props, detail.drawnRows(node.name), spot, reach_px);
  if (kind === "LineSegmentsMessage" || kind === "ArrowMessage")
    return lineAt(lens, props, spot, reach_px);
  if (kind === "BatchedAxesMessage") return axesAt(lens, props, spot, reach_px);
  const sight = rayThrough(door, spot.x, spot.y);
  if (!sight) return null;
  if (kind === "BatchedMeshesMessage") return solidAt(lens, props, localSight(node.object, sight));
  return surfaceAt(door, node, sight);
}

/** Half of the width of a point that has a size in the scene, m. @param {Props} cloud @param {number} z m, in its frame */
export const radiusAt = ({ point_size: radius_m = 0, studio_size_by_z: isByZ = false }, z) =>
  isByZ ? radius_m * Math.abs(z) : radius_m;

/**
 * @param {Lens} lens @param {Props} props @param {Numbers | null} rows of the whole cloud that are drawn; null: all
 * @param {{ x: number, y: number }} spot @param {number} reach_px @returns {Met | null}
 */
export function pointAt(lens, props, rows, spot, reach_px) {
  const { points = [], studio_point_px: px = 0 } = props;
  const read = reading(points);
  /** @type {Met | null} */
  let best = null;
  let best_px = 0;
  for (let at = 0; at < points.length; at += 3) {
    if (!lens.at(read(at), read(at + 1), read(at + 2))) continue;
    const own_px = px > 0 ? px / 2 : radiusAt(props, read(at + 2)) * lens.perMetre;
    const radius_px = Math.max(own_px, LEAST_PX);
    const middle_px = Math.hypot(lens.x - spot.x, lens.y - spot.y);
    const away_px = middle_px - radius_px;
    if (away_px > reach_px) continue;
    const met = { row: at / 3, depth_m: lens.depth_m, miss_px: Math.max(away_px, 0), place: null };
    const isAsNear = best !== null && Math.abs(best.depth_m / met.depth_m - 1) < AS_NEAR;
    if (isAsNear ? middle_px >= best_px : !isBetter(met, best)) continue;
    [best, best_px] = [met, middle_px];
  }
  if (best && rows) best.row = /** @type {number} */ (rows[best.row]);
  return best;
}

/** @param {Lens} lens @param {Props} props @param {{ x: number, y: number }} spot @param {number} reach_px @returns {Met | null} */
export function lineAt(lens, { points = [], ...look }, spot, reach_px) {
  const read = reading(points);
  /** @type {Met | null} */
  let best = null;
  for (let at = 0; at < points.length; at += 6) {
    const met = pieceAt(lens, read, at, at + 3, halfWidth(look), spot, reach_px);
    if (met && isBetter(met, best)) best = { ...met, row: at / 6 };
  }
  return best;
}

/** Half of the width of a line, m. @param {Props} props */
function halfWidth({ head_radius: head, thickness = 0, thickness_units: units }) {
  if (head !== undefined) return head;
  return units === "world" ? thickness / 2 : 0;
}

/** A piece between two places. @param {Lens} lens @param {(at: number) => number} read @param {number} from @param {number} to @param {number} half_m
 * @param {{ x: number, y: number }} spot @param {number} reach_px @returns {Met | null} */
function pieceAt(lens, read, from, to, half_m, spot, reach_px) {
  if (!lens.at(read(from), read(from + 1), read(from + 2))) return null;
  const [x, y, depth_m, perMetre] = [lens.x, lens.y, lens.depth_m, lens.perMetre];
  if (!lens.at(read(to), read(to + 1), read(to + 2))) return null;
  const half_px = Math.max(half_m * Math.max(perMetre, lens.perMetre), LEAST_PX);
  const away_px = pixelsToLine([spot.x, spot.y], [x, y], [lens.x, lens.y]) - half_px;
  if (away_px > reach_px) return null;
  return {
    row: 0,
    depth_m: Math.min(depth_m, lens.depth_m),
    miss_px: Math.max(away_px, 0),
    place: null,
  };
}

/** @param {Lens} lens @param {Props} props @param {{ x: number, y: number }} spot @param {number} reach_px @returns {Met | null} */
function axesAt(lens, props, spot, reach_px) {
  const ends = axesEnds(props);
  const met = lineAt(lens, { points: ends, thickness: 0 }, spot, reach_px);
  return met && { ...met, row: Math.floor(met.row / 3) };
}

/** The axes of crosses as pieces of lines, three of each. @param {Props} props @returns {Float32Array} */
export function axesEnds({
  batched_positions: middles = [],
  batched_wxyzs: turns = [],
  axes_length: long = 0,
}) {
  const ends = new Float32Array(middles.length * 6);
  for (let row = 0; row * 3 < middles.length; row += 1) {
    const middle = tripleAt(middles, row);
    const matrix = matrixOf(turns, row);
    for (let axis = 0; axis < 3; axis += 1)
      for (let part = 0; part < 3; part += 1) {
        const at = 18 * row + 6 * axis + part;
        ends[at] = /** @type {number} */ (middle[part]);
        ends[at + 3] =
          /** @type {number} */ (middle[part]) +
          long * /** @type {number} */ (matrix[3 * part + axis]);
      }
  }
  return ends;
}

/** The matrix of a turn, row by row; without numbers, of none. @param {Numbers} turns @param {number} row @returns {number[]} */
export function matrixOf(turns, row) {
  const [w = 1, x = 0, y = 0, z = 0] = [0, 1, 2, 3].map((at) => turns[4 * row + at]);
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y - w * z),
    2 * (x * z + w * y),
    2 * (x * y + w * z),
    1 - 2 * (x * x + z * z),
    2 * (y * z - w * x),
    2 * (x * z - w * y),
    2 * (y * z + w * x),
    1 - 2 * (x * x + y * y),
  ];
}

/** @param {Numbers} numbers @param {number} row @returns {Triple} */
const tripleAt = (numbers, row) => [
  numbers[3 * row] ?? 0,
  numbers[3 * row + 1] ?? 0,
  numbers[3 * row + 2] ?? 0,
];

/** The line of sight in the axes of an object. @param {Object3D} object @param {{ origin: Vector3, direction: Vector3 }} sight @returns {{ origin: Triple, direction: Triple }} */
function localSight({ matrixWorld }, { origin, direction }) {
  const from = inside(matrixWorld, origin);
  const to = inside(matrixWorld, origin.clone().add(direction));
  return { origin: from, direction: [to[0] - from[0], to[1] - from[1], to[2] - from[2]] };
}

/** One of many solids: the ray is turned into the axes of each, where all have the same triangles.
 * @param {Lens} lens @param {Props} props @param {{ origin: Triple, direction: Triple }} sight @returns {Met | null} */
export function solidAt(lens, props, sight) {
  const {
    batched_positions: middles = [],
    batched_scales: scales,
    batched_wxyzs: turns = [],
  } = props;
  const { vertices = [], faces = [] } = props;
  const reach = radiusOf(vertices);
  /** @type {{ row: number, along: number } | null} */
  let best = null;
  for (let row = 0; row * 3 < middles.length; row += 1) {
    const middle = tripleAt(middles, row);
    const scale = scales ? tripleAt(scales, row) : ONES;
    if (!isNear(sight, middle, reach * Math.max(...scale))) continue;
    const own = ownSight(sight, middle, matrixOf(turns, row), scale);
    const along = meshAlong(own, vertices, faces);
    if (along !== null && (!best || along < best.along)) best = { row, along };
  }
  if (!best) return null;
  const { origin, direction } = sight;
  const at = direction.map(
    (part, axis) => /** @type {number} */ (origin[axis]) + part * best.along,
  );
  lens.at(.../** @type {Triple} */ (at));
  return { row: best.row, depth_m: lens.depth_m, miss_px: 0, place: null };
}

/** @type {Triple} */
const ONES = [1, 1, 1];

/** @param {Numbers} vertices */
function radiusOf(vertices) {
  let most = 0;
  for (let row = 0; row * 3 < vertices.length; row += 1)
    most = Math.max(most, Math.hypot(...tripleAt(vertices, row)));
  return most;
}

/** Whether a line passes a place within a distance. @param {{ origin: Triple, direction: Triple }} sight @param {Triple} place @param {number} reach */
function isNear({ origin, direction }, place, reach) {
  const [x, y, z] = [place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]];
  const [u, v, w] = direction;
  const along = (x * u + y * v + z * w) / (u * u + v * v + w * w);
  return Math.hypot(x - along * u, y - along * v, z - along * w) <= reach;
}

/** @param {{ origin: Triple, direction: Triple }} sight @param {Triple} middle @param {number[]} turn @param {Triple} scale */
function ownSight({ origin, direction }, middle, turn, scale) {
  const back = (/** @type {Triple} */ [x, y, z]) =>
    /** @type {Triple} */ (
      [0, 1, 2].map((axis) => {
        const part = (/** @type {number} */ row) => /** @type {number} */ (turn[3 * row + axis]);
        return (part(0) * x + part(1) * y + part(2) * z) / (scale[/** @type {0} */ (axis)] || 1e-9);
      })
    );
  const from = back([origin[0] - middle[0], origin[1] - middle[1], origin[2] - middle[2]]);
  return { origin: from, direction: back(direction) };
}

/** How far along a ray the nearest triangle is, in lengths of its direction; null: it meets none.
 * @param {{ origin: Triple, direction: Triple }} ray @param {Numbers} vertices @param {Numbers} faces */
export function meshAlong(ray, vertices, faces) {
  /** @type {number | null} */
  let nearest = null;
  for (let at = 0; at < faces.length; at += 3) {
    const [a, b, c] = [0, 1, 2].map((corner) => tripleAt(vertices, faces[at + corner] ?? 0));
    const along = triangleAlong(
      ray,
      /** @type {Triple} */ (a),
      /** @type {Triple} */ (b),
      /** @type {Triple} */ (c),
    );
    if (along !== null && (nearest === null || along < nearest)) nearest = along;
  }
  return nearest;
}

/** By Moeller and Trumbore. @param {{ origin: Triple, direction: Triple }} ray @param {Triple} a @param {Triple} b @param {Triple} c */
function triangleAlong({ origin, direction }, a, b, c) {
  const [one, other] = [minus(b, a), minus(c, a)];
  const across = cross(direction, other);
  const size = dot(one, across);
  if (Math.abs(size) < 1e-15) return null;
  const from = minus(origin, a);
  const first = dot(from, across) / size;
  const aside = cross(from, one);
  const second = dot(direction, aside) / size;
  if (first < 0 || second < 0 || first + second > 1) return null;
  const along = dot(other, aside) / size;
  return along > 0 ? along : null;
}

/** What else is drawn: surfaces of triangles, pictures, words. @param {Door} door @param {LiveNode} node @param {Pointing["ray"]} sight @returns {Met | null} */
function surfaceAt(door, node, sight) {
  const lens = lensOf(door, node.group);
  const hit = hitOf(door, node.object, sight);
  if (!lens || !hit) return null;
  const place = inside(node.group.matrixWorld, hit.point);
  lens.at(...place);
  return { row: hit.faceIndex ?? 0, depth_m: lens.depth_m, miss_px: 0, place };
}

/**
 * Rows of a node that lie in a rectangle, one after the other; null now and then, for others to have
 * their turn.
 * @param {Door} door @param {CloudDetail} detail @param {LiveNode} node @param {Rect} rect
 * @returns {Generator<number | null>}
 */
export function rowsIn(door, detail, node, rect) {
  const lens = lensOf(door, node.object);
  const { kind, props } = node;
  if (!lens) return none();
  if (kind === "PointCloudMessage")
    return pointsIn(lens, detail.wholePoints(node.name) ?? props.points ?? [], rect);
  if (kind === "LineSegmentsMessage" || kind === "ArrowMessage")
    return linesIn(lens, props.points ?? [], rect, 1);
  if (kind === "BatchedAxesMessage") return linesIn(lens, axesEnds(props), rect, 3);
  if (kind === "BatchedMeshesMessage") return solidsIn(lens, props, rect);
  if (kind === "LabelMessage") return none();
  const rows = surfacesIn(door, node.object, rect);
  return SURFACES.has(node.node) ? rows : firstOf(rows);
}

/** Nodes of surfaces, each of whose triangles may be of another item. */
const SURFACES = new Set(["surface", "colored"]);

/** One row for all, of what is one thing. @param {Generator<number | null>} rows @returns {Generator<number | null>} */
function* firstOf(rows) {
  for (const row of rows) {
    yield row === null ? null : 0;
    if (row !== null) return;
  }
}

/** @returns {Generator<number | null>} */
function* none() {
  yield null;
}

/** @param {Lens} lens @param {Numbers} points @param {Rect} rect @returns {Generator<number | null>} */
export function* pointsIn(lens, points, rect) {
  const read = reading(points);
  const count = Math.floor(points.length / 3);
  for (let row = 0; row < count; row += 1) {
    if (row % AT_ONCE === AT_ONCE - 1) yield null;
    if (lens.at(read(3 * row), read(3 * row + 1), read(3 * row + 2)) && isIn(rect, lens.x, lens.y))
      yield row;
  }
}

/** @param {Lens} lens @param {Numbers} points @param {Rect} rect @param {number} each lines of one row @returns {Generator<number | null>} */
export function* linesIn(lens, points, rect, each) {
  const read = reading(points);
  let last = -1;
  for (let line = 0; line * 6 < points.length; line += 1) {
    if (line % AT_ONCE === AT_ONCE - 1) yield null;
    const row = Math.floor(line / each);
    if (row === last || !lens.at(read(6 * line), read(6 * line + 1), read(6 * line + 2))) continue;
    const [x, y] = [lens.x, lens.y];
    if (!lens.at(read(6 * line + 3), read(6 * line + 4), read(6 * line + 5))) continue;
    if (!touches(rect, [x, y, lens.x, lens.y], [lens.x - x, lens.y - y])) continue;
    last = row;
    yield row;
  }
}

/** @param {Lens} lens @param {Props} props @param {Rect} rect @returns {Generator<number | null>} */
export function* solidsIn(lens, props, rect) {
  const {
    batched_positions: middles = [],
    batched_scales: scales,
    batched_wxyzs: turns = [],
  } = props;
  const [low, high] = boundsOf(props.vertices ?? []);
  for (let row = 0; row * 3 < middles.length; row += 1) {
    if (row % 1024 === 1023) yield null;
    const scale = scales ? tripleAt(scales, row) : ONES;
    const seen = boxSeen(lens, tripleAt(middles, row), matrixOf(turns, row), scale, low, high);
    if (seen && touches(rect, seen, sidesOfBox(seen))) yield row;
  }
}

/** @param {Numbers} vertices @returns {[Triple, Triple]} */
function boundsOf(vertices) {
  /** @type {Triple} */
  const low = [Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY];
  /** @type {Triple} */
  const high = [Number.NEGATIVE_INFINITY, Number.NEGATIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (let at = 0; at < vertices.length; at += 1) {
    const axis = /** @type {0} */ (at % 3);
    low[axis] = Math.min(low[axis], vertices[at] ?? 0);
    high[axis] = Math.max(high[axis], vertices[at] ?? 0);
  }
  return [low, high];
}

/** Where the eight corners of a box are seen; null: one of them is not in front. @param {Lens} lens @param {Triple} middle @param {number[]} turn
 * @param {Triple} scale @param {Triple} low @param {Triple} high @returns {number[] | null} */
export function boxSeen(lens, middle, turn, scale, low, high) {
  const seen = [];
  for (let corner = 0; corner < 8; corner += 1) {
    const own = [0, 1, 2].map((axis) => {
      const at = /** @type {0} */ (axis);
      return ((corner >> axis) & 1 ? high[at] : low[at]) * scale[at];
    });
    const [x = 0, y = 0, z = 0] = own;
    const part = (/** @type {number} */ row) =>
      /** @type {number} */ (middle[/** @type {0} */ (row)]) +
      /** @type {number} */ (turn[3 * row]) * x +
      /** @type {number} */ (turn[3 * row + 1]) * y +
      /** @type {number} */ (turn[3 * row + 2]) * z;
    if (!lens.at(part(0), part(1), part(2))) return null;
    seen.push(lens.x, lens.y);
  }
  return seen;
}

/** The three directions of the sides of a box. @param {number[]} seen of its corners */
function sidesOfBox(seen) {
  const [x = 0, y = 0] = seen;
  return [1, 2, 4].flatMap((corner) => [
    (seen[2 * corner] ?? 0) - x,
    (seen[2 * corner + 1] ?? 0) - y,
  ]);
}

/** Triangles of all meshes of an object: they count on from mesh to mesh. @param {Door} door @param {Object3D} object @param {Rect} rect @returns {Generator<number | null>} */
export function* surfacesIn(door, object, rect) {
  /** @type {Object3D[]} */
  const meshes = [];
  object.traverseVisible((one) => {
    if (one.isMesh && one.geometry?.attributes?.position) meshes.push(one);
  });
  let before = 0;
  for (const mesh of meshes) {
    const { count, faces } = trianglesOf(mesh);
    const lens = lensOf(door, mesh);
    if (lens && mayTouch(lens, mesh, rect))
      for (const row of facesIn(lens, faces, count, rect)) yield row === null ? null : row + before;
    before += count;
  }
}

/** By the box around a mesh. @param {Lens} lens @param {Object3D} mesh @param {Rect} rect */
function mayTouch(lens, { geometry }, rect) {
  if (!geometry) return false;
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox ?? {};
  if (!min || !max) return false;
  const seen = boxSeen(
    lens,
    [0, 0, 0],
    NO_TURN,
    ONES,
    [min.x, min.y, min.z],
    [max.x, max.y, max.z],
  );
  return !seen || touches(rect, seen, []);
}

const NO_TURN = [1, 0, 0, 0, 1, 0, 0, 0, 1];

/** @param {Object3D} mesh @returns {{ count: number, faces: (corner: number) => Triple }} */
function trianglesOf({ geometry }) {
  const places = geometry?.attributes?.position;
  const index = geometry?.index ?? null;
  if (!places) return { count: 0, faces: () => [0, 0, 0] };
  const faces = (/** @type {number} */ corner) => {
    const at = index ? index.getX(corner) : corner;
    return /** @type {Triple} */ ([places.getX(at), places.getY(at), places.getZ(at)]);
  };
  return { count: Math.floor((index?.count ?? places.count) / 3), faces };
}

/** @param {Lens} lens @param {(corner: number) => Triple} faces @param {number} count @param {Rect} rect @returns {Generator<number | null>} */
function* facesIn(lens, faces, count, rect) {
  for (let face = 0; face < count; face += 1) {
    if (face % 2048 === 2047) yield null;
    const seen = [];
    for (let corner = 0; corner < 3; corner += 1)
      if (lens.at(...faces(3 * face + corner))) seen.push(lens.x, lens.y);
    if (seen.length === 6 && touches(rect, seen, sidesOfTriangle(seen))) yield face;
  }
}

/** @param {number[]} seen */
function sidesOfTriangle([x0 = 0, y0 = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0]) {
  return [x1 - x0, y1 - y0, x2 - x1, y2 - y1, x0 - x2, y0 - y2];
}
