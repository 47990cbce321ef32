/**
 * Makes ../vendor: each third-party library as one minified ES module, its licence and its sha256.
 * `node vendor.mjs` writes, `node vendor.mjs --check` only compares.
 */
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import * as lucide from "lucide";

const TOOLS = dirname(fileURLToPath(import.meta.url));
const VENDOR = join(TOOLS, "..", "vendor");

const PREACT = `
export { Fragment, createContext, createRef, h, render } from "preact";
export { useCallback, useContext, useEffect, useId, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
export { batch, computed, effect, signal, untracked, useComputed, useSignal, useSignalEffect } from "@preact/signals";
import htm from "htm";
import { h } from "preact";
export const html = htm.bind(h);
`;

const CODEMIRROR = [
  "@codemirror/state",
  "@codemirror/view",
  "@codemirror/commands",
  "@codemirror/language",
  "@codemirror/autocomplete",
  "@codemirror/search",
  "@codemirror/lint",
  "@codemirror/lang-python",
  "@codemirror/lang-xml",
  "@codemirror/lang-yaml",
  "@lezer/highlight",
];

/** What the packages above draw in; two copies of any of them would not know each other. */
const CODEMIRROR_INNER = [
  "@codemirror/streamparser",
  "@lezer/common",
  "@lezer/lr",
  "@lezer/python",
  "@lezer/xml",
  "@lezer/yaml",
  "@marijn/find-cluster-break",
  "crelt",
  "style-mod",
  "w3c-keyname",
];

const DOCKVIEW_CSS = '@import "dockview/dist/styles/dockview.css";';

/** Lucide's name of each icon that the page uses, by our own. */
const ICONS = {
  alert: "TriangleAlert",
  animate: "Play",
  arguments: "Variable",
  arrow: "MoveUpRight",
  axes: "Move3d",
  bag: "CassetteTape",
  bookmark: "Bookmark",
  box: "Box",
  branch: "GitBranch",
  camera: "Camera",
  check: "Check",
  chevronDown: "ChevronDown",
  chevronRight: "ChevronRight",
  clipboard: "ClipboardPaste",
  close: "X",
  cloud: "ChartScatter",
  collapse: "ChevronsDownUp",
  compare: "GitCompareArrows",
  compass: "Compass",
  cone: "Cone",
  control: "Gamepad2",
  copy: "Copy",
  crosshair: "Crosshair",
  cube: "Cuboid",
  definition: "SquareArrowOutUpRight",
  disk: "Save",
  dock: "PanelsTopLeft",
  dots: "EllipsisVertical",
  download: "Download",
  error: "CircleAlert",
  expand: "ChevronsUpDown",
  eye: "Eye",
  eyeOff: "EyeOff",
  file: "File",
  fileCode: "FileCode",
  filePlus: "FilePlus",
  filter: "ListFilter",
  fit: "Focus",
  float: "PictureInPicture2",
  folder: "Folder",
  folderOpen: "FolderOpen",
  fork: "GitFork",
  frames: "Axis3d",
  fullscreen: "Fullscreen",
  ghost: "Ghost",
  goal: "Goal",
  grid: "Grid3x3",
  hand: "Hand",
  help: "CircleQuestionMark",
  history: "History",
  home: "House",
  humidity: "Droplets",
  includes: "FolderTree",
  info: "Info",
  interact: "Pointer",
  joints: "Gauge",
  jump: "CornerDownRight",
  keyboard: "Keyboard",
  layout: "LayoutDashboard",
  lessons: "GraduationCap",
  link: "Link2",
  list: "ListTree",
  lock: "Lock",
  listening: "Ear",
  live: "Radio",
  log: "ScrollText",
  loop: "Repeat",
  macro: "Braces",
  map: "Map",
  maximize: "Maximize",
  measure: "Ruler",
  minimize: "Minimize",
  minus: "Minus",
  moon: "Moon",
  mouse: "Mouse",
  move: "Move",
  node: "CircuitBoard",
  odometry: "Footprints",
  open: "FolderOpen",
  origin: "Waypoints",
  package: "Package",
  pause: "Pause",
  pencil: "Pencil",
  pin: "MapPin",
  plot: "ChartLine",
  plus: "Plus",
  polygon: "Hexagon",
  pose: "Navigation",
  problems: "TriangleAlert",
  properties: "SlidersHorizontal",
  radar: "Radar",
  random: "Dices",
  redo: "Redo2",
  reload: "RefreshCw",
  reset: "RotateCcw",
  robot: "Bot",
  route: "Route",
  scene: "Box",
  scissors: "Scissors",
  search: "Search",
  select: "SquareDashedMousePointer",
  send: "Send",
  shapes: "Shapes",
  settings: "Settings",
  share: "Share2",
  skipBack: "SkipBack",
  source: "CodeXml",
  stepBack: "StepBack",
  stepForward: "StepForward",
  stop: "Square",
  stopSign: "OctagonX",
  sun: "Sun",
  system: "Monitor",
  target: "LocateFixed",
  thermometer: "Thermometer",
  trash: "Trash2",
  undo: "Undo2",
  up: "CornerLeftUp",
  upload: "Upload",
  users: "Users",
  urdf: "FileCode",
  variants: "SwatchBook",
  views: "Rotate3d",
  wand: "WandSparkles",
  watching: "Eye",
  zero: "CircleDot",
  zip: "FileArchive",
};

