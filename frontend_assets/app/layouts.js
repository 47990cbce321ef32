/** Arrangements of the panels by the size of the window; each is remembered on its own. */

/** @import { Arrangement, Split } from "../lib/arrangement.js" */
/** @import { Dock } from "../lib/dock.js" */

import { effect, untracked } from "vendor/preact.js";
import { readArrangement } from "../lib/arrangement.js";
import { recall, remember } from "../lib/remembered.js";
import { layoutDesk, size } from "../model/view.js";
import { LIVE, liveLayout } from "./live-layout.js";
import { layoutInUse, ownArrangement } from "./state/own-layouts.js";

const PHONE_BELOW_PX = 700;
const LOW_BELOW_PX = 480;
const WIDE_FROM_PX = 1000;
/** Of the height for what stands below the 3D view: some fifteen lines of text in a usual window. */
const LOW_SHARE = 0.42;
const VERSION = 4;

/** @param {number} width px @param {number} height px @returns {"wide" | "medium" | "phone"} */
export function sizeOf(width, height) {
  // A phone may lie on its side, too: panels above one another would be slits.
  if (width < PHONE_BELOW_PX || height < LOW_BELOW_PX) return "phone";
  return width < WIDE_FROM_PX ? "medium" : "wide";
}

/**
 * @param {"wide" | "medium" | "phone"} kind
 * @param {number} width px
 * @param {number} height px
 * @param {readonly string[]} panels all that there are
 * @returns {Split[]} a row, left to right; a split in it stacks from top to bottom
 */
export function modelLayout(kind, width, height, panels) {
  if (kind === "phone") return [{ tabs: [...panels], size: width }];
  if (kind === "medium") {
    const right = Math.round(Math.min(340, width * 0.42));
    const low = Math.round(height * LOW_SHARE);
    const left = [
      { tabs: ["scene"], size: height - low },
      {
        tabs: ["source", "outline", "displays", "variants", "problems", "masses", "urdf"],
        size: low,
      },
    ];
    return [
      { split: left, size: width - right },
      { tabs: ["properties", "origin", "joints", "frames"], size: right },
    ];
  }
  const low = Math.round(Math.min(430, height * LOW_SHARE));
  const scene = { tabs: ["scene"], size: height - low };
  const below = { tabs: ["source", "variants", "problems", "frames", "masses", "urdf"], size: low };
  const left = Math.round(Math.min(300, width * 0.22));
  const right = Math.round(Math.min(390, width * 0.28));
  return [
    { tabs: ["displays", "outline"], size: left },
    { split: [scene, below], size: width - left - right },
    { tabs: ["properties", "origin", "joints"], size: right },
  ];
}

/** @param {"wide" | "medium" | "phone"} kind */
const storeName = (kind) => `layout.${VERSION}.${kind}`;

/**
 * Keep the dock arranged as the size of the window asks.
 *
 * @param {Dock} dock
 * @param {HTMLElement} element that holds it
 * @param {readonly string[]} panels all that there are
 * @returns {{keep: () => void}} to be called when a person moved something
 */
export function followSize(dock, element, panels) {
  const arrange = () => {
    const kind = size.value;
    // The words of a panel come with it: they must not arrange all anew.
    untracked(() => {
      dock.setSingle(kind === "phone");
      dock.arrange(arrangementFor(kind, element, panels));
    });
  };
  const measure = () => {
    size.value = sizeOf(innerWidth, innerHeight);
  };
  measure();
  addEventListener("resize", measure);
  effect(arrange);
  effect(dock.nameAll);
  layoutDesk.value = deskFor(dock, arrange);
  return {
    keep() {
      if (size.peek() !== "phone") remember(storeName(size.peek()), dock.arrangement());
    },
  };
}

/** @param {"wide" | "medium" | "phone"} kind @param {HTMLElement} element @param {readonly string[]} panels @returns {Arrangement} */
function arrangementFor(kind, element, panels) {
  const given = { parts: givenLayout(kind, element.clientWidth, element.clientHeight, panels) };
  if (kind === "phone") return given;
  const chosen = recall(storeName(kind)) ?? ownArrangement(layoutInUse.value);
  return readArrangement(chosen, (id) => panels.includes(id))?.arrangement ?? given;
}

/** @param {"wide" | "medium" | "phone"} kind @param {number} width px @param {number} height px @param {readonly string[]} panels */
function givenLayout(kind, width, height, panels) {
  if (kind !== "phone" && layoutInUse.value === LIVE)
    return liveLayout(kind, width, height, (id) => panels.includes(id));
  return modelLayout(kind, width, height, panels);
}

/** @param {Dock} dock @param {() => void} arrange @returns {import("../model/view.js").LayoutDesk} */
function deskFor(dock, arrange) {
  const forget = () => {
    for (const kind of /** @type {const} */ (["wide", "medium"]))
      remember(storeName(kind), undefined);
    arrange();
  };
  return {
    present: () => dock.arrangement(),
    use(name) {
      layoutInUse.value = name;
      forget();
    },
    showBeside: dock.showBeside,
    reset: forget,
  };
}
