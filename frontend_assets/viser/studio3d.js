/** @import { CameraPose, JointView, RobotState } from "./viser.d.ts" */

import { Aim, Measuring } from "./measuring.js";
import { CameraPictures } from "./camera-pictures.js";
import { CameraView, Follow } from "./camera.js";
import { ChainLine, Guide, Marks } from "./marks.js";
import { CloudDetail } from "./cloud-detail.js";
import { Door, Removed } from "./door.js";
import { LiveExtent } from "./extent.js";
import { Light, Theme } from "./theme.js";
import { Live } from "./live.js";
import { Looks } from "./link-appearance.js";
import { pick } from "./picking.js";
import { Picture } from "./picture.js";
import { Pointer } from "./pointer.js";
import { Quality, Still } from "./quality.js";
import { RobotView } from "./robot.js";

/**
 * The 3D view as the page around it uses it: `iframe.contentWindow.studio3d`.
 *
 * Events on `events`, all with a `detail`: `hover {link}`, `select {link}` (null: empty space),
 * `touch {}` (a hand is on the camera), `focus {link}`, `measure {anchor}`, `drag {joint, value, phase, x, y}`, `connection {connected}`, and `key {key, code,
 * ctrlKey, metaKey, shiftKey, altKey, repeat}`, which may be prevented.
 */
