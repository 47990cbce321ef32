/**
 * Arrangements of the panels by the size of the window, each remembered on its own: the studio's,
 * the one for a robot that runs, and those that this person saved in this browser, by name, or
 * has as a file.
 */

/** @import { Arrangement, Split } from "../lib/arrangement.js" */
/** @import { Dock } from "../lib/dock.js" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, effect, signal, untracked } from "vendor/preact.js";
import { readArrangement } from "../lib/arrangement.js";
import { recall, remember, remembered } from "../lib/remembered.js";
import { documentId, mayManage } from "../model/connection.js";
import { documentState } from "../model/document.js";
import { layoutControl, size } from "../model/view.js";

const PHONE_BELOW_PX = 700;
const LOW_BELOW_PX = 480;
const WIDE_FROM_PX = 1000;
/** Of the height for what stands below the 3D view: some fifteen lines of text in a usual window. */
const LOW_SHARE = 0.42;
const VERSION = 4;

/** @param {number} width px @param {number} height px @returns {"wide" | "medium" | "phone"} */
function sizeOf(width, height) {
  // A phone may lie on its side, too: panels above one another would be slits.
  if (width < PHONE_BELOW_PX || height < LOW_BELOW_PX) return "phone";
  return width < WIDE_FROM_PX ? "medium" : "wide";
}

/** @typedef {"left" | "middle" | "below" | "right" | "upper" | "lower" | "tabs"} Part of a layout */
/** @typedef {Partial<Record<"wide" | "medium" | "live" | "workspace" | "phone", string>>} Places of a panel by layout: its part, and its number among the tabs there, as `below 4`; without a number it is the last */
/** @typedef {Record<string, {places?: Places, runs?: boolean}>} PlacedPanels by their ids; `runs`: beside a robot only where something may be run */

/** @param {PlacedPanels} panels @param {keyof Places} layout @param {Part} wanted @returns {string[]} ids of those that have their place there, in order */
export function placedPanels(panels, layout, wanted) {
  /** @type {[number, string][]} */
  const found = [];
  for (const [id, { places }] of Object.entries(panels)) {
    const [part, at = Number.MAX_VALUE] = places?.[layout]?.split(" ") ?? [];
    if (part === wanted) found.push([Number(at), id]);
  }
  return found.sort(([one], [other]) => one - other).map(([, id]) => id);
}

/**
 * @param {"wide" | "medium" | "phone"} kind
 * @param {number} width px
 * @param {number} height px
 * @param {PlacedPanels} panels all that there are
 * @returns {Split[]} a row, left to right; a split in it stacks from top to bottom
 */
function modelLayout(kind, width, height, panels) {
  if (kind === "phone") return [{ tabs: Object.keys(panels), size: width }];
  const tabsOf = (/** @type {Part} */ part) => placedPanels(panels, kind, part);
  if (kind === "medium") {
    const right = Math.round(Math.min(340, width * 0.42));
    const low = Math.round(height * LOW_SHARE);
    const left = [
      { tabs: tabsOf("middle"), size: height - low },
      { tabs: tabsOf("below"), size: low },
    ];
    return [
      { split: left, size: width - right },
      { tabs: tabsOf("right"), size: right },
    ];
  }
  const low = Math.round(Math.min(430, height * LOW_SHARE));
  const middle = { tabs: tabsOf("middle"), size: height - low };
  const below = { tabs: tabsOf("below"), size: low };
  const left = Math.round(Math.min(300, width * 0.22));
  const right = Math.round(Math.min(390, width * 0.28));
  return [
    { tabs: tabsOf("left"), size: left },
    { split: [middle, below], size: width - left - right },
    { tabs: tabsOf("right"), size: right },
  ];
}

/**
 * A folder of packages without a robot has a layout of its own: packages, their texts, what runs.
 *
 * @param {"wide" | "medium"} kind @param {number} width px @param {number} height px @param {PlacedPanels} panels
 * @returns {Split[]} a row, left to right
 */
