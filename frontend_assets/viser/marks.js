/** @import { Door } from "./door.js" */
/** @import { JointView, Material, Message, Object3D } from "./viser.d.ts" */
/** @import { RobotView } from "./robot.js" */

import { followedName } from "./camera.js";
import { fromFixedFrame } from "./ground.js";
import { RobotView } from "./robot.js";
import { DrawnLines, placeOf } from "./screen.js";

/** Of the robot's size. */
const FRAME_SHARE = 0.11;
const AXIS_SHARE = 0.16;
/** How far the axis reaches to the other side. */
const BACK = 0.55;
const SMALLEST_M = 0.01;
const AXIS_RGB = [255, 176, 46];
const MOVES = new Set(["revolute", "continuous", "prismatic"]);

/**
 * Frames and the axis of a joint, drawn over everything and in this browser only. They hang on the
 * nodes of links and of followed frames, so that they move with them.
 */
export class Marks {
  /** Names of nodes and what makes each, as they stand in the scene. @type {Map<string, Message>} */
  #shown = new Map();
  /** @type {Map<string, Message>} */
  #frames = new Map();
  /** @type {Map<string, Message>} */
  #axes = new Map();
  /** @type {WeakSet<Material>} */
  #raised = new WeakSet();
  #door;
  #robot;

