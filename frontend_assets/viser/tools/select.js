/** @import { CloudDetail } from "../cloud-detail.js" */
/** @import { Door } from "../door.js" */
/** @import { Rect } from "../lens.js" */
/** @import { LiveNode } from "../live-nodes.js" */
/** @import { Met } from "../live-picking.js" */
/** @import { RobotView } from "../robot.js" */
/** @import { Spot } from "./tool.js" */
/** @import { Vector3 } from "../viser.d.ts" */

import { lensOf, rectOf } from "../lens.js";
import { liveNodes } from "../live-nodes.js";
import { isBetter, liveAt, rowsIn, surfacesIn } from "../live-picking.js";
import { pick } from "../picking.js";
import { far, setCursor, Tool } from "./tool.js";

/**
 * A part of a node that was pointed at, as the studio is asked what it is.
 *
 * @typedef {{ display: string, path: string, shape: string, node: string, rows: readonly number[], place: [number, number, number] | null }} PickedNode
 */
/**
 * What was pointed at with the tool; `left_out` parts are more than can be selected.
 *
 * @typedef {{ nodes: PickedNode[], links: string[], how: "replace" | "add" | "remove", left_out: number }} PickedParts
 */

/** Parts that are told at once, and nodes that they are of; the studio takes no more. */
const PARTS_MAX = 40_000;
const NODES_MAX = 2000;
/** How far from what is thin a click may be, px. */
const REACH_PX = 6;
const REACH_OF_FINGER_PX = 16;
/** Of each picture's time a rectangle takes so much. */
const AT_ONCE_MS = 8;

/**
 * A click selects what lies under it, a rectangle all that it touches. With Shift it is added to what
 * is selected, with Ctrl taken away from it. The other buttons, Alt and two fingers move the camera.
 */
export class Select extends Tool {
  takesModified = true;
  /** @type {Spot | null} */
  #from = null;
  /** @type {Rect | null} */
  #rect = null;
  /** Counts what was begun: of two rectangles the second one counts. */
  #turn = 0;
  #frame = document.createElement("div");
  #door;
  #robot;
  #detail;
  #tell;

  /** @param {Door} door @param {RobotView} robot @param {CloudDetail} detail
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, robot, detail, tell) {
    super();
    this.#door = door;
    this.#robot = robot;
    this.#detail = detail;
    this.#tell = tell;
    this.#frame.className = "studio-select-frame";
    this.#frame.hidden = true;
  }

  take() {
    setCursor("crosshair");
  }

  leave() {
    setCursor("");
  }

  /** @param {Spot} spot */
  down(spot) {
    this.#from = spot;
    return true;
  }

