/** @import { Value, Values } from "../lib/view-poses.js" */
/** @import { CameraPose, JointView, RobotState } from "./viser.d.ts" */

import { Aim, Measuring } from "./measuring.js";
import { CameraPictures } from "./camera-pictures.js";
import { CameraView } from "./camera.js";
import { ChainLine, Guide, Marks } from "./marks.js";
import { CloudDetail } from "./cloud-detail.js";
import { Door, Removed } from "./door.js";
import { FrameRate } from "./frame-rate.js";
import { Hands } from "./hands.js";
import { inFixedFrame } from "./ground.js";
import { LiveExtent } from "./extent.js";
import { Light, Theme } from "./theme.js";
import { Live } from "./live.js";
import { Looks } from "./link-appearance.js";
import { MarkerHandles } from "./tools/marker-handles.js";
import { MarkerScene } from "./marker-scene.js";
import { FocusCamera } from "./tools/focus.js";
import { Interact } from "./tools/interact.js";
import { Measure } from "./tools/measure.js";
import { Outlines } from "./outlines.js";
import { pick } from "./picking.js";
import { Picture } from "./picture.js";
import { Pointer } from "./pointer.js";
import { Quality, Still } from "./quality.js";
import { PoseOnGround } from "./tools/pose.js";
import { Select } from "./tools/select.js";
import { RobotView } from "./robot.js";
import { FIRST } from "../lib/view-poses.js";
import { SurfacePoint } from "./tools/point.js";
import { Surfaces } from "./surface.js";
import { Tool } from "./tools/tool.js";
import { Units } from "./tools/units.js";

/**
 * The 3D view as the page around it uses it: `iframe.contentWindow.studio3d`.
 *
 * Events on `events`, all with a `detail`: `hover {link}`, `select {link}` (null: empty space),
 * `marker`, `marker_menu`, `marker_hover`, `marker_denied` (see MarkerHandles), `touch {}` (a hand is on the camera), `view {kind, values, byHand}` (it is another, or has other values),
 * `turned {turn}` (of the camera), `focus {link}` (null: of no link), `measure {anchor}`, `pose
 * {x, y, yaw}` and `point {point, what}` (pointed at with a tool, in the fixed frame), `picked {nodes,
 * links, how, left_out}` and `select_nothing {}` (of the tool Select), `drag {joint, value, phase, x,
 * y}`, `connection {connected}`, and `key {key, code,
 * ctrlKey, metaKey, shiftKey, altKey, repeat}`, which may be prevented.
 */
