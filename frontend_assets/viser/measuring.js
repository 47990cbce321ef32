/** @import { Door } from "./door.js" */
/** @import { Dot, Label, Line, Place } from "./screen.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { JointView, Matrix4, Vector3 } from "./viser.d.ts" */

import { DrawnLines, placeOf, pixelsBetween, pixelsToLine } from "./screen.js";
import { pickSurface } from "./picking.js";

/** @typedef {{ ends: Anchor[], label: string }} DrawnMeasure */
/** @typedef {{ at: [number, number, number], label: string }} Centre */

/**
 * What is measured in this browser: the aim of the mouse while it is on, and the lines of what was
 * measured, which move with the links. The page keeps the measures and knows their numbers.
 */
export class Measuring {
  /** What may be aimed at; null: nothing is measured. @type {AimMode | null} */
  #mode = null;
  /** @type {readonly DrawnMeasure[]} */
  #measures = [];
  /** @type {Centre | null} */
  #centre = null;
  /** @type {Anchor | null} */
  #aimed = null;
  #lines = new DrawnLines();
  #door;
  #robot;
  #aim;

  /** @param {Door} door @param {RobotView} robot @param {Aim} aim */
  constructor(door, robot, aim) {
    this.#door = door;
    this.#robot = robot;
    this.#aim = aim;
  }

  /** @param {AimMode | null} mode */
  setMode(mode) {
    this.#mode = mode;
    this.#aimed = null;
    this.#door.redraw();
  }

  /** @param {readonly DrawnMeasure[]} measures the last may lack an end */
  setMeasures(measures) {
    this.#measures = measures;
    this.#door.redraw();
  }

  /** The robot's centre of mass in the root frame, m. @param {Centre | null} centre */
  setCentre(centre) {
    this.#centre = centre;
    this.#door.redraw();
  }