  /** @param {Spot} spot */
  move(spot) {
    if (!this.#from || (!this.#rect && !far(spot, this.#from))) return;
    this.#rect = rectOf(this.#from, spot);
    this.#draw(this.#rect);
  }

  /** @param {Spot} spot */
  up(spot) {
    const rect = this.#rect;
    this.cancel();
    if (rect) this.#selectWithin(rect, howOf(spot));
    else this.click(spot);
  }

  /** @param {Spot} spot */
  click(spot) {
    this.#turn += 1;
    const reach_px = spot.touch ? REACH_OF_FINGER_PX : REACH_PX;
    const live = liveAt(this.#door, this.#detail, spot, reach_px);
    const link = pick(this.#door, this.#robot, spot.x, spot.y);
    const isLink = link !== null && this.#isBefore(link.point, live?.met ?? null);
    const nodes = !isLink && live ? [pickedOf(live.node, [live.met.row], live.met.place)] : [];
    this.#say({ nodes, links: isLink ? [link.link] : [], how: howOf(spot), left_out: 0 });
  }

  /** Whether a point of the robot is seen, and not what was met. @param {Vector3} point @param {Met | null} met */
  #isBefore({ x, y, z }, met) {
    const { scene } = this.#door.mutable ?? {};
    const lens = scene && lensOf(this.#door, scene);
    if (!lens) return false;
    lens.at(x, y, z);
    return isBetter({ row: 0, depth_m: lens.depth_m, miss_px: 0, place: null }, met);
  }

  /** Two clicks are two clicks. */
  doubleClick() {
    return true;
  }

  cancel() {
    const was = this.#from !== null;
    this.#from = this.#rect = null;
    this.#frame.hidden = true;
    return was;
  }

  /** @param {PickedParts} picked */
  #say(picked) {
    this.#tell("picked", picked);
  }

  /** @param {Rect} rect */
  #draw({ left, top, right, bottom }) {
    if (!this.#frame.isConnected) document.body.append(this.#frame);
    this.#frame.hidden = false;
    this.#frame.style.transform = `translate(${left}px, ${top}px)`;
    this.#frame.style.width = `${right - left}px`;
    this.#frame.style.height = `${bottom - top}px`;
  }

  /** @param {Rect} rect @param {PickedParts["how"]} how */
  async #selectWithin(rect, how) {
    this.#turn += 1;
    const turn = this.#turn;
    const pause = pauses(AT_ONCE_MS);
    /** @type {{ node: LiveNode, rows: number[] }[]} */
    const found = [];
    for (const node of liveNodes(this.#door)) {
      const rows = await gathered(rowsIn(this.#door, this.#detail, node, rect), pause);
      await pause();
      if (turn !== this.#turn) return;
      if (rows.length > 0) found.push({ node, rows });
    }
    const links = await this.#linksIn(rect, pause);
    if (turn !== this.#turn) return;
    const { kept, left_out } = keptOf(found, NODES_MAX, PARTS_MAX);
    const nodes = kept.map(({ node, rows }) => pickedOf(node, rows, null));
    this.#say({ nodes, links, how, left_out });
  }

  /** @param {Rect} rect @param {() => Promise<void> | null} pause */
  async #linksIn(rect, pause) {
    const links = [];
    for (const link of this.#robot.drawn) {
      const isIn = await someOf(
        this.#robot.surfaces(link).map((surface) => surfacesIn(this.#door, surface, rect)),
        pause,
      );
      if (isIn) links.push(link);
    }
    return links;
  }
}

/** @param {Spot} spot @returns {PickedParts["how"]} */
const howOf = ({ shift, ctrl }) => (ctrl ? "remove" : shift ? "add" : "replace");

/** @param {LiveNode} node @param {readonly number[]} rows @param {PickedNode["place"]} place @returns {PickedNode} */
function pickedOf({ display, path, shape, node }, rows, place) {
  return { display, path, shape, node, rows, place };
}

/** When others have waited long enough, a promise of a time after their turn. @param {number} atOnce_ms */
export function pauses(atOnce_ms) {
  let began_ms = performance.now();
  return () => {
    if (performance.now() - began_ms < atOnce_ms) return null;
    return new Promise((resolve) => setTimeout(resolve)).then(() => {
      began_ms = performance.now();
    });
  };
}

/** @param {Generator<number | null>} rows @param {() => Promise<void> | null} pause @returns {Promise<number[]>} */
export async function gathered(rows, pause) {
  const found = [];
  for (const row of rows) {
    if (row !== null) found.push(row);
    else await pause();
  }
  return found;
}

/** Whether any of them has a row. @param {Generator<number | null>[]} all @param {() => Promise<void> | null} pause */
async function someOf(all, pause) {
  for (const rows of all)
    for (const row of rows) {
      if (row !== null) return true;
      await pause();
    }
  return false;
}

/**
 * What can be told at once of what a rectangle touches, and how many rows are left out for it.
 * @template {{ node: { display: string }, rows: readonly number[] }} T
 * @param {readonly T[]} found @param {number} nodesMax @param {number} rowsMax
 * @returns {{ kept: Pick<T, "node" | "rows">[], left_out: number }}
 */
export function keptOf(found, nodesMax, rowsMax) {
  const told = found.slice(0, nodesMax);
  const shares = sharesOf(
    told.map(({ node, rows }) => [node.display, rows.length]),
    rowsMax,
  );
  const kept = told
    .map(({ node, rows }, at) => ({ node, rows: spread(rows, shares[at] ?? 0) }))
    .filter(({ rows }) => rows.length > 0);
  const count = (/** @type {readonly { rows: readonly number[] }[]} */ all) =>
    all.reduce((sum, { rows }) => sum + rows.length, 0);
  return { kept, left_out: count(found) - count(kept) };
}

/**
 * How many parts of each node are taken if there are too many: displays of few parts keep all of them.
 * @param {readonly [string, number][]} counts display and parts of each node @param {number} most @returns {number[]}
 */
export function sharesOf(counts, most) {
  /** @type {Map<string, number>} */
  const perDisplay = new Map();
  for (const [display, count] of counts)
    perDisplay.set(display, (perDisplay.get(display) ?? 0) + count);
  let left = most;
  /** @type {Map<string, number>} */
  const taken = new Map();
  [...perDisplay]
    .sort(([, one], [, other]) => one - other)
    .forEach(([display, count], at) => {
      const share = Math.min(count, Math.floor(left / (perDisplay.size - at)));
      taken.set(display, share);
      left -= share;
    });
  return counts.map(([display, count]) =>
    Math.floor((count * (taken.get(display) ?? 0)) / (perDisplay.get(display) || 1)),
  );
}

/** So many of some rows, spread evenly over them. @param {readonly number[]} rows @param {number} most */
export function spread(rows, most) {
  if (rows.length <= most) return rows;
  return Array.from(
    { length: most },
    (_, at) => /** @type {number} */ (rows[Math.floor((at * rows.length) / most)]),
  );
}
