/**
 * The masses of the links: asked for while a panel shows them, sorted, held against the links'
 * volumes, and as text.
 */

/** @import { LinkMassView, LinkView, VolumeView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Pose, Triple } from "../lib/kinematics.js" */

import { signal } from "vendor/preact.js";
import { csvCell, tsvCell } from "../lib/csv.js";
import { moved } from "../lib/kinematics.js";
import { askOrKeepWhy, askWhenBuilt, sharedFollowing } from "./asking.js";

/** A drag is not slowed by what it weighs. */
const REST_MS = 150;

/** Links that have an inertial, in the order of the robot; null until they are known. @type {Signal<readonly LinkMassView[] | null>} */
export const masses = signal(null);

/** Why the last request for them failed; empty: it did not. */
export const massesRefused = signal("");

/** Keep `masses` true while somebody looks. @type {() => () => void} gives the end of looking */
export const followMasses = sharedFollowing(() => askWhenBuilt(askMasses, REST_MS));

/** Ask for them again. */
export async function askMasses() {
  const answer = await askOrKeepWhy({ type: "get_masses" }, massesRefused);
  if (answer?.type === "masses") masses.value = answer.links;
}

/** Below and above these no robot is built of anything, kg/m3, as the checks of the studio see it. */
const DENSITIES = { least: 5, most: 20_000 };

/** @typedef {"link" | "mass" | "moment" | "density"} MassOrder */
/**
 * @typedef {object} Density
 * @property {number} kg_m3
 * @property {boolean} isExact else at least that: the volume is at most what is known
 * @property {"collision" | "visual"} of which shapes
 */
/**
 * @typedef {object} MassRow
 * @property {LinkMassView} mass
 * @property {number} share of the sum, 0 to 1
 * @property {Density | null} density
 * @property {LinkView | null} link
 */

/** @param {readonly LinkMassView[]} masses @returns {number} kg; what is negative weighs nothing */
export const sumOf = (masses) => masses.reduce((sum, { mass_kg: kg }) => sum + Math.max(kg, 0), 0);

/**
 * @param {readonly LinkMassView[]} masses
 * @param {readonly LinkView[]} links
 * @returns {MassRow[]}
 */
export function massRows(masses, links) {
  const sum = sumOf(masses);
  const byName = new Map(links.map((link) => [link.name, link]));
  return masses.map((mass) => ({
    mass,
    share: sum > 0 ? Math.max(mass.mass_kg, 0) / sum : 0,
    density: densityOf(mass),
    link: byName.get(mass.link) ?? null,
  }));
}

/** @param {LinkMassView} mass @returns {Density | null} as exact as can be said; null: nothing is known to hold it against */
export function densityOf({ mass_kg: kg, collision, visual }) {
  const found = /** @type {const} */ ([
    ["collision", collision],
    ["visual", visual],
  ]).flatMap(([of, one]) => densityIn(kg, of, one));
  return found.find(({ isExact }) => isExact) ?? found[0] ?? null;
}

/** @param {number} kg @param {"collision" | "visual"} of @param {VolumeView | null} one @returns {Density[]} */
function densityIn(kg, of, one) {
  if (!one || !(one.volume_m3 > 0)) return [];
  return [{ kg_m3: kg / one.volume_m3, isExact: one.is_exact, of }];
}

/** @param {Density} density @returns {boolean} no robot is made of such a thing */
export function isOddDensity({ kg_m3: value, isExact }) {
  return value > DENSITIES.most || (isExact && value < DENSITIES.least);
}

/** @param {LinkMassView} mass @returns {boolean} some body turns like that */
export function isPossible({ mass_kg: kg, moments_kg_m2: moments }) {
  if (!(kg > 0) || !moments) return false;
  const [least, middle, most] = moments;
  const slack = 1e-6 * Math.abs(most);
  return most > 0 && least >= -slack && most <= least + middle + slack;
}

/** @type {Record<MassOrder, (row: MassRow) => number>} */
const SIZE = {
  link: () => 0,
  mass: ({ mass }) => mass.mass_kg,
  moment: ({ mass }) => mass.moments_kg_m2?.[2] ?? Number.NEGATIVE_INFINITY,
  density: ({ density }) => density?.kg_m3 ?? Number.NEGATIVE_INFINITY,
};

/** @param {readonly MassRow[]} rows @param {MassOrder} order `link`: as in the robot; else the most first @returns {MassRow[]} */
export function sortedMasses(rows, order) {
  const size = SIZE[order];
  return [...rows].sort((a, b) => size(b) - size(a));
}

/** @param {readonly MassRow[]} rows @param {string} words @returns {MassRow[]} */
export function matchingMasses(rows, words) {
  const wanted = words.trim().toLowerCase();
  return rows.filter(({ mass }) => mass.link.toLowerCase().includes(wanted));
}

/**
 * @param {readonly LinkMassView[]} masses
 * @param {ReadonlyMap<string, Pose>} poses of the links in the root frame
 * @returns {Triple | null} centre of mass of them all in the root frame, m; null without mass
 */
export function centreOfMass(masses, poses) {
  const sum = [0, 0, 0];
  let kg = 0;
  for (const { link, mass_kg: one, centre_m: centre } of masses) {
    const pose = poses.get(link);
    if (!pose || !(one > 0)) continue;
    kg += one;
    moved(pose, centre).forEach((value, at) => {
      sum[at] = /** @type {number} */ (sum[at]) + one * value;
    });
  }
  const [x = 0, y = 0, z = 0] = sum;
  return kg > 0 ? [x / kg, y / kg, z / kg] : null;
}

const HEADS = [
  ...["link", "mass_kg", "share", "com_x_m", "com_y_m", "com_z_m", "ixx", "ixy", "ixz", "iyy"],
  ...[
    "iyz",
    "izz",
    "moment_1",
    "moment_2",
    "moment_3",
    "collision_m3",
    "visual_m3",
    "file",
    "line",
  ],
];

/**
 * @param {readonly MassRow[]} rows
 * @param {"csv" | "tsv"} form
 * @returns {string} one line for each link, all digits
 */
export function massText(rows, form) {
  const lines = rows.map(({ mass, share, link }) => [
    mass.link,
    ...[mass.mass_kg, share, ...mass.centre_m, ...mass.inertia_kg_m2],
    ...(mass.moments_kg_m2 ?? ["", "", ""]),
    ...[mass.collision?.volume_m3 ?? "", mass.visual?.volume_m3 ?? ""],
    ...[link?.file ?? "", link?.line || ""],
  ]);
  const write = form === "csv" ? csvCell : tsvCell;
  const between = form === "csv" ? "," : "\t";
  return `${[HEADS, ...lines].map((line) => line.map(write).join(between)).join("\n")}\n`;
}
