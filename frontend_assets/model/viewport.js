/**
 * The 3D view inside its frame: what the page tells it (robot, positions, theme, hover, ...),
 * what it tells the page (picked links, dragged joints, keys), and the frames that the studio
 * keeps for it in the scene. It is on the page's origin, so both call each other directly.
 */

/** @import { JointView, MarkersOfDisplay, RobotState } from "../types/wire.d.ts" */
/** @import { Value, Values } from "../lib/view-poses.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { isStroke, onKey } from "../lib/commands.js";
import { isKind, targetOf } from "../lib/view-poses.js";
import { connection, documentId } from "./connection.js";
import { movable, position, robot } from "./document.js";
import { attachMarkers } from "./interactive-markers.js";
import { background, frameRate } from "./live-displays.js";
import { lights } from "./origin.js";
import { moveJoint } from "./requests.js";
import { mayMove } from "./ros.js";
import { followSelection, outlined, selectNothing, takePicked } from "./selected-items.js";
import {
  hiddenLinks,
  hovered,
  linkOpacity,
  selected,
  selectedJoint,
  selectLink,
} from "./selection.js";
import { comparedFrames, drawnChain, followedFrames, litChain, millimetres } from "./tf.js";
import { degrees, mouseMode, theme } from "./view.js";
import { send } from "./wire.js";

/** The studio forgets who does not ask again. */
const EVERY_MS = 2000;

/**
 * Keep frames in the scene.
 *
 * @param {() => readonly string[]} wanted is called anew when what it reads changes
 * @param {(frame: string, trouble: string) => void} [said] is told why one is not there; empty: it is
 * @returns {() => void} the end of it
 */
function keepInScene(wanted, said = () => {}) {
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let timer;
  const end = effect(() => {
    clearInterval(timer);
    const frames = wanted().filter((frame) => !isLink(frame));
    if (frames.length === 0 || connection.value !== "connected") return;
    const ask = () => {
      for (const frame of frames) askFor(frame).then((trouble) => said(frame, trouble));
    };
    untracked(ask);
    timer = setInterval(() => document.hidden || ask(), EVERY_MS);
  });
  return () => {
    clearInterval(timer);
    end();
  };
}

/** @param {string} frame */
const isLink = (frame) => robot.value?.links.some(({ name }) => name === frame) ?? false;

/** @param {string} frame */
function askFor(frame) {
  return send({ type: "follow_frame", frame }).then(
    (answer) => (answer.type === "frame_followed" ? answer.trouble : ""),
    (/** @type {Error} */ error) => error.message,
  );
}

/**
 * Something that is measured, kept in the frame of its link so that it moves along: a point of a
 * surface with its normal, the frame of a link, or the axis of a joint, which is at rest in its child.
 *
 * @typedef {{kind: "point", link: string, at: readonly [number, number, number], normal: readonly [number, number, number] | null} | {kind: "frame", link: string} | {kind: "axis", link: string, joint: string}} Anchor
 */
/** @typedef {{light: boolean, software: boolean, renderer: string}} Graphics */
/** A view of the camera, by RViz's name of its class and of its properties. @typedef {{kind: string, values: Values}} ShownView */
/** @typedef {readonly [number, number, number]} Triple */

/**
 * @typedef {object} CameraPose in the root frame, m
 * @property {Triple} position
 * @property {Triple} target
 * @property {Triple} [up] where the top of the picture points
 * @property {boolean} [flat] without perspective
 * @property {number} [field] its opening angle from below to above, rad
 */

