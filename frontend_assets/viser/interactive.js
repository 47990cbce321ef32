/** @import { Door } from "./door.js" */
/** @import { Pose, Sight, Turn, Vector } from "./handle-drag.js" */
/** @import { Hit, Material, Matrix4, Message, Object3D, Pointing, Vector3 } from "./viser.d.ts" */

import {
  after,
  back,
  composed,
  facing,
  HandleDrag,
  isDragged,
  Mode,
  plus,
  times,
  turned,
  FIXED,
  VIEW_FACING,
} from "./handle-drag.js";
import { rayThrough } from "./picking.js";
import { DrawnLines, placeOf } from "./screen.js";

/** @typedef {{ number: number, mode: number, facing: number, wxyz: Turn, independent: boolean, always_visible: boolean, description: string }} Control */
/** @typedef {{ number: number, name: string, description: string, scale: number, controls: Control[], menu: readonly { id: number }[] }} Marker */
/** @typedef {{ display: string, visual_aids: boolean, markers: Marker[] }} Markers of one display */
/** A marker and where its groups are in the scene. @typedef {{ key: string, root: string, display: string, aids: boolean, marker: Marker }} Known */
/** What the mouse is over; `control` null: the title. @typedef {{ known: Known, control: Control | null, node: string, distance: number, point: Vector3 }} Handle */
/** @typedef {{ pose: Pose, rads: Map<number, number>, until: number }} Own where this browser has a marker; `until`: ms, when the studio's word counts again */

/** `/live/<display>/m<marker>`, then `-<part>`, then the shape: `c<control>-...`. */
const NAME = /^(\/live\/[^/]+\/m\d+)(?:-([a-z]+\d*))?(?:\/(?:c(\d+)-)?.*)?$/;
const HOVER = 0.3;
const ACTIVE = 0.5;
const STILL_PX = 4;
const LONG_PRESS_MS = 500;
/** After the release, until the studio has heard of it. */
const PATIENCE_MS = 1500;
const SETTLE_MS = 150;
const NEAR = { Points: { threshold: 0.02 }, Line: { threshold: 0.02 }, Line2: { threshold: 6 } };
const WHEEL_PX = 100;

/**
 * Interactive markers under the mouse: which control it is over, drags, clicks and menus. What is
 * dragged moves in this browser at once, and the page tells the studio. Controls that face the eye are
 * turned here, in each picture.
 *
 * It listens before `Pointer` does, and keeps from it and from viser what is meant for a control.
 * Tells `marker {display, marker, control, action, ...}`, `marker_menu {..., x, y}` and `marker_hover`.
 */
export class Interactive {
  /** @type {Map<string, Known>} */
  #known = new Map();
  /** Nodes of shapes, by the root of their marker. @type {Map<string, Map<string, number | null>>} */
  #shapes = new Map();
  /** @type {Map<string, Own>} */
  #own = new Map();
  /** @type {{ id: number, x: number, y: number, handle: Handle, drag: HandleDrag | null, moved: boolean, menu: boolean, timer: number, start: Pose } | null} */
  #press = null;
  /** @type {Handle | null} */
  #over = null;
  /** @type {{ x: number, y: number, shift: boolean, ctrl: boolean } | null} */
  #newest = null;
  #looks = false;
  #on = true;
  #may = false;
  /** @type {WeakMap<Material, Material>} */
  #twins = new WeakMap();
  /** @type {[Object3D, Material | Material[]][]} */
  #exchanged = [];
  #lines = new DrawnLines();
  #door;
  #isBusy;
  #distanceOfRobot;
  #tell;