class Studio3d {
  events = new EventTarget();
  #door = new Door();
  #robot = new RobotView(this.#door);
  #quality = new Quality(this.#door, (hz) => this.#tell("slow", { hz }));
  #camera = new CameraView(this.#door, this.#robot, new LiveExtent(this.#door));
  #follow = new Follow(this.#door, this.#robot, this.#camera);
  #light = new Light(this.#door);
  #still = new Still(this.#door);
  #picture = new Picture(this.#door);
  #cameras = new CameraPictures(this.#door);
  #theme = new Theme(this.#door, () => this.#camera.distance());
  #looks = new Looks(this.#door, this.#robot, this.#theme);
  #marks = new Marks(this.#door, this.#robot);
  #chain = new ChainLine(this.#door, this.#robot);
  #guide = new Guide(this.#door, this.#camera);
  #measuring = new Measuring(
    this.#door,
    this.#robot,
    new Aim(this.#door, this.#robot, () => this.#camera.distance()),
  );
  #pointer = new Pointer(
    this.#door,
    this.#robot,
    this.#looks,
    this.#camera,
    this.#measuring,
    (type, detail) => this.#tell(type, detail),
  );

  constructor() {
    /** Settles when the scene can be drawn. @type {Promise<void>} */
    this.ready = this.#door.ready.then(() => undefined);
    new Live(this.#door);
    new CloudDetail(this.#door, (oneIn) => this.#tell("detail", { oneIn }));
    new Removed(this.#door);
    this.#door.onConnection((connected) => this.#tell("connection", { connected }));
    forwardKeys(
      (detail) => !this.#endsDrag(detail) && this.#tell("key", detail),
      (event) => this.#keyByDefault(event),
    );
  }

  get connected() {
    return this.#door.connected;
  }

  /** The robot's tree: which joint moves which link. @param {RobotState} state */
  setRobot(state) {
    this.#robot.set(state);
  }

  /** Where the joints are, rad or m. @param {Record<string, number>} positions */
  setPositions(positions) {
    for (const [joint, value] of Object.entries(positions)) this.#robot.positions.set(joint, value);
  }

  fit() {
    this.#camera.fit();
  }

  /** @param {"front" | "back" | "left" | "right" | "top" | "bottom" | "iso"} name */
  view(name) {
    this.#camera.view(name);
  }

  /** @param {string} link */
  focus(link) {
    this.#camera.focus(link);
  }

  /** Let the camera go with a frame. @param {string} frame empty: with none */
  setTarget(frame) {
    this.#follow.set(frame);
  }

  /** Whether this browser draws lightly, by software, and with what. */
  graphics() {
    return this.#quality.state();
  }

  /** Draw lightly from now on. */
  lighten() {
    this.#quality.lighten();
    this.#theme.set(this.#theme.name);
  }

  reload() {
    location.reload();
  }

  getCamera() {
    return this.#camera.get();
  }

  /** @param {CameraPose} pose @param {boolean} [animate] */
  setCamera(pose, animate) {
    this.#camera.set(pose, animate);
  }

  /** Where the mouse points on the robot, in the root frame; null: at nothing. */
  pointedPlace() {
    const { point } = this.#pointer;
    return point && this.#camera.inRoot(point);
  }

  /** A mark at what somebody else points at. @param {readonly [number, number, number] | null} place in the root frame */
  setGuide(place) {
    this.#guide.set(place);
  }

  /** A PNG of the view. @param {number} scale @param {boolean} transparent */
  picture(scale, transparent) {
    return this.#picture.take(scale, transparent);
  }

  /** Draw what a camera of the robot sees onto a canvas of the page; `leave` ends it.
   * @param {import("./camera-pictures.js").Sight} sight */
  showCamera(sight) {
    return this.#cameras.show(sight);
  }

  /** @param {"dark" | "light"} name */
  setTheme(name) {
    this.#theme.set(name);
  }

  /** @param {"rviz" | "trackpad"} mode */
  setMouse(mode) {
    this.#camera.setMouse(mode);
  }

  /** Whether links may be dragged here. @param {boolean} can */
  setCanDrag(can) {
    this.#pointer.canDrag = can;
  }

  /** Of the value at the cursor. @param {"deg" | "rad"} unit */
  setAngleUnit(unit) {
    this.#pointer.angleUnit = unit;
  }

  /** In this browser only. @param {string} link @param {boolean} visible */
  setLinkVisible(link, visible) {
    this.#looks.setVisible(link, visible);
  }

  /** In this browser only. @param {string} link @param {number} opacity */
  setLinkOpacity(link, opacity) {
    this.#looks.setOpacity(link, opacity);
  }

  /** @param {string | null} link */
  setHover(link) {
    this.#looks.setHovered(link);
  }

  /** @param {string | null} link */
  setSelection(link) {
    this.#looks.setSelected(link);
  }

  /** The axis of a joint is seen, over everything. @param {JointView | null} joint */
  setAxis(joint) {
    this.#marks.setAxis(joint);
  }

  /** These frames are seen, over everything: of links, and others that are followed.
   * @param {readonly string[]} links @param {readonly string[]} others */
  setFrames(links, others) {
    this.#marks.setFrames(links, others);
  }

  /** A line leads from each of these frames to the next. @param {readonly string[]} frames */
  setChain(frames) {
    this.#chain.set(frames);
  }

  /** What a property shapes: links that look otherwise for it, and links that only sit elsewhere.
   * @param {readonly string[]} changed @param {readonly string[]} moved */
  setLit(changed, moved) {
    this.#looks.setLit(changed, moved);
  }

  /** Aim at what is measured; null: nothing is. @param {import("./measuring.js").AimMode | null} mode */
  setMeasuring(mode) {
    this.#measuring.setMode(mode);
  }

  /** What was measured, and the label of each. @param {readonly import("./measuring.js").DrawnMeasure[]} measures */
  setMeasures(measures) {
    this.#measuring.setMeasures(measures);
  }

  /** The robot's centre of mass in the root frame, m; null: it is not shown.
   * @param {import("./measuring.js").Centre | null} centre */
  setCentre(centre) {
    this.#measuring.setCentre(centre);
  }

  /** The link at a place of this window, or null. @param {number} x @param {number} y */
  linkAt(x, y) {
    return pick(this.#door, this.#robot, x, y)?.link ?? null;
  }

  /** Whether nobody prevented it. @param {string} type @param {object} detail */
  #tell(type, detail) {
    return this.events.dispatchEvent(new CustomEvent(type, { detail, cancelable: true }));
  }

  /** While a link is dragged, Escape means that and nothing else. @param {{ key: string }} stroke */
  #endsDrag({ key }) {
    if (key !== "Escape" || !this.#pointer.dragging) return false;
    this.#pointer.cancel();
    return true;
  }

  /** @param {KeyboardEvent} event */
  #keyByDefault({ key, ctrlKey, metaKey, altKey }) {
    if (key.toLowerCase() === "f" && !ctrlKey && !metaKey && !altKey) this.fit();
  }
}

window.studio3d = new Studio3d();

/** Keys that viser may have for itself: they turn the camera. */
const VISERS = new Set(["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"]);
/** With Ctrl or Cmd: what the browser would do with these is never meant here. */
const OURS = new Set(["s", "z", "y", "k", "o", "m", "f", "enter", ..."123456789"]);

/**
 * Hand every key to the page around us, as if it had been pressed there.
 * @param {(detail: { key: string, [field: string]: unknown }) => boolean} tell Answers whether nobody prevented what we do by default.
 * @param {(event: KeyboardEvent) => void} byDefault
 */
function forwardKeys(tell, byDefault) {
  const forward = (/** @type {KeyboardEvent} */ event) => {
    if (VISERS.has(event.key) && !withModifier(event)) return;
    event.stopImmediatePropagation();
    if (event.type !== "keydown") return;
    const { key, code, ctrlKey, metaKey, shiftKey, altKey, repeat } = event;
    if (isOurs(event)) event.preventDefault();
    if (tell({ key, code, ctrlKey, metaKey, shiftKey, altKey, repeat })) byDefault(event);
  };
  window.addEventListener("keydown", forward, { capture: true });
  window.addEventListener("keyup", forward, { capture: true });
}

/** @param {KeyboardEvent} event */
function withModifier(event) {
  return event.ctrlKey || event.metaKey || event.altKey;
}

/** @param {KeyboardEvent} event */
function isOurs({ key, ctrlKey, metaKey }) {
  return key === "F6" || key === "F1" || ((ctrlKey || metaKey) && OURS.has(key.toLowerCase()));
}