/**
 * @typedef {object} Studio3d what the script in the frame offers
 * @property {Promise<unknown>} ready
 * @property {EventTarget} events `hover`, `select`, `drag`, `connection`, `key`, `touch` (a hand is on the camera), `view`, `turned`
 * @property {(robot: RobotState) => void} setRobot
 * @property {(positions: Record<string, number>) => void} setPositions
 * @property {() => void} fit
 * @property {(name: string) => void} view
 * @property {(link: string) => void} focus
 * @property {() => Required<CameraPose> | null} getCamera
 * @property {(pose: CameraPose, animate?: boolean) => void} setCamera
 * @property {() => ShownView} getView
 * @property {(view: ShownView, animate?: boolean) => void} useView
 * @property {(kind: string) => void} setViewKind another, which shows the same
 * @property {(name: string, value: Value) => void} setViewValue
 * @property {() => void} touch a hand is on the camera: `touch` is told
 * @property {() => void} zero RViz's Zero of the view
 * @property {(direction: Triple) => void} seeFrom the same point from another side
 * @property {(dx: number, dy: number) => void} turnBy as a drag of so many px
 * @property {() => readonly [number, number, number, number]} getTurn of the camera: x, y, z, w
 * @property {() => boolean} isPointing the mouse is over the picture
 * @property {() => boolean} lookAtPointed turn to what is under it; whether anything is
 * @property {() => [number, number, number] | null} pointedPlace where the mouse points on the robot, in the root frame
 * @property {(place: readonly [number, number, number] | null) => void} setGuide a mark at what somebody else points at
 * @property {(frame: string) => void} follow the camera goes with a frame, with it in the middle; empty: with none
 * @property {(scale: number, transparent: boolean) => Promise<Blob | null>} picture a PNG; null: too large
 * @property {(sight: {display: string, canvas: HTMLCanvasElement, told: (seen: boolean) => void}) => {renew: () => void, leave: () => void}} showCamera draw what a camera of the robot sees
 * @property {(theme: "dark" | "light") => void} setTheme
 * @property {(mode: "rviz" | "trackpad") => void} setMouse
 * @property {(colour: string) => void} setBackground empty: that of the theme
 * @property {(hz: number) => void} setFrameRate pictures per second at most; 0: no limit
 * @property {(link: string, visible: boolean) => void} setLinkVisible
 * @property {(link: string, opacity: number) => void} setLinkOpacity
 * @property {(link: string | null) => void} setHover
 * @property {(link: string | null) => void} setSelection
 * @property {(joint: JointView | null) => void} setAxis of the selected joint
 * @property {(links: readonly string[], others: readonly string[]) => void} setFrames that are compared
 * @property {(frames: readonly string[]) => void} setChain a line leads from one to the next
 * @property {(changed: readonly string[], moved: readonly string[]) => void} setLit what a property shapes
 * @property {(can: boolean) => void} setCanDrag
 * @property {(items: readonly {display: string, path: string, shape: string, box: readonly number[] | null}[]) => void} setOutlines boxes around what is selected
 * @property {() => void} focusOutlines bring it to the middle
 * @property {(angles: "deg" | "rad", lengths: "m" | "mm") => void} setUnits of the numbers at the mouse
 * @property {(kind: string) => void} setTool take a tool in hand, by RViz's class without its package
 * @property {(kind: string, values: Record<string, boolean | number | string>) => void} setToolProperties by RViz's names
 * @property {() => boolean} cancelTool give up what is under way; whether anything was
 * @property {(words: {displays: Record<string, string>, floor: string, nothing: string}) => void} setWords what things are called at the mouse
 * @property {(mode: "all" | "points" | "frames" | "axes" | null) => void} setMeasuring what a click aims at
 * @property {(measures: readonly {ends: readonly Anchor[], label: string}[]) => void} setMeasures
 * @property {(centre: {at: readonly [number, number, number], label: string} | null) => void} setCentre of mass, root frame
 * @property {(displays: readonly MarkersOfDisplay[]) => void} setMarkers interactive ones, and what can be done with them
 * @property {(may: boolean) => void} setMayMoveMarkers
 * @property {(display: string, marker: number) => void} dropMarker what was done to it counts no more
 * @property {(display: string, marker: number) => void} settleMarker the studio has heard of its release
 * @property {() => boolean} openMarkerMenu of what the mouse is over; whether there is one
 * @property {() => Graphics} graphics
 * @property {() => void} lighten draw lightly from now on
 * @property {() => void} reload make the view anew
 * @property {boolean} connected
 */

export const VIEWS = /** @type {const} */ ([
  "iso",
  "front",
  "back",
  "left",
  "right",
  "top",
  "bottom",
]);

/** @type {import("vendor/preact.js").Signal<Studio3d | null>} */
export const viewport = signal(null);
/** The 3D view has its own connection; false until it stands. */
export const viewportConnected = signal(false);

const LOOK_AGAIN_MS = 50;

/** @param {HTMLIFrameElement} frame @returns {() => void} the end of it */
export function attachViewport(frame) {
  /** @type {(() => void)[]} */
  let ends = [];
  let turn = 0;
  const end = () => {
    turn += 1;
    for (const one of ends) one();
    ends = [];
    viewport.value = null;
    viewportConnected.value = false;
  };
  const begin = async () => {
    end();
    const mine = turn;
    const found = await studio3dOf(frame);
    if (!found || mine !== turn) return;
    viewport.value = found;
    viewportConnected.value = found.connected;
    const stop = new AbortController();
    const markers = attachMarkers(found, stop.signal);
    ends = [...tell(found), listen(found), ...markers, () => stop.abort()];
    showAgain(found);
  };
  frame.addEventListener("load", begin);
  // The frame may have been loaded before anybody listened.
  begin();
  return () => {
    frame.removeEventListener("load", begin);
    end();
  };
}

/** @param {HTMLIFrameElement} frame @returns {Promise<Studio3d | null>} null when the frame moved on */
async function studio3dOf(frame) {
  const inside = /** @type {(Window & {studio3d?: Studio3d}) | null} */ (frame.contentWindow);
  const page = frame.contentDocument;
  while (frame.isConnected && frame.contentDocument === page) {
    if (inside?.studio3d) {
      await inside.studio3d.ready;
      return frame.contentDocument === page ? inside.studio3d : null;
    }
    await new Promise((resolve) => setTimeout(resolve, LOOK_AGAIN_MS));
  }
  return null;
}

/** The view that is shown; null: none yet. @type {import("vendor/preact.js").Signal<ShownView | null>} */
export const shownView = signal(null);
/** A hand moved the camera of this page since this was false; flights to a view and fitting do not count. */
export const movedByHand = signal(false);
/** Whose view it was. @type {{view: Studio3d | null, document: string}} */
let last = { view: null, document: "" };