  /** @param {Door} door @param {() => boolean} isBusy something else has the mouse, as measuring
   * @param {(x: number, y: number) => Vector3 | null} robotAt what of the robot is there
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, isBusy, robotAt, tell) {
    this.#door = door;
    this.#isBusy = isBusy;
    this.#distanceOfRobot = robotAt;
    this.#tell = tell;
    door.onMessage((message) => this.#read(message));
    door.onPicture(
      () => this.#dress(),
      () => this.#undress(),
    );
    this.#listen();
  }

  /** What can be done with which markers. @param {readonly Markers[]} displays */
  set(displays) {
    this.#known.clear();
    for (const { display, visual_aids: aids, markers } of displays)
      for (const marker of markers) {
        const root = `/live/${display}/m${marker.number}`;
        this.#known.set(root, { key: root, root, display, aids, marker });
      }
    for (const root of this.#own.keys()) if (!this.#known.has(root)) this.#own.delete(root);
    if (this.#press && !this.#known.has(this.#press.handle.known.root)) this.#drop();
    this.#door.redraw();
  }

  /** Whether this person may move them. @param {boolean} may */
  setMay(may) {
    this.#may = may;
    if (!may) this.cancel();
  }

  /** Whether they can be moved with the tool that is chosen; else only what is always visible is seen.
   * @param {boolean} on */
  setOn(on) {
    this.#on = on;
    if (!on) this.cancel();
    this.#hover(null);
    this.#door.redraw();
  }

  get dragging() {
    return this.#press !== null;
  }

  /** Give the pose at the press back. */
  cancel() {
    const press = this.#press;
    if (!press) return;
    const { known } = press.handle;
    if (press.drag) this.#keep(known, press.start, press.handle.control, press.drag.rad);
    this.#end("release", false);
  }

  /** The studio did not take it: its own word counts at once. @param {string} display @param {number} marker */
  drop(display, marker) {
    const root = `/live/${display}/m${marker}`;
    if (this.#press?.handle.known.root === root) this.#drop();
    this.#own.delete(root);
    this.#giveBack(root);
  }

  /** The studio has heard of the release. @param {string} display @param {number} marker */
  settle(display, marker) {
    const own = this.#own.get(`/live/${display}/m${marker}`);
    if (own && this.#press?.handle.known.root !== `/live/${display}/m${marker}`)
      own.until = performance.now() + SETTLE_MS;
    setTimeout(() => this.#door.redraw(), SETTLE_MS + 20);
  }

  /** Open the menu of what the mouse is over; whether there is one. */
  menuHere() {
    const handle = this.#over;
    if (!handle || handle.known.marker.menu.length === 0) return false;
    const place = placeOf(this.#door, handle.point) ?? [0, 0];
    this.#openMenu(handle, place[0], place[1]);
    return true;
  }

  /** @param {Message} message */
  #read({ type, name = "", props }) {
    const found = name.startsWith("/live/") ? NAME.exec(name) : null;
    const root = found?.[1];
    if (!found || !root || !found[2]) return;
    const isShape = name.indexOf("/", root.length) > 0;
    if (!isShape) return;
    const shapes = this.#shapes.get(root) ?? new Map();
    if (type === "RemoveSceneNodeMessage") shapes.delete(name);
    else if (props) shapes.set(name, found[3] === undefined ? null : Number(found[3]));
    if (shapes.size > 0) this.#shapes.set(root, shapes);
    else this.#shapes.delete(root);
  }

  #listen() {
    const options = { capture: true };
    window.addEventListener("pointerdown", (event) => this.#down(event), options);
    window.addEventListener("pointermove", (event) => this.#move(event), options);
    window.addEventListener("pointerup", (event) => this.#up(event), options);
    window.addEventListener("pointercancel", () => this.cancel(), options);
    window.addEventListener("blur", () => this.cancel());
    window.addEventListener("wheel", (event) => this.#wheel(event), { capture: true, passive: false });
    document.addEventListener("pointerleave", () => !this.#press && this.#hover(null));
    window.addEventListener("dblclick", (event) => this.#keepFromOthers(event), options);
  }

  /** @param {MouseEvent} event */
  #keepFromOthers(event) {
    if (this.#over && !event.altKey) event.stopImmediatePropagation();
  }

  get #active() {
    return this.#on && this.#known.size > 0 && !this.#isBusy();
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (this.#press || event.target !== this.#door.mutable?.canvas || !this.#active) return;
    if (event.altKey || event.button === 1) return;
    const handle = this.#pick(event.clientX, event.clientY);
    if (!handle) return;
    const wantsMenu = event.button === 2 && handle.known.marker.menu.length > 0;
    const isHandle = event.button === 0 && (handle.control?.mode ?? Mode.NONE) !== Mode.NONE;
    const isTouched = event.pointerType === "touch" && handle.known.marker.menu.length > 0;
    if (!wantsMenu && !isHandle && !isTouched) return;
    window.focus();
    event.stopImmediatePropagation();
    event.preventDefault();
    if (!this.#may) return void this.#tell("marker_denied", {});
    this.#begin(event, handle, !isHandle);
  }

  /** @param {PointerEvent} event @param {Handle} handle @param {boolean} menu only its menu is meant */
  #begin(event, handle, menu) {
    const { clientX: x, clientY: y, pointerId: id } = event;
    this.#door.mutable?.canvas?.setPointerCapture(id);
    this.#hover(handle);
    const timer =
      event.pointerType === "touch" ? window.setTimeout(() => this.#longPress(), LONG_PRESS_MS) : 0;
    const start = this.#poseOf(handle.known);
    this.#press = { id, x, y, handle, drag: null, moved: false, menu, timer, start };
    if (menu) return undefined;
    const { control } = handle;
    if (control && isDragged(control.mode)) {
      const sight = this.#sightFrom(handle.known);
      const rad = this.#own.get(handle.known.root)?.rads.get(control.number) ?? 0;
      const grab = this.#toReference(handle.known, handle.point);
      this.#press.drag = new HandleDrag(control, sight, start, rad, grab, mouseOf(event));
      this.#keep(handle.known, start, control, rad);
    }
    document.documentElement.dataset.cursor = this.#press.drag ? "grabbing" : "pointer";
    this.#say("press");
    return undefined;
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const press = this.#press;
    if (press) {
      if (event.pointerId !== press.id) return;
      event.stopImmediatePropagation();
      press.moved ||= Math.hypot(event.clientX - press.x, event.clientY - press.y) >= STILL_PX;
      if (press.moved) clearTimeout(press.timer);
      this.#newest = mouseOf(event);
      this.#look();
      return;
    }
    if (event.buttons !== 0 || !this.#active) return;
    // Where the mouse was seen last decides whether others hear of it: they are one event late.
    if (this.#over) event.stopImmediatePropagation();
    this.#newest = mouseOf(event);
    this.#look();
  }

  /** At most once for each picture. */
  #look() {
    if (this.#looks) return;
    this.#looks = true;
    requestAnimationFrame(() => {
      this.#looks = false;
      const mouse = this.#newest;
      this.#newest = null;
      if (!mouse) return;
      if (this.#press) this.#follow(mouse);
      else if (this.#active) this.#hover(this.#pick(mouse.x, mouse.y));
    });
  }

  /** @param {{ x: number, y: number, shift: boolean, ctrl: boolean }} mouse */
  #follow(mouse) {
    const press = this.#press;
    if (!press?.drag?.follow(mouse)) return;
    this.#keep(press.handle.known, press.drag.pose, press.handle.control, press.drag.rad);
    this.#say("move");
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const press = this.#press;
    if (!press || event.pointerId !== press.id) return;
    event.stopImmediatePropagation();
    if (this.#newest) this.#follow(mouseOf(event));
    this.#newest = null;
    const { handle, menu, moved } = press;
    const here = this.#pick(event.clientX, event.clientY);
    const isSame = here?.known.root === handle.known.root && here.control === handle.control;
    if (menu) {
      this.#drop();
      if (event.button === 2 && !moved) this.#openMenu(handle, event.clientX, event.clientY);
      return;
    }
    this.#end("release", isSame);
    if (handle.control?.mode === Mode.MENU && isSame && !moved)
      this.#openMenu(handle, event.clientX, event.clientY);
    this.#hover(event.pointerType === "touch" ? null : here);
  }

  #longPress() {
    const press = this.#press;
    if (!press || press.moved || press.handle.known.marker.menu.length === 0) return;
    const { handle, x, y } = press;
    if (press.menu) this.#drop();
    else this.#end("release", false);
    this.#openMenu(handle, x, y);
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    const press = this.#press;
    if (!press) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    if (!press.drag?.wheel(-event.deltaY / WHEEL_PX)) return;
    this.#keep(press.handle.known, press.drag.pose, press.handle.control, press.drag.rad);
    this.#say("move");
  }

  /** @param {"release"} action @param {boolean} clicked */
  #end(action, clicked) {
    const press = this.#press;
    if (!press) return;
    this.#say(action, clicked);
    const own = this.#own.get(press.handle.known.root);
    if (own) own.until = performance.now() + PATIENCE_MS;
    this.#drop();
  }

  #drop() {
    clearTimeout(this.#press?.timer);
    this.#press = null;
    this.#newest = null;
    this.#hover(null);
    delete document.documentElement.dataset.cursor;
    this.#door.redraw();
  }

  /** @param {"press" | "move" | "release"} action @param {boolean} [clicked] */
  #say(action, clicked = false) {
    const press = this.#press;
    if (!press) return;
    const { known, control, point } = press.handle;
    const { turn, place } = press.drag?.pose ?? press.start;
    this.#tell("marker", {
      display: known.display,
      marker: known.marker.number,
      control: control?.number ?? null,
      action,
      position: place,
      orientation: turn,
      turn_rad: press.drag?.rad ?? 0,
      mouse_point: action === "move" ? null : this.#toReference(known, point),
      clicked,
    });
  }

  /** @param {Handle} handle @param {number} x @param {number} y px of this window */
  #openMenu({ known, control, point }, x, y) {
    const frame = window.frameElement?.getBoundingClientRect();
    this.#tell("marker_menu", {
      display: known.display,
      marker: known.marker.number,
      control: control?.number ?? null,
      mouse_point: this.#toReference(known, point),
      x: x + (frame?.left ?? 0),
      y: y + (frame?.top ?? 0),
    });
  }

  /** @param {Handle | null} handle */
  #hover(handle) {
    const before = this.#over;
    this.#over = handle;
    if (before?.node === handle?.node && (before === null) === (handle === null)) return;
    const control = handle?.control ?? null;
    if (handle || before) {
      const cursor = cursorOf(handle);
      if (cursor) document.documentElement.dataset.cursor = cursor;
      else delete document.documentElement.dataset.cursor;
    }
    const { display = "", marker } = handle?.known ?? {};
    this.#tell("marker_hover", { display, marker: marker?.number ?? null, control: control?.number ?? null });
    this.#door.redraw();
  }

  /** The control that is seen at a place of the window; null: none, or something is before it.
   * @param {number} x @param {number} y @returns {Handle | null} */
  #pick(x, y) {
    const ray = rayThrough(this.#door, x, y);
    const camera = this.#door.mutable?.camera;
    if (!ray || !camera) return null;
    /** @type {Pointing} */
    const pointing = { ray, near: 0, far: Number.POSITIVE_INFINITY, camera, params: NEAR };
    /** @type {Handle | null} */
    let nearest = null;
    for (const known of this.#known.values())
      for (const [node, number] of this.#shapes.get(known.root) ?? []) {
        const control = known.marker.controls.find((one) => one.number === number) ?? null;
        if (!isMeant(known, control)) continue;
        for (const { distance, point } of this.#hits(node, pointing))
          if (!nearest || distance < nearest.distance)
            nearest = { known, control, node, distance, point };
      }
    const found = /** @type {Handle | null} */ (nearest);
    const before = found && this.#distanceOfRobot(x, y);
    if (found && before && before.distanceTo(ray.origin) < found.distance) return null;
    return found;
  }

  /** @param {string} name @param {Pointing} pointing @returns {Hit[]} */
  #hits(name, pointing) {
    /** @type {Hit[]} */
    const hits = [];
    this.#door.node(name)?.traverseVisible((object) => {
      const { geometry } = object;
      if (!geometry) return;
      if (!geometry.boundingBox) geometry.computeBoundingBox();
      object.raycast(pointing, hits);
    });
    return hits;
  }

  /** Where a marker is in its reference frame. @param {Known} known @returns {Pose} */
  #poseOf(known) {
    const own = this.#own.get(known.root);
    if (own) return own.pose;
    return composed(inverse(this.#told(known.root)), this.#told(`${known.root}-body`));
  }

  /** Where the studio has a group, in the fixed frame. @param {string} name @returns {Pose} */
  #told(name) {
    const pose = this.#door.mutable?.nodePoseData[name];
    if (!pose) return { turn: [1, 0, 0, 0], place: [0, 0, 0] };
    return { turn: [...pose.wxyz], place: [...pose.position] };
  }

  /** A marker stays where this browser has it. @param {Known} known @param {Pose} pose @param {Control | null} control @param {number} rad */
  #keep(known, pose, control, rad) {
    const own = this.#own.get(known.root);
    const rads = own?.rads ?? new Map();
    if (control) rads.set(control.number, rad);
    this.#own.set(known.root, { pose, rads, until: Number.POSITIVE_INFINITY });
    this.#door.redraw();
  }

  /** The groups of a marker stand where the studio says. @param {string} root */
  #giveBack(root) {
    for (const name of Object.keys(this.#door.mutable?.nodeRefFromName ?? {}))
      if (name.startsWith(`${root}-`) && name.indexOf("/", root.length) < 0)
        this.#stand(name, this.#told(name));
    this.#door.redraw();
  }

  /** @param {string} name @param {Pose} pose */
  #stand(name, { turn: [w, x, y, z], place }) {
    const node = this.#door.node(name);
    if (!node) return;
    node.quaternion.set(x, y, z, w);
    node.position.set(...place);
    node.updateMatrix();
    node.updateWorldMatrix(false, true);
  }

  /** Before each picture: what faces the eye, what is dragged here, and what lights up. */
  #dress() {
    const now = performance.now();
    for (const known of this.#known.values()) {
      const own = this.#own.get(known.root);
      if (own && now > own.until && this.#press?.handle.known.root !== known.root) {
        this.#own.delete(known.root);
        queueMicrotask(() => this.#giveBack(known.root));
      }
      this.#place(known, this.#own.get(known.root) ?? null);
      this.#show(known);
    }
    const lit = this.#press?.handle ?? this.#over;
    if (lit) this.#light(lit, this.#press ? ACTIVE : HOVER);
    this.#drawAids();
  }

  /** @param {Known} known @param {Own | null} own */
  #place(known, own) {
    const reference = this.#told(known.root);
    if (own) this.#stand(`${known.root}-body`, composed(reference, own.pose));
    const eye = this.#eyeIn(known.root);
    if (!eye) return;
    for (const control of known.marker.controls) {
      if (control.facing === 0) continue;
      const part = `${known.root}-${control.facing === FIXED ? "f" : "v"}${control.number}`;
      const rad = own?.rads.get(control.number) ?? 0;
      const place = own ? composed(reference, own.pose).place : this.#told(part).place;
      if (control.facing === VIEW_FACING && !control.independent)
        this.#stand(part, { turn: facing(control.wxyz, eye, rad), place });
      else if (own && control.facing === VIEW_FACING)
        this.#stand(part, { turn: after(reference.turn, own.pose.turn), place });
      else if (own)
        this.#stand(part, { turn: after(reference.turn, fixedTurn(control, rad)), place });
    }
    const title = `${known.root}-title`;
    const place = own ? composed(reference, own.pose).place : this.#told(title).place;
    this.#stand(title, { turn: facing([1, 0, 0, 0], eye, 0), place });
  }

  /** Hidden while another tool is chosen, unless it is always visible. @param {Known} known */
  #show({ root, marker }) {
    const seen = new Map(marker.controls.map((one) => [one.number, this.#on || one.always_visible]));
    for (const [name, number] of this.#shapes.get(root) ?? []) {
      const node = this.#door.node(name);
      if (node && number !== null) node.visible = seen.get(number) ?? true;
    }
  }

  /** Axes of the camera in the frame that the groups of a marker stand in. @param {string} root */
  #eyeIn(root) {
    const camera = this.#door.mutable?.camera;
    const parent = this.#door.node(root)?.parent;
    if (!camera || !parent) return null;
    return axesOf(camera.matrixWorld, parent.matrixWorld);
  }

  /** What a drag needs of the picture, in the reference frame of a marker as it is then. @param {Known} known @returns {Sight} */
  #sightFrom(known) {
    const matrix = () => this.#door.node(known.root)?.matrixWorld;
    return {
      rayAt: (x, y) => {
        const ray = rayThrough(this.#door, x, y);
        const world = matrix();
        if (!ray || !world) return null;
        const inside = world.clone().invert();
        return {
          origin: triple(ray.origin.applyMatrix4(inside)),
          direction: triple(ray.direction.transformDirection(inside)),
        };
      },
      placeOf: (point) => {
        const world = matrix();
        const vector = this.#door.mutable?.camera?.position.clone();
        return world && vector ? placeOf(this.#door, vector.set(...point).applyMatrix4(world)) : null;
      },
      axes: () => {
        const world = matrix();
        const camera = this.#door.mutable?.camera;
        if (!world || !camera) return { forward: [1, 0, 0], up: [0, 0, 1], right: [0, -1, 0] };
        return axesOf(camera.matrixWorld, world);
      },
    };
  }

  /** @param {Known} known @param {Vector3} point in the scene @returns {Vector | null} */
  #toReference(known, point) {
    const world = this.#door.node(known.root)?.matrixWorld;
    return world ? triple(point.clone().applyMatrix4(world.clone().invert())) : null;
  }

  /** A control lights up in this picture. @param {Handle} handle @param {number} strength */
  #light({ known, control }, strength) {
    for (const [name, number] of this.#shapes.get(known.root) ?? []) {
      if (number !== (control?.number ?? null)) continue;
      this.#door.node(name)?.traverse((object) => {
        if (!object.material) return;
        this.#exchanged.push([object, object.material]);
        object.material = Array.isArray(object.material)
          ? object.material.map((one) => this.#brighter(one, strength))
          : this.#brighter(object.material, strength);
      });
    }
  }

  #undress() {
    for (const [object, material] of this.#exchanged) object.material = material;
    this.#exchanged = [];
  }

  /** @param {Material} material @param {number} strength */
  #brighter(material, strength) {
    if (!material.emissive && !material.color) return material;
    let twin = this.#twins.get(material);
    if (!twin) {
      const made = material.clone();
      material.addEventListener("dispose", () => made.dispose());
      this.#twins.set(material, made);
      twin = made;
    }
    twin.copy(material);
    if (twin.emissive) {
      twin.emissive.set(0xffffff);
      twin.emissiveIntensity = strength;
    } else if (twin.color) twin.color.lerp(twin.color.clone().set(0xffffff), strength);
    return twin;
  }

  /** The axis along or about which something is moved. */
  #drawAids() {
    const press = this.#press;
    const known = press?.handle.known;
    const control = press?.handle.control;
    const isShown = known?.aids && control && control.facing !== VIEW_FACING && HAS_AXIS.has(control.mode);
    const places = isShown && press.drag ? this.#axisOf(known, press.drag) : [];
    const lines = places.length > 1 ? [{ places, kind: /** @type {const} */ ("axis") }] : [];
    this.#lines.draw({ lines, dots: [], labels: [] });
  }