/** @returns {string} the icons as a module: our name to Lucide's shapes */
function iconsModule() {
  const all = new Map(Object.entries(lucide));
  const shapes = Object.entries(ICONS).map(([name, lucideName]) => {
    const shape = all.get(lucideName);
    if (!shape) throw new Error(`lucide has no icon ${lucideName}`);
    return [name, shape];
  });
  return `export const ICONS = ${JSON.stringify(Object.fromEntries(shapes))};`;
}

/** @param {string} contents @param {"js" | "ts" | "css"} [loader] @returns {Promise<string>} one minified file */
async function bundle(contents, loader = "js") {
  const made = await build({
    stdin: { contents, resolveDir: TOOLS, loader },
    bundle: true,
    format: "esm",
    legalComments: "none",
    minify: true,
    target: "es2022",
    write: false,
  });
  return made.outputFiles[0].text;
}

/** @param {string} css of dockview @returns {string} without its themes, for the page has its own */
function withoutThemes(css) {
  return css.replaceAll(/([^{}@]+)\{[^{}]*\}/g, (rule, /** @type {string} */ selectors) =>
    selectors.split(",").every((one) => one.includes(".dockview-theme-")) ? "" : rule,
  );
}

/** @param {string} name @returns {Promise<{version: string, license: string, text: string}>} */
async function licence(name) {
  const folder = join(TOOLS, "node_modules", name);
  const about = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
  for (const file of ["LICENSE", "LICENSE.md", "LICENCE.md", "LICENSE.txt"]) {
    const text = await readFile(join(folder, file), "utf8").catch(() => "");
    if (text) return { version: about.version, license: about.license, text: text.trim() };
  }
  throw new Error(`${name} carries no licence text`);
}

/** Files of ../vendor: how each is made and of which packages. */
const FILES = {
  "preact.js": {
    make: () => bundle(PREACT),
    from: ["preact", "@preact/signals", "@preact/signals-core", "htm"],
  },
  "dockview.js": {
    make: () => bundle('export { createDockview } from "dockview";'),
    from: ["dockview", "dockview-core"],
  },
  "codemirror.js": {
    make: async () => bundle(await readFile(join(VENDOR, "codemirror.d.ts"), "utf8"), "ts"),
    from: [...CODEMIRROR, ...CODEMIRROR_INNER],
  },
  "dockview.css": {
    make: async () => withoutThemes(await bundle(DOCKVIEW_CSS, "css")),
    from: ["dockview"],
  },
  "uplot.js": { make: () => bundle('export { default } from "uplot";'), from: ["uplot"] },
  "uplot.css": {
    make: () => bundle('@import "uplot/dist/uPlot.min.css";', "css"),
    from: ["uplot"],
  },
  "icons.js": { make: () => bundle(iconsModule()), from: ["lucide"] },
};

/** @returns {Promise<Map<string, string>>} every generated file of ../vendor by its name */
async function makeAll() {
  const texts = new Map();
  const lock = [];
  for (const [file, { make, from }] of Object.entries(FILES)) {
    const text = await make();
    texts.set(file, text);
    const packages = await Promise.all(
      from.map(async (name) => ({ name, version: (await licence(name)).version })),
    );
    lock.push({ file, sha256: createHash("sha256").update(text).digest("hex"), packages });
  }
  texts.set("vendor.lock.json", `${JSON.stringify(lock, null, 2)}\n`);
  texts.set("LICENSES.txt", await licences());
  return texts;
}

/** @returns {Promise<string>} all licence texts, one after the other */
async function licences() {
  const names = [...new Set(Object.values(FILES).flatMap(({ from }) => from))].sort();
  const parts = await Promise.all(
    names.map(async (name) => {
      const { version, license, text } = await licence(name);
      return `${name} ${version} (${license})\n\n${text}\n`;
    }),
  );
  return parts.join(`\n${"-".repeat(72)}\n\n`);
}

const check = process.argv.includes("--check");
await mkdir(VENDOR, { recursive: true });
let stale = 0;
for (const [file, text] of await makeAll()) {
  const path = join(VENDOR, file);
  const old = await readFile(path, "utf8").catch(() => "");
  if (old === text) continue;
  stale += 1;
  if (check) process.stderr.write(`${file} is not what vendor.mjs makes: run npm run vendor\n`);
  else await writeFile(path, text);
}
process.exit(check && stale ? 1 : 0);