function workspaceLayout(kind, width, height, panels) {
  const tabsOf = (/** @type {Part} */ part) => placedPanels(panels, "workspace", part);
  const low = Math.round(height * LIVE_LOW_SHARE);
  const middle = [
    { tabs: tabsOf("middle"), size: height - low },
    { tabs: tabsOf("below"), size: low },
  ];
  if (kind === "medium") {
    const side = Math.round(Math.min(400, width * 0.42));
    return [
      { tabs: [...tabsOf("left"), ...tabsOf("right")], size: side },
      { split: middle, size: width - side },
    ];
  }
  const left = Math.round(Math.min(370, width * 0.24));
  const right = Math.round(Math.min(470, width * 0.3));
  return [
    { tabs: tabsOf("left"), size: left },
    { split: middle, size: width - left - right },
    { tabs: tabsOf("right"), size: right },
  ];
}

/** The document is a folder of packages without a robot. */
const isBare = computed(() => documentState.value?.is_bare ?? false);
/** What lies beside the robot may be run by whoever looks. */
const mayRunHere = computed(() => mayManage.value && (documentState.value?.may_run ?? false));

/** @param {"wide" | "medium" | "phone"} kind */
const storeName = (kind) => `layout.${VERSION}.${kind}${isBare.peek() ? ".workspace" : ""}`;

/**
 * Keep the dock arranged as the size of the window asks.
 *
 * @param {Dock} dock
 * @param {HTMLElement} element that holds it
 * @param {PlacedPanels} panels all that there are
 * @returns {{keep: () => void}} to be called when a person moved something
 */
export function followSize(dock, element, panels) {
  /** The document has not come, which may ask for other panels than stand here now. */
  let isWaiting = documentId.peek() !== "";
  /** A person moved or opened something meanwhile. */
  let isTouched = false;
  /** What stood in front before that. @type {string[]} */
  let given = [];
  const keep = () => {
    isTouched = true;
    if (size.peek() !== "phone" && !isWaiting) remember(storeName(size.peek()), dock.arrangement());
  };
  const arrange = () => {
    const kind = size.value;
    isBare.value;
    mayRunHere.value;
    // The words of a panel come with it: they must not arrange all anew.
    untracked(() => {
      const opened = isWaiting ? frontsOf(dock.arrangement()).filter(isOpened) : [];
      dock.setSingle(kind === "phone");
      dock.arrange(arrangementFor(kind, element, panels));
      given = frontsOf(dock.arrangement());
      for (const id of opened) dock.show(id);
      isTouched ||= opened.length > 0;
    });
  };
  const isOpened = (/** @type {string} */ id) => given.length > 0 && !given.includes(id);
  const measure = () => {
    size.value = sizeOf(innerWidth, innerHeight);
  };
  measure();
  addEventListener("resize", measure);
  effect(arrange);
  effect(dock.nameAll);
  effect(() => {
    if (!isWaiting || !documentState.value) return;
    // After `arrange`, which hears of it, too.
    queueMicrotask(() => {
      isWaiting = false;
      if (isTouched) keep();
    });
  });
  layoutControl.value = controlFor(dock, arrange);
  return { keep };
}

/** @param {Arrangement} arrangement @returns {string[]} the panels that are seen in it */
function frontsOf({ parts, floating = [] }) {
  /** @param {Split} part @returns {string[]} */
  const fronts = (part) =>
    "split" in part ? part.split.flatMap(fronts) : [part.shown ?? part.tabs[0] ?? ""];
  return [...parts, ...floating.map((one) => ({ ...one, size: 0 }))].flatMap(fronts);
}

/** @param {"wide" | "medium" | "phone"} kind @param {HTMLElement} element @param {PlacedPanels} panels @returns {Arrangement} */
function arrangementFor(kind, element, panels) {
  const given = { parts: givenLayout(kind, element.clientWidth, element.clientHeight, panels) };
  if (kind === "phone") return given;
  const own = isBare.value ? null : ownArrangement(layoutInUse.value);
  const chosen = recall(storeName(kind)) ?? own;
  return readArrangement(chosen, (id) => Object.hasOwn(panels, id))?.arrangement ?? given;
}

/** @param {PlacedPanels} panels @returns {PlacedPanels} those that are of use where nothing may be run */
export function withoutRunning(panels) {
  return Object.fromEntries(Object.entries(panels).filter(([, { runs }]) => !runs));
}