  /** @param {Known} known @param {HandleDrag} drag @returns {import("./screen.js").Place[]} */
  #axisOf(known, { line: { point, along } }) {
    const sight = this.#sightFrom(known);
    const reach = 20 * known.marker.scale;
    const ends = [-1, -0.1, 0, 0.1, 1].map((share) =>
      sight.placeOf(plus(point, times(along, share * reach))),
    );
    return ends.filter((place) => place !== null);
  }
}

const HAS_AXIS = new Set(/** @type {number[]} */ ([Mode.MOVE_AXIS, Mode.ROTATE_AXIS, Mode.MOVE_ROTATE]));

/** @param {MouseEvent} event */
const mouseOf = ({ clientX: x, clientY: y, shiftKey: shift, ctrlKey, metaKey }) => ({
  x,
  y,
  shift,
  ctrl: ctrlKey || metaKey,
});

/** @param {Known} known @param {Control | null} control whether anything can be done there */
const isMeant = ({ marker }, control) =>
  (control !== null && control.mode !== Mode.NONE) || marker.menu.length > 0;

/** @param {Handle | null} handle */
function cursorOf(handle) {
  if (!handle) return "";
  const mode = handle.control?.mode ?? Mode.NONE;
  if (isDragged(mode)) return "grab";
  return mode === Mode.NONE ? "context-menu" : "pointer";
}

/** @param {Control} control @param {number} rad @returns {Turn} */
function fixedTurn({ wxyz }, rad) {
  const [x, y, z] = times(turned(wxyz, [1, 0, 0]), Math.sin(rad / 2));
  return [Math.cos(rad / 2), x, y, z];
}

/** @param {Pose} pose @returns {Pose} */
function inverse({ turn, place }) {
  const there = back(turn);
  return { turn: there, place: times(turned(there, place), -1) };
}

/** Axes of the camera in another frame, each of length 1. @param {Matrix4} camera @param {Matrix4} frame
 * @returns {{ forward: Vector, up: Vector, right: Vector }} */
function axesOf(camera, frame) {
  const inside = frame.clone().invert().multiply(camera).elements;
  const column = (/** @type {number} */ at) => {
    const [x = 0, y = 0, z = 0] = inside.slice(4 * at, 4 * at + 3);
    const size = Math.hypot(x, y, z) || 1;
    return /** @type {Vector} */ ([x / size, y / size, z / size]);
  };
  return { forward: times(column(2), -1), up: column(1), right: column(0) };
}

/** @param {Vector3} vector @returns {Vector} */
const triple = ({ x, y, z }) => [x, y, z];
