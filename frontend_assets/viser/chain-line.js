/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
import { DrawnLines } from "./drawn-lines.js";
import { followedName } from "./follow.js";
import { placeOf } from "./screen.js";

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