/** @param {"wide" | "medium" | "phone"} kind @param {number} width px @param {number} height px @param {PlacedPanels} panels */
function givenLayout(kind, width, height, panels) {
  if (kind !== "phone" && isBare.value) return workspaceLayout(kind, width, height, panels);
  const placed = kind === "phone" || mayRunHere.value ? panels : withoutRunning(panels);
  if (kind !== "phone" && layoutInUse.value === LIVE)
    return liveLayout(kind, width, height, placed);
  return modelLayout(kind, width, height, placed);
}

/** @param {Dock} dock @param {() => void} arrange @returns {import("../model/view.js").LayoutControl} */
function controlFor(dock, arrange) {
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
    open(ids) {
      const kind = size.peek();
      if (kind === "phone") return;
      for (const id of ids) dock.add(id);
      remember(storeName(kind), dock.arrangement());
    },
    reset: forget,
    arrange(arrangement) {
      const kind = size.peek();
      if (kind === "phone") return;
      dock.arrange(arrangement);
      remember(storeName(kind), dock.arrangement());
    },
  };
}

/** Its name among the layouts; one that a person gives never begins with a space. */
export const LIVE = " live";

const LIVE_LOW_SHARE = 0.36;
const UPPER_SHARE = 0.4;

/**
 * @param {"wide" | "medium"} kind
 * @param {number} width px
 * @param {number} height px
 * @param {PlacedPanels} panels all that there are
 * @returns {Split[]} a row, left to right; a split in it stacks from top to bottom
 */
function liveLayout(kind, width, height, panels) {
  const tabsOf = (/** @type {Part} */ part) => placedPanels(panels, "live", part);
  const [left, upper, lower] = [tabsOf("left"), tabsOf("upper"), tabsOf("lower")];
  const low = Math.round(height * LIVE_LOW_SHARE);
  const middle = [{ tabs: tabsOf("middle"), size: height - low }, ...tabs(tabsOf("below"), low)];
  if (kind === "medium") {
    const right = Math.round(Math.min(380, width * 0.44));
    return [{ split: middle, size: width - right }, ...tabs([...lower, ...left, ...upper], right)];
  }
  const side = Math.round(Math.min(270, width * 0.2));
  const right = Math.round(Math.min(470, width * 0.32));
  const upperHeight = Math.round(height * UPPER_SHARE);
  return [
    ...tabs(left, side),
    { split: middle, size: width - side - right },
    { split: [...tabs(upper, upperHeight), ...tabs(lower, height - upperHeight)], size: right },
  ];
}

/** @param {string[]} ids @param {number} size @returns {Split[]} none where no panel is */
const tabs = (ids, size) => (ids.length > 0 ? [{ tabs: ids, size }] : []);

/** @typedef {{name: string, arrangement: Arrangement}} OwnLayout */

const FILE_VERSION = 1;
const NAME_LONGEST = 60;
export const LAYOUTS_MOST = 50;
/** Bytes; fifty layouts of thirty panels take a tenth of it. */
export const FILE_LARGEST = 1_000_000;

/** The file is none; `reason` is the key of the words for it. */
export class LayoutFileError extends Error {
  /** @param {"layouts.import.no_json" | "layouts.import.no_layouts" | "layouts.import.newer" | "layouts.import.too_large"} reason */
  constructor(reason) {
    super(reason);
    this.reason = reason;
  }
}

/** @param {readonly OwnLayout[]} layouts @returns {string} */
export function layoutFile(layouts) {
  return `${JSON.stringify({ studio_layouts: FILE_VERSION, layouts }, null, 2)}\n`;
}

/**
 * @param {string} text
 * @param {(id: string) => boolean} isKnown whether there is such a panel
 * @returns {{layouts: OwnLayout[], dropped: string[]}} `dropped`: panels that this studio does not have
 * @throws {LayoutFileError}
 */
export function readLayoutFile(text, isKnown) {
  if (text.length > FILE_LARGEST) throw new LayoutFileError("layouts.import.too_large");
  const { studio_layouts: version, layouts } =
    /** @type {{studio_layouts?: unknown, layouts?: unknown}} */ (parsed(text) ?? {});
  if (typeof version !== "number" || !Array.isArray(layouts))
    throw new LayoutFileError("layouts.import.no_layouts");
  if (version > FILE_VERSION) throw new LayoutFileError("layouts.import.newer");
  const read = readLayouts(layouts, isKnown);
  if (read.layouts.length === 0) throw new LayoutFileError("layouts.import.no_layouts");
  return read;
}

