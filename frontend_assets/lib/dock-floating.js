/**
 * Panels of a dock in windows over the others: moved and sized by keys, too, and docked again; and
 * one panel alone, as on a full screen.
 */

/** @import { DockviewApi, IDockviewPanel } from "vendor/dockview.js" */
/** @import { Arrangement } from "./arrangement.js" */

import { TAB, tabOfPanel } from "./dock-tabs.js";

/** @typedef {DockviewApi["groups"][number]} Group */

/** @param {Group} group */
export const isInGrid = (group) => group.api.location.type === "grid";

/** @param {IDockviewPanel | undefined} panel */
export const isFloating = (panel) => panel?.api.location.type === "floating";

/** Of the room of all panels, for a window that floats first. */
const FLOATING_SHARE = { width: 0.32, height: 0.5 };
const FLOATING_LEAST_PX = { width: 300, height: 220 };
/** Windows one after the other do not lie on top of each other. */
const FLOATING_STEP_PX = 28;

/** @param {DockviewApi} api @param {string} id @param {Map<string, string>} homes where floating panels came from @param {HTMLElement} element that holds the dock */
export function floatPanel(api, id, homes, element) {
  const panel = api.getPanel(id);
  if (!panel) return;
  if (api.hasMaximizedGroup()) api.exitMaximizedGroup();
  const neighbour = panel.group.panels.find((one) => one !== panel);
  if (neighbour) homes.set(id, neighbour.id);
  const room = { width: element.clientWidth, height: element.clientHeight };
  const size = (/** @type {"width" | "height"} */ side) =>
    Math.min(Math.max(room[side] * FLOATING_SHARE[side], FLOATING_LEAST_PX[side]), room[side]);
  const [width, height] = [size("width"), size("height")];
  const step = api.groups.filter((group) => !isInGrid(group)).length * FLOATING_STEP_PX;
  const place = (/** @type {"width" | "height"} */ side, /** @type {number} */ own) =>
    Math.max(0, Math.min((room[side] - own) / 2 + step, room[side] - own));
  api.addFloatingGroup(panel, {
    position: { left: place("width", width), top: place("height", height) },
    width,
    height,
  });
  api.getPanel(id)?.api.setActive();
}

/** @param {DockviewApi} api @param {string} id @param {string | undefined} home a panel that it stood beside @param {(group: Group) => boolean} mayTake whether a group takes any panel */
export function dockPanel(api, id, home, mayTake) {
  const panel = api.getPanel(id);
  if (!panel) return;
  const before = home ? api.getPanel(home)?.group : undefined;
  const group =
    before && isInGrid(before) ? before : api.groups.find((one) => isInGrid(one) && mayTake(one));
  panel.api.moveTo({ group: group ?? api.addGroup({ direction: "left" }), position: "center" });
  api.getPanel(id)?.api.setActive();
}

/** px, for one stroke of an arrow key. */
const KEY_STEP_PX = 24;
/** @type {Record<string, readonly [number, number]>} */
const ARROWS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/**
 * Alt and an arrow move a window over the others whose tab has the focus, with Shift they size it.
 *
 * @param {DockviewApi} api @param {KeyboardEvent} event @returns {boolean} they did
 */
export function moveFloatingByKey(api, event) {
  const step = ARROWS[event.key];
  const tab = event.target instanceof Element ? event.target.closest(TAB) : null;
  const group = api.groups.find((one) => tab && one.element.contains(tab));
  if (!step || !event.altKey || !group || isInGrid(group)) return false;
  event.preventDefault();
  const [x, y] = [step[0] * KEY_STEP_PX, step[1] * KEY_STEP_PX];
  const frame = group.element.closest(".dv-resize-container");
  const id = group.activePanel?.id ?? "";
  if (frame instanceof HTMLElement)
    placeFloating(api, group, frame, event.shiftKey ? [0, 0, x, y] : [x, y, 0, 0]);
  tabOfPanel(api, id)?.focus();
  return true;
}

/** @param {DockviewApi} api @param {Group} group @param {HTMLElement} frame @param {[number, number, number, number]} by px to the right, down, wider and higher */
function placeFloating(api, group, frame, [x, y, wider, higher]) {
  const room = frame.offsetParent?.getBoundingClientRect();
  if (!room) return;
  const now = frame.getBoundingClientRect();
  const within = (
    /** @type {number} */ at,
    /** @type {number} */ least,
    /** @type {number} */ most,
  ) => Math.max(least, Math.min(at, most));
  const left = within(now.left - room.left + x, 0, room.width - now.width);
  const top = within(now.top - room.top + y, 0, room.height - now.height);
  api.addFloatingGroup(group, {
    position: { left, top },
    width: within(now.width + wider, FLOATING_LEAST_PX.width / 2, room.width - left),
    height: within(now.height + higher, FLOATING_LEAST_PX.height / 2, room.height - top),
  });
}

/** @typedef {{width: number, height: number}} Room px */

/** @param {HTMLElement} element @returns {Room} */
const roomOf = ({ clientWidth: width, clientHeight: height }) => ({ width, height });

/** So many pictures a page may take to stand as before; a window may have another size since. */
const PICTURES_MOST = 60;

/**
 * Once an element has its size back: what is arranged in a larger room does not fit into it.
 *
 * @param {HTMLElement} element @param {Room} room @param {() => void} run @param {number} [left] pictures until it runs all the same
 */
function whenAsLarge(element, room, run, left = PICTURES_MOST) {
  requestAnimationFrame(() => {
    const { width, height } = roomOf(element);
    if (left === 0 || (width === room.width && height === room.height)) run();
    else whenAsLarge(element, room, run, left - 1);
  });
}

/**
 * One panel alone, until all stand as before, which they do only once the dock has its room back.
 *
 * @param {DockviewApi} api @param {HTMLElement} element that holds the dock @param {(arrangement: Arrangement) => void} arrange
 */
export function aloneIn(api, element, arrange) {
  let isOn = false;
  /** @type {{arrangement: Arrangement, room: Room} | null} */
  let before = null;
  /** @type {(() => void)[]} */
  const waiting = [];
  const restore = () => {
    // It is alone again, or all stand as before already.
    if (isOn || !before) return;
    const { arrangement } = before;
    before = null;
    arrange(arrangement);
    for (const run of waiting.splice(0)) run();
  };
  return {
    /** How all stood and will stand again; null: they do. */
    before: () => before?.arrangement ?? null,
    /** @param {Arrangement} arrangement that all shall stand in @returns {boolean} they will; false: no panel is alone */
    keep(arrangement) {
      if (!before) return false;
      before = { ...before, arrangement };
      restore();
      return true;
    },
    /** @param {() => void} run called once all stand as before @returns {boolean} false: they do, it is not called */
    later(run) {
      if (before) waiting.push(run);
      return before !== null;
    },
    /** @param {IDockviewPanel} panel @param {() => Arrangement} arrangement as it is now */
    begin(panel, arrangement) {
      before ??= { arrangement: arrangement(), room: roomOf(element) };
      isOn = true;
      element.classList.add("alone");
      panel.api.maximize();
    },
    /** @param {boolean} atOnce they take any room */
    end(atOnce) {
      if (!isOn || !before) return;
      isOn = false;
      element.classList.remove("alone");
      api.exitMaximizedGroup();
      if (atOnce) restore();
      else whenAsLarge(element, before.room, restore);
    },
  };
}
