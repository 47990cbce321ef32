/** Arrangements of the panels by the size of the window; each is remembered on its own. */

/** @import { Dock, Split } from "../lib/dock.js" */

import { effect } from "vendor/preact.js";
import { recall, remember } from "../lib/remembered.js";
import { size } from "./state/view.js";

const PHONE_BELOW_PX = 700;
const LOW_BELOW_PX = 480;
const WIDE_FROM_PX = 1000;
const VERSION = 3;

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
 * @returns {Split[]} a row, left to right; a split in it stacks from top to bottom
 */
export function modelLayout(kind, width, height) {
  if (kind === "phone")
    return [
      {
        tabs: [
          "scene",
          "properties",
          "origin",
          "joints",
          "variants",
          "displays",
          "outline",
          "source",
          "problems",
          "urdf",
        ],
        size: width,
      },
    ];
  if (kind === "medium") {
    const right = Math.round(Math.min(340, width * 0.42));
    const low = Math.round(height * 0.38);
    const left = [
      { tabs: ["scene"], size: height - low },
      {
        tabs: ["source", "outline", "displays", "variants", "problems", "urdf"],
        size: low,
      },
    ];
    return [
      { split: left, size: width - right },
      { tabs: ["properties", "origin", "joints"], size: right },
    ];
  }
  const low = Math.round(Math.min(340, height * 0.36));
  const scene = { tabs: ["scene"], size: height - low };
  const below = { tabs: ["source", "variants", "problems", "urdf"], size: low };
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
 * @returns {{reset: () => void, keep: () => void}}
 */
export function followSize(dock, element) {
  const arrange = () => {
    const kind = size.value;
    const stored = kind === "phone" ? undefined : recall(storeName(kind));
    dock.setSingle(kind === "phone");
    dock.arrange(modelLayout(kind, element.clientWidth, element.clientHeight), stored);
  };
  const measure = () => {
    size.value = sizeOf(innerWidth, innerHeight);
  };
  measure();
  addEventListener("resize", measure);
  effect(arrange);
  return {
    reset() {
      remember(storeName(size.peek()), undefined);
      arrange();
    },
    keep() {
      if (size.peek() !== "phone") remember(storeName(size.peek()), dock.layout());
    },
  };
}