  /** @param {Door} door @param {RobotView} robot */
  constructor(door, robot) {
    this.#door = door;
    this.#robot = robot;
    door.onMessage((message) => this.#standAnew(message));
    door.onPicture(() => this.#raise());
  }

  /** @param {readonly string[]} links whose frames are seen @param {readonly string[]} others that are no links */
  setFrames(links, others) {
    if (links.length + others.length + this.#frames.size === 0) return;
    const nodes = [...links.map(RobotView.nodeName), ...others.map(followedName)];
    const length = FRAME_SHARE * this.#size();
    this.#frames = new Map(nodes.map((node) => named(node, "studio_frame", frame(length))));
    this.#show();
  }

  /** The axis that a joint turns about or slides along. @param {JointView | null} joint null: none */
  setAxis(joint) {
    const before = this.#axes;
    this.#axes = new Map();
    if (joint && MOVES.has(joint.type) && joint.axis.some((part) => part !== 0)) {
      const drawn = axis(joint.axis, AXIS_SHARE * this.#size());
      this.#axes.set(...named(RobotView.nodeName(joint.child), "studio_axis", drawn));
    }
    if (before.size + this.#axes.size > 0) this.#show();
  }

  #show() {
    const wanted = new Map([...this.#frames, ...this.#axes]);
    /** @type {Message[]} */
    const messages = [];
    for (const name of this.#shown.keys())
      if (!wanted.has(name)) messages.push({ type: "RemoveSceneNodeMessage", name, owner: "" });
    for (const [name, message] of wanted)
      if (this.#standsOn(name) && !same(this.#shown.get(name), message)) messages.push(message);
    this.#shown = wanted;
    this.#door.inject(...messages);
  }

  /** @param {string} name @returns {boolean} its link is there; else it comes with it */
  #standsOn(name) {
    return this.#door.node(name.slice(0, name.lastIndexOf("/"))) !== undefined;
  }

  /** With a link that is made anew its marks are gone. @param {Message} message */
  #standAnew(message) {
    if (message.type !== "FrameMessage") return;
    const below = `${message.name}/`;
    const lost = [...this.#shown].filter(([name]) => name.startsWith(below));
    // After what the server says of it in this same batch.
    if (lost.length > 0)
      queueMicrotask(() => this.#door.inject(...lost.map(([, mark]) => mark)));
  }

  /** Over everything, or the body that a frame lies in would hide it. */
  #raise() {
    for (const name of this.#shown.keys())
      this.#door.node(name)?.traverse((object) => this.#raiseObject(object));
  }

  /** @param {Object3D} object */
  #raiseObject(object) {
    for (const material of [object.material ?? []].flat()) {
      if (this.#raised.has(material)) continue;
      this.#raised.add(material);
      Object.assign(material, { depthTest: false, transparent: true, needsUpdate: true });
      object.renderOrder = 10;
    }
  }

  /** How far the robot reaches, m, in steps: one that grows a little keeps its marks. */
  #size() {
    const corners = this.#robot.corners(this.#robot.drawn);
    const [first] = corners;
    if (!first) return 1;
    let reach = SMALLEST_M;
    for (const corner of corners) reach = Math.max(reach, corner.distanceTo(first));
    return 2 ** (Math.round(2 * Math.log2(reach)) / 2);
  }
}

/** @param {string} node @param {string} below @param {Message} message @returns {[string, Message]} */
function named(node, below, message) {
  const name = `${node}/${below}`;
  return [name, { ...message, name, owner: "" }];
}

/** @param {number} length m @returns {Message} */
function frame(length) {
  const props = {
    ...{ show_axes: true, axes_length: length, axes_radius: length / 26 },
    ...{ origin_radius: length / 14, origin_color: [255, 255, 255], scale: 1 },
  };
  return { type: "FrameMessage", virtual: false, props };
}

/** @param {readonly [number, number, number]} direction of length 1 @param {number} length m @returns {Message} */
function axis(direction, length) {
  const tail = direction.map((part) => -BACK * length * part);
  const tip = direction.map((part) => length * part);
  const props = {
    points: new Float32Array([...tail, ...tip]),
    colors: new Uint8Array(AXIS_RGB),
    ...{ shaft_radius: length / 55, head_radius: length / 16, head_length: length / 4, scale: 1 },
  };
  return { type: "ArrowMessage", virtual: false, props };
}

/** @param {Message | undefined} one @param {Message} other */
const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/** The line from frame to frame of the chain that is looked at, over the picture of this browser only. */
export class ChainLine {
  /** @type {readonly string[]} */
  #frames = [];
  #lines = new DrawnLines();
  #door;
  #robot;

  /** @param {Door} door @param {RobotView} robot */
  constructor(door, robot) {
    this.#door = door;
    this.#robot = robot;
    door.onPicture(
      () => {},
      () => this.#draw(),
    );
  }

  /** @param {readonly string[]} frames in the order of the chain; none: no line */
  set(frames) {
    this.#frames = frames;
    this.#door.redraw();
  }

  /** What is not in the scene yet, or behind the eye, is passed over. */
  #draw() {
    const places = this.#frames.flatMap((frame) => this.#placeOf(frame) ?? []);
    const lines = places.length > 1 ? [{ places, kind: /** @type {const} */ ("chain") }] : [];
    this.#lines.draw({ lines, dots: [], labels: [] });
  }

  /** @param {string} frame @returns {[import("./screen.js").Place] | null} */
  #placeOf(frame) {
    const node = this.#robot.node(frame) ?? this.#door.node(followedName(frame));
    const eye = this.#door.mutable?.camera?.position;
    if (!node || !eye) return null;
    const place = placeOf(this.#door, eye.clone().setFromMatrixPosition(node.matrixWorld));
    return place && [place];
  }
}

/** What the presenter points at, over the picture of this browser only. */
export class Guide {
  /** In the root frame. @type {readonly [number, number, number] | null} */
  #place = null;
  #lines = new DrawnLines();
  #door;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onPicture(
      () => {},
      () => this.#draw(),
    );
  }

  /** @param {readonly [number, number, number] | null} place null: at nothing */
  set(place) {
    if (place === null && this.#place === null) return;
    this.#place = place;
    this.#door.redraw();
  }

  #draw() {
    const point = this.#place && fromFixedFrame(this.#door, this.#place);
    const seen = point && placeOf(this.#door, point);
    this.#lines.draw({ lines: [], dots: seen ? [{ place: seen, kind: "guide" }] : [], labels: [] });
  }
}