class Studio3d {
  events = new EventTarget();
  #door = new Door();
  #robot = new RobotView(this.#door);
  #rate = new FrameRate(window);
  #quality = new Quality(this.#door, (hz) => this.#tell("slow", { hz }));
  #camera = new CameraView(this.#door, this.#robot, new LiveExtent(this.#door), (type, detail) =>
    this.#tell(type, detail),
  );
  #light = new Light(this.#door);
  #still = new Still(this.#door);
  #picture = new Picture(this.#door);
  /** @type {CameraPictures} */
  #cameras;
  #theme = new Theme(this.#door, () => this.#camera.distance());
  #looks = new Looks(this.#door, this.#robot, this.#theme);
  #marks = new Marks(this.#door, this.#robot);
  #chain = new ChainLine(this.#door, this.#robot);
  #guide = new Guide(this.#door);
  #measuring = new Measuring(
    this.#door,
    this.#robot,
    new Aim(this.#door, this.#robot, () => this.#camera.distance()),
  );
  #units = new Units();
  /** @type {(type: string, detail: object) => void} */
  #tellPage = (type, detail) => void this.#tell(type, detail);
  #detail = new CloudDetail(this.#door, (oneIn) => this.#tell("detail", { oneIn }));
  #outlines = new Outlines(this.#door);
  #markers = new MarkerHandles(
    this.#door,
    new MarkerScene(this.#door, (x, y) => pick(this.#door, this.#robot, x, y)?.point ?? null),
    this.#tellPage,
  );
  #interact = new Interact(
    this.#door,
    this.#robot,
    this.#looks,
    this.#camera,
    this.#units,
    this.#tellPage,
  );
  #surfaces = new Surfaces(this.#door, this.#robot);
  #pose = new PoseOnGround(this.#door, this.#units, this.#tellPage);
  #point = new SurfacePoint(this.#door, this.#surfaces, this.#units, this.#tellPage);
  /** By RViz's class without its package. @type {Record<string, Tool>} */
  #tools = {
    Interact: this.#interact,
    // Every press is the camera's; nothing is selected or dragged.
    MoveCamera: new Tool(),
    FocusCamera: new FocusCamera(this.#door, this.#surfaces, this.#camera, this.#tellPage),
    Select: new Select(this.#door, this.#robot, this.#detail, this.#tellPage),
    Measure: new Measure(this.#measuring, this.#tellPage),
    SetInitialPose: this.#pose,
    SetGoal: this.#pose,
    PublishPoint: this.#point,
  };
  #pointer = new Pointer(
    this.#door,
    this.#robot,
    [...new Set(Object.values(this.#tools))],
    () => {
      this.#camera.touched();
      this.touch();
    },
  );

  /** After the pointer, which may take a press for itself. */
  #hands = new Hands(this.#door, this.#camera);

  constructor() {
    /** Settles when the scene can be drawn. @type {Promise<void>} */
    this.ready = this.#door.ready.then(() => undefined);
    this.#interact.handles.push(this.#markers);
    this.#cameras = new CameraPictures(this.#door, new Live(this.#door));
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

  /** Let the camera go with a frame, with it in the middle. @param {string} frame empty: with none */
  follow(frame) {
    this.#camera.follow(frame);
  }

  /** The view as it is now, by RViz's names. @returns {{kind: string, values: Values}} */
  getView() {
    const { kind, values } = this.#camera.current;
    return { kind, values };
  }

  /** @param {{kind: string, values: Values}} view @param {boolean} [animate] */
  useView(view, animate) {
    this.#camera.use(view, animate);
  }

  /** Another kind of view, which shows the same. @param {string} kind */
  setViewKind(kind) {
    this.#camera.setKind(kind);
  }

  /** @param {string} name @param {Value} value */
  setViewValue(name, value) {
    this.#camera.setValue(name, value);
  }

  /** What the values of a view are at first, by its kind. */
  firstValues() {
    return FIRST;
  }

  /** A hand is on the camera, or on what moves it from outside of the picture. */
  touch() {
    this.#tell("touch", {});
  }

  /** RViz's Zero of the view. */
  zero() {
    this.#camera.zero();
  }

  /** Show the same point from another side. @param {readonly [number, number, number]} direction */
  seeFrom(direction) {
    this.#camera.seeFrom(direction);
  }

  /** Turn the view as a drag of the mouse does. @param {number} dx px @param {number} dy px */
  turnBy(dx, dy) {
    this.#camera.drag("turn", dx, dy);
  }

  /** How the camera is turned. @returns {readonly [number, number, number, number]} x, y, z, w */
  getTurn() {
    return this.#camera.turn;
  }

  /** Whether the mouse is over the picture. */
  isPointing() {
    return this.#pointer.place !== null;
  }

  /** Turn to what is under the mouse; whether anything is. */
  lookAtPointed() {
    const { place } = this.#pointer;
    const found = place && this.#surfaces.at(place.x, place.y);
    // A line of the floor is nothing to look at.
    const point = found && (found.link ?? found.display) !== null ? found.point : null;
    if (point) this.#camera.lookAt(point);
    return point !== null;
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
    return point && inFixedFrame(this.#door, point);
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

  /** What is behind the scene. @param {string} colour as `#rrggbb`; empty: that of the theme */
  setBackground(colour) {
    this.#theme.setBackground(colour);
  }

  /** @param {number} hz pictures per second at most; 0: as many as there can be */
  setFrameRate(hz) {
    this.#rate.set(hz);
    this.#quality.setLimit(hz);
  }

  /** @param {"rviz" | "trackpad"} mode */
  setMouse(mode) {
    this.#hands.mouse = mode;
  }

  /** Whether links may be dragged here. @param {boolean} can */
  setCanDrag(can) {
    this.#interact.canDrag = can;
  }

  /** Of the numbers at the mouse. @param {"deg" | "rad"} angles @param {"m" | "mm"} lengths */
  setUnits(angles, lengths) {
    Object.assign(this.#units, { angles, lengths });
  }

  /** What is set of the tools of a kind. @param {string} kind @param {Tool["values"]} values by RViz's names */
  setToolProperties(kind, values) {
    const tool = this.#tools[kind];
    if (tool) tool.values = values;
    this.#door.redraw();
  }

  /** What things are called at the mouse. @param {import("./tools/point.js").SurfacePoint["words"]} words */
  setWords(words) {
    this.#point.words = words;
  }

  /** Give up what is under way with the tool in hand. @returns {boolean} whether anything was */
  cancelTool() {
    return this.#pointer.cancel() || this.#endsSelection();
  }

  /** Take a tool in hand. @param {string} kind as RViz names its class; one that is not known: Interact */
  setTool(kind) {
    this.#pointer.hold(this.#tools[kind] ?? this.#interact);
  }

  /** Boxes are drawn around these. @param {readonly import("./outlines.js").Outlined[]} items */
  setOutlines(items) {
    this.#outlines.set(items);
  }

  /** Bring what is outlined to the middle. */
  focusOutlines() {
    this.#camera.focusOn(this.#outlines.corners());
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

  /** Interactive markers, and what can be done with them. @param {readonly import("./marker-scene.js").Markers[]} displays */
  setMarkers(displays) {
    this.#markers.set(displays);
  }

  /** Whether this person may move them. @param {boolean} may */
  setMayMoveMarkers(may) {
    this.#markers.setMay(may);
  }

  /** The studio refused what was done to a marker. @param {string} display @param {number} marker */
  dropMarker(display, marker) {
    this.#markers.refused(display, marker);
  }

  /** The studio has heard of the release of a marker. @param {string} display @param {number} marker */
  settleMarker(display, marker) {
    this.#markers.settle(display, marker);
  }

  /** Open the menu of the marker that the mouse is over; whether there is one. */
  openMarkerMenu() {
    return this.#markers.menuHere();
  }

  /** The link at a place of this window, or null. @param {number} x @param {number} y */
  linkAt(x, y) {
    return pick(this.#door, this.#robot, x, y)?.link ?? null;
  }

  /** Whether nobody prevented it. @param {string} type @param {object} detail */
  #tell(type, detail) {
    return this.events.dispatchEvent(new CustomEvent(type, { detail, cancelable: true }));
  }

  /** While something is dragged, Escape means that and nothing else. @param {{ key: string }} stroke */
  #endsDrag({ key }) {
    if (key !== "Escape") return false;
    return this.#pointer.cancel() || this.#endsSelection();
  }

  /** With the tool Select in hand Escape empties the selection, if there is one. */
  #endsSelection() {
    if (this.#pointer.tool !== this.#tools.Select || this.#outlines.count === 0) return false;
    this.#tell("select_nothing", {});
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