  /** Show what a click here would take; null: the mouse is away. @param {{ x: number, y: number, free: boolean } | null} place */
  hover(place) {
    const aimed = place && this.take(place);
    if (JSON.stringify(aimed) === JSON.stringify(this.#aimed)) return;
    this.#aimed = aimed;
    this.#door.redraw();
  }

  /** What a click here takes. @param {{ x: number, y: number, free: boolean }} place @returns {Anchor | null} */
  take({ x, y, free }) {
    return this.#mode && this.#aim.at(x, y, this.#mode, free);
  }

  /** After each picture. @param {string} colour of the lines; empty: that of the theme */
  draw(colour) {
    /** @type {{ lines: Line[], dots: Dot[], labels: Label[] }} */
    const all = { lines: [], dots: [], labels: [] };
    for (const measure of this.#measures) this.#addMeasure(all, measure, colour);
    if (this.#mode === "axes")
      for (const name of this.#robot.joints.keys()) this.#addAxis(all.lines, name);
    if (this.#mode === "frames")
      for (const link of this.#robot.drawn) this.#addDot(all.dots, { kind: "frame", link });
    if (this.#aimed) this.#addAim(all, this.#aimed);
    if (this.#centre) this.#addCentre(all, this.#centre);
    this.#lines.draw(all);
  }

  /** @param {{ lines: Line[], dots: Dot[], labels: Label[] }} all @param {DrawnMeasure} measure
   * @param {string} colour */
  #addMeasure({ lines, dots, labels }, { ends, label }, colour) {
    const places = ends.map((end) => this.#placeOf(end));
    const seen = places.filter((place) => place !== null);
    if (seen.length === places.length && seen.length > 1) lines.push({ places: seen, kind: "line", colour });
    for (const end of ends) {
      if (end.kind === "axis") this.#addAxis(lines, end.joint);
      this.#addDot(dots, end);
    }
    const [first, second] = seen;
    if (!label || !first || !second) return;
    // Beside an angle its corner is meant, else the line.
    const place = /** @type {Place} */ (ends.length > 2 ? aside(second) : between(first, second));
    labels.push({ place, text: label, kind: "measure" });
  }

  /** @param {{ lines: Line[], dots: Dot[], labels: Label[] }} all @param {Anchor} aimed */
  #addAim({ lines, dots, labels }, aimed) {
    const place = this.#placeOf(aimed);
    if (!place) return;
    if (aimed.kind === "axis") this.#addAxis(lines, aimed.joint, "aim");
    dots.push({ place, kind: "aim" });
    labels.push({ place, text: aimed.kind === "axis" ? aimed.joint : aimed.link, kind: "aim" });
  }

  /** @param {{ dots: Dot[], labels: Label[] }} all @param {Centre} centre */
  #addCentre({ dots, labels }, { at, label }) {
    const root = this.#door.node("/robot")?.matrixWorld;
    const place = root && this.#seen(root, at);
    if (!place) return;
    dots.push({ place, kind: "centre" });
    labels.push({ place: [place[0], place[1] - 20], text: label, kind: "centre" });
  }

  /** @param {Line[]} lines @param {string} name @param {"axis" | "aim"} [kind] */
  #addAxis(lines, name, kind = "axis") {
    const joint = this.#robot.joints.get(name);
    const ends = joint && this.#aim.axisLine(joint);
    if (!ends) return;
    const [begin, end] = ends.map((one) => placeOf(this.#door, one));
    if (begin && end) lines.push({ places: [begin, end], kind });
  }

  /** @param {Dot[]} dots @param {Anchor} anchor */
  #addDot(dots, anchor) {
    const place = this.#placeOf(anchor);
    if (place) dots.push({ place, kind: anchor.kind });
  }

  /** @param {Anchor} anchor @returns {Place | null} */
  #placeOf(anchor) {
    const node = this.#robot.node(anchor.link);
    return node ? this.#seen(node.matrixWorld, anchor.kind === "point" ? anchor.at : [0, 0, 0]) : null;
  }

  /** @param {Matrix4} matrix @param {[number, number, number]} point @returns {Place | null} */
  #seen(matrix, point) {
    /** @type {Vector3 | undefined} */
    const vector = this.#door.mutable?.camera?.position.clone();
    return vector ? placeOf(this.#door, vector.set(...point).applyMatrix4(matrix)) : null;
  }
}

/** @param {Place} a @param {Place} b @returns {Place} */
const between = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];

/** @param {Place} place @returns {Place} */
const aside = ([x, y]) => [x, y - 22];

/** @typedef {"all" | "points" | "frames" | "axes"} AimMode */
/** @typedef {[number, number, number]} Triple */
/**
 * Something that can be measured, as the page keeps it: a point and its normal in the frame of the
 * link, the link's frame itself, or the axis of a joint, which is at rest in its child.
 * @typedef {{ kind: "point", link: string, at: Triple, normal: Triple | null } | { kind: "frame", link: string } | { kind: "axis", link: string, joint: string }} Anchor
 */

const CORNER_PX = 9;
/** Where everything may be meant, a frame must be met better than where only frames are. */
const FRAME_PX = { all: 9, frames: 26 };
const AXIS_PX = { all: 6, axes: 14 };
/** Half the length of an axis that can be met, of the distance from the eye. */
const AXIS_SHARE = 0.11;
const MOVES = new Set(["revolute", "continuous", "prismatic"]);

/** What of the robot is meant by a place of the window. */
export class Aim {
  #door;
  #robot;
  #distance;

  /** @param {Door} door @param {RobotView} robot @param {() => number} distance from the eye to what it looks at, m */
  constructor(door, robot, distance) {
    this.#door = door;
    this.#robot = robot;
    this.#distance = distance;
  }

  /** @param {number} x @param {number} y @param {AimMode} mode @param {boolean} free without snapping
   * @returns {Anchor | null} */
  at(x, y, mode, free) {
    if (mode === "points" || free) return this.#surfacePoint(x, y, free);
    if (mode === "frames") return this.#frame(x, y, FRAME_PX.frames);
    if (mode === "axes") return this.#axis(x, y, AXIS_PX.axes);
    return (
      this.#frame(x, y, FRAME_PX.all) ??
      this.#axis(x, y, AXIS_PX.all) ??
      this.#surfacePoint(x, y, false)
    );
  }

  /** Both ends of what is drawn of an axis, in the scene. @param {JointView} joint @returns {[Vector3, Vector3] | null} */
  axisLine(joint) {
    const node = this.#robot.node(joint.child);
    if (!node || !MOVES.has(joint.type)) return null;
    const middle = this.#origin(node.matrixWorld);
    const way = middle.clone().set(...joint.axis);
    if (!(way.length() > 0)) return null;
    way.transformDirection(node.matrixWorld).multiplyScalar(AXIS_SHARE * this.#distance());
    return [middle.clone().sub(way), middle.clone().add(way)];
  }

  /** @param {number} x @param {number} y @param {boolean} free @returns {Anchor | null} */
  #surfacePoint(x, y, free) {
    const found = pickSurface(this.#door, this.#robot, x, y);
    const node = found && this.#robot.node(found.link);
    if (!node) return null;
    const corner = free ? null : this.#nearestCorner(found.corners, x, y);
    const back = node.matrixWorld.clone().invert();
    const normal = found.normal?.transformDirection(back) ?? null;
    return {
      kind: "point",
      link: found.link,
      at: triple((corner ?? found.point).clone().applyMatrix4(back)),
      normal: normal && triple(normal),
    };
  }

  /** @param {Vector3[]} corners @param {number} x @param {number} y */
  #nearestCorner(corners, x, y) {
    return nearest(corners, CORNER_PX, (corner) => this.#pixels(corner, x, y));
  }

  /** @param {number} x @param {number} y @param {number} within px @returns {Anchor | null} */
  #frame(x, y, within) {
    const links = [...this.#robot.drawn];
    const found = nearest(links, within, (link) => {
      const node = this.#robot.node(link);
      return node ? this.#pixels(this.#origin(node.matrixWorld), x, y) : null;
    });
    return found === null ? null : { kind: "frame", link: found };
  }

  /** @param {number} x @param {number} y @param {number} within px @returns {Anchor | null} */
  #axis(x, y, within) {
    const found = nearest(this.#robot.joints.values(), within, (joint) => {
      const [begin, end] = (this.axisLine(joint) ?? []).map((one) => placeOf(this.#door, one));
      return begin && end ? pixelsToLine([x, y], begin, end) : null;
    });
    return found && { kind: "axis", link: found.child, joint: found.name };
  }

  /** @param {Vector3} point @param {number} x @param {number} y */
  #pixels(point, x, y) {
    const place = placeOf(this.#door, point);
    return place && pixelsBetween(place, [x, y]);
  }

  /** @param {import("./viser.d.ts").Matrix4} matrix @returns {Vector3} */
  #origin(matrix) {
    const camera = this.#door.mutable?.camera;
    if (!camera) throw new Error("The 3D view has no camera yet.");
    return camera.position.clone().setFromMatrixPosition(matrix);
  }
}

/** @template T @param {Iterable<T>} all @param {number} within @param {(one: T) => number | null} distance
 * @returns {T | null} */
function nearest(all, within, distance) {
  /** @type {T | null} */
  let found = null;
  let least = within;
  for (const one of all) {
    const far = distance(one);
    if (far === null || far > least) continue;
    least = far;
    found = one;
  }
  return found;
}

/** @param {Vector3} vector @returns {Triple} */
function triple({ x, y, z }) {
  return [x, y, z];
}