/** One that was loaded anew shows what the one before it showed. @param {Studio3d} found */
function showAgain(found) {
  const document = documentId.peek();
  const shown = shownView.peek();
  if (last.view && last.view !== found && last.document === document && shown)
    found.useView(shown, false);
  else if (last.view !== found) shownView.value = found.getView();
  last = { view: found, document };
}

/** @param {Studio3d} view @returns {(() => void)[]} the ends of all that keeps it informed */
function tell(view) {
  return [
    effect(() => {
      if (robot.value) view.setRobot(robot.value);
    }),
    effect(() => {
      const now = movable.value.map(({ name }) => [name, position(name).value]);
      view.setPositions(Object.fromEntries(now));
    }),
    effect(() => view.setTheme(theme.value)),
    effect(() => view.setMouse(mouseMode.value)),
    effect(() => view.setBackground(background.value)),
    effect(() => view.setFrameRate(frameRate.value)),
    effect(() => view.setHover(hovered.value)),
    effect(() => view.setSelection(selected.value)),
    effect(() => {
      const name = selectedJoint.value;
      view.setAxis(robot.value?.joints.find((joint) => joint.name === name) ?? null);
    }),
    effect(() => view.setFrames(comparedFrames.value.links, comparedFrames.value.others)),
    effect(() => view.setChain(drawnChain.value)),
    keepInScene(() => followedFrames.value),
    effect(() => {
      const lit = lights.value ?? { changed_links: [], moved_links: litChain.value };
      view.setLit(lit.changed_links, lit.moved_links);
    }),
    effect(() => view.setCanDrag(mayMove.value)),
    effect(() => view.setOutlines(outlined.value)),
    followSelection(),
    effect(() => view.setUnits(degrees.value ? "deg" : "rad", millimetres.value ? "mm" : "m")),
    tellLinks(view),
  ];
}

/** @param {Studio3d} view @returns {() => void} tells only of links whose look changed here */
function tellLinks(view) {
  /** @type {Map<string, string>} */
  let reply = new Map();
  return effect(() => {
    const now = new Map();
    for (const link of robot.value?.links.map(({ name }) => name) ?? []) {
      const visible = !hiddenLinks.value.has(link);
      const opacity = linkOpacity.value.get(link) ?? 1;
      const look = `${visible} ${opacity}`;
      now.set(link, look);
      if (look === (reply.get(link) ?? "true 1")) continue;
      view.setLinkVisible(link, visible);
      view.setLinkOpacity(link, opacity);
    }
    reply = now;
  });
}

/** @param {Studio3d} view @returns {() => void} */
function listen(view) {
  const stop = new AbortController();
  /** @param {string} type @param {(detail: any, event: Event) => void} take */
  const on = (type, take) =>
    view.events.addEventListener(
      type,
      (event) => take(/** @type {CustomEvent} */ (event).detail, event),
      {
        signal: stop.signal,
      },
    );
  on("hover", ({ link }) => {
    hovered.value = link;
  });
  on("select", ({ link }) => selectLink(link, "scene"));
  on("connection", ({ connected }) => {
    viewportConnected.value = connected;
  });
  on("drag", takeDrag);
  on("picked", takePicked);
  on("select_nothing", selectNothing);
  on("view", ({ byHand, kind, values }) => {
    shownView.value = { kind, values };
    if (byHand) movedByHand.value = true;
  });
  on("key", (stroke, event) => {
    // Prevented, the view leaves the key to the page.
    if (isStroke(stroke) && onKey(stroke)) event.preventDefault();
  });
  return () => stop.abort();
}

/** @param {{joint: string, value: number, phase: "start" | "move" | "end" | "cancel"}} drag */
function takeDrag({ joint, value, phase }) {
  if (!mayMove.value || phase === "start") return;
  moveJoint(joint, value);
}

/** @param {string} link bring it into view, and into the tree */
export function focusLink(link) {
  selectLink(link, "");
  viewport.value?.focus(link);
}

/** The frame that the camera goes with; empty: with none. */
export const targetFrame = computed(() => {
  const { kind, values } = shownView.value ?? { kind: "", values: {} };
  return isKind(kind) ? targetOf({ kind, values }) : "";
});
/** Why it does not go, in a sentence; empty: it does, or it is not known yet. */
export const targetTrouble = signal("");

/** Keep the camera going with its frame. @returns {() => void} the end of that */
export function keepTargetFrame() {
  const ends = [
    effect(() => {
      // Of another frame, robot or connection it is not known yet.
      [targetFrame.value, robot.value, connection.value];
      targetTrouble.value = "";
    }),
    keepInScene(() => (targetFrame.value === "" ? [] : [targetFrame.value]), takeTrouble),
  ];
  return () => {
    for (const end of ends) end();
  };
}

/** @param {string} frame @param {string} trouble */
function takeTrouble(frame, trouble) {
  if (frame === targetFrame.peek()) targetTrouble.value = trouble;
}