/** @param {string} text @returns {unknown} */
function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new LayoutFileError("layouts.import.no_json");
  }
}

/**
 * @param {readonly unknown[]} stored
 * @param {(id: string) => boolean} isKnown
 * @returns {{layouts: OwnLayout[], dropped: string[]}} those that can be read, each name once
 */
export function readLayouts(stored, isKnown) {
  /** @type {OwnLayout[]} */
  const layouts = [];
  const dropped = new Set();
  for (const one of stored.slice(0, LAYOUTS_MOST)) {
    const { name, arrangement } = /** @type {{name?: unknown, arrangement?: unknown}} */ (
      one ?? {}
    );
    const read = readArrangement(arrangement, isKnown);
    const called = typeof name === "string" ? tidyName(name) : "";
    if (!read || called === "") continue;
    layouts.push({ name: freeName(called, layouts), arrangement: read.arrangement });
    for (const id of read.dropped) dropped.add(id);
  }
  return { layouts, dropped: [...dropped] };
}

/** @param {string} name @returns {string} on one line and not too long */
export function tidyName(name) {
  return name.replace(/\s+/g, " ").trim().slice(0, NAME_LONGEST);
}

/** @param {string} name @param {readonly OwnLayout[]} taken @returns {string} it, or with a number behind it */
export function freeName(name, taken) {
  const isTaken = (/** @type {string} */ wanted) => taken.some((one) => one.name === wanted);
  if (!isTaken(name)) return name;
  let count = 2;
  while (isTaken(`${name} ${count}`)) count += 1;
  return `${name} ${count}`;
}

const STORE = "layouts";

/** Any panel is let through: one that this studio lacks is left out when the layout is shown. */
const anyPanel = () => true;

/** @returns {readonly OwnLayout[]} */
function stored() {
  const found = recall(STORE);
  return Array.isArray(found) ? readLayouts(found, anyPanel).layouts : [];
}

/** @type {Signal<readonly OwnLayout[]>} */
export const ownLayouts = signal(stored());
effect(() => remember(STORE, ownLayouts.value.length > 0 ? ownLayouts.value : undefined));

/** Name of the layout in use; empty: the studio's own. @type {Signal<string>} */
export const layoutInUse = remembered("layout.in_use", "");

/** @param {string} name @returns {Arrangement | null} */
const ownArrangement = (name) =>
  ownLayouts.value.find((one) => one.name === name)?.arrangement ?? null;

/** @param {string} name @param {Arrangement} arrangement under a name that exists it takes its place @returns {boolean} kept */
export function saveLayout(name, arrangement) {
  const called = tidyName(name);
  if (called === "") return false;
  const layout = { name: called, arrangement };
  const known = ownLayouts.value.some((one) => one.name === called);
  if (!known && ownLayouts.value.length >= LAYOUTS_MOST) return false;
  ownLayouts.value = known
    ? ownLayouts.value.map((one) => (one.name === called ? layout : one))
    : [...ownLayouts.value, layout];
  layoutInUse.value = called;
  return true;
}

/** @param {string} name @param {string} wanted @returns {boolean} false: that name is taken, or none */
export function renameLayout(name, wanted) {
  const called = tidyName(wanted);
  if (called === name) return true;
  if (called === "" || ownArrangement(called)) return false;
  ownLayouts.value = ownLayouts.value.map((one) =>
    one.name === name ? { ...one, name: called } : one,
  );
  if (layoutInUse.value === name) layoutInUse.value = called;
  return true;
}

/** @param {string} name */
export function deleteLayout(name) {
  ownLayouts.value = ownLayouts.value.filter((one) => one.name !== name);
  if (layoutInUse.value === name) layoutInUse.value = "";
}

/** @param {readonly OwnLayout[]} layouts from a file; none takes the place of another @returns {number} how many had room */
export function addLayouts(layouts) {
  const all = [...ownLayouts.value];
  for (const { name, arrangement } of layouts.slice(0, LAYOUTS_MOST - all.length))
    all.push({ name: freeName(name, all), arrangement });
  const added = all.length - ownLayouts.value.length;
  ownLayouts.value = all;
  return added;
}
