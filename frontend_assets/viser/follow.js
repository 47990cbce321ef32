/** @import { CameraView } from "./camera.js" */
/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Vector3 } from "./viser.d.ts" */

/** Frames that are no links of the robot, which the studio puts there for who asks. */
const ROOT = "/live/followed/";
/** Its name in the scene. @param {string} frame */
export const followedName = (frame) => ROOT + encodeURIComponent(frame);
/** m; a frame that moved less stands still. */
const STILL_M = 1e-6;

/** Lets the camera go with a frame, as RViz's target frame does: with its place, not with its turns. */
export class Follow {
  #door;
  #robot;
  #camera;
  #frame = "";
  /** Where the frame was in the last picture. @type {Vector3 | null} */
  #last = null;
  /** Whether the frame shall be brought to the middle once it is there. */
  #isNew = false;

  /** @param {Door} door @param {RobotView} robot @param {CameraView} camera */
  constructor(door, robot, camera) {
    this.#door = door;
    this.#robot = robot;
    this.#camera = camera;
    door.onPicture(() => this.#go());
  }

  /** @param {string} frame empty: the camera stays where it is */
  set(frame) {
    if (frame === this.#frame) return;
    this.#frame = frame;
    this.#last = null;
    this.#isNew = frame !== "";
    this.#door.redraw();
  }

  #go() {
    const node = this.#frame === "" ? undefined : this.#node();
    const camera = this.#door.mutable?.camera;
    if (!node || !camera) {
      this.#last = null;
      return;
    }
    const now = camera.position.clone().setFromMatrixPosition(node.matrixWorld);
    const moved = now.clone().sub(this.#last ?? now);
    this.#last = now;
    if (this.#isNew) this.#camera.lookAt(now);
    this.#isNew = false;
    if (moved.length() > STILL_M) this.#camera.carry(moved);
  }

  #node() {
    return this.#robot.node(this.#frame) ?? this.#door.node(followedName(this.#frame));
  }
}
