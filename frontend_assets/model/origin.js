/**
 * Where the selected part comes from, and what a property shapes: asked of the studio while a
 * panel shows it.
 */

/** @import { Aspect, Effects, OriginAttribute, PartOrigin } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { batch, computed, effect, signal, untracked } from "vendor/preact.js";
import { parseNumber, shownNumber, toDegrees } from "../lib/numbers.js";
import { connection } from "./connection.js";
import { built, robot, site } from "./document.js";
import { onlySelected, part, selected } from "./selection.js";
import { litPlaces } from "./source.js";
import { RefusedError, send } from "./wire.js";

/** The pointer rests so long before anything is asked. */
const REST_MS = 70;
/** So long nothing was built before an answer is asked for again: not at every step of a drag. */
const SETTLE_MS = 250;
/** Answers of one run that are kept. */
const KEPT = 500;

/** What the studio told of a part; `refused` says why it told nothing. @typedef {{part: string, origin: PartOrigin | null, refused: string}} KnownOrigin */
/** @type {Signal<KnownOrigin | null>} */
export const origin = signal(null);

/** Keep `origin` true while somebody looks. @returns {() => void} the end of looking */
export function followOrigin() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  const end = effect(() => {
    const key = part.value;
    built.value;
    const there = connection.value === "connected" && robot.value !== null;
    clearTimeout(later);
    const known = untracked(() => origin.value?.part === key);
    if (there && key) later = setTimeout(() => askOrigin(key), known ? SETTLE_MS : 0);
  });
  return () => {
    clearTimeout(later);
    end();
  };
}

/** @param {string} key of the part */
export async function askOrigin(key) {
  try {
    const answer = await send({ type: "get_origin", part: key });
    if (answer.type === "origin" && part.peek() === key)
      origin.value = { part: key, origin: answer.origin, refused: "" };
  } catch (error) {
    // When the lane was lost, it is asked again with the next one.
    if (part.peek() === key && error instanceof RefusedError)
      origin.value = { part: key, origin: null, refused: error.message };
  }
}

/** Ids of all that shapes a link or the joint that holds it. @typedef {{link: string, sites: ReadonlySet<string>}} Shaping */
/** @type {Signal<Shaping | null>} */
export const shaping = signal(null);

/** Keep `shaping` true of the selected link while only its properties are listed. @returns {() => void} the end of it */
export function followShaping() {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  const end = effect(() => {
    const link = onlySelected.value && connection.value === "connected" ? selected.value : null;
    const joint = robot.value?.joints.find(({ child }) => child === link)?.name;
    built.value;
    clearTimeout(later);
    const again = untracked(() => shaping.value?.link === link);
    if (link) later = setTimeout(() => askShaping(link, joint), again ? SETTLE_MS : 0);
  });
  return () => {
    clearTimeout(later);
    end();
  };
}

/** @param {string} link @param {string | undefined} joint */
async function askShaping(link, joint) {
  const parts = [`link:${link}`, ...(joint === undefined ? [] : [`joint:${joint}`])];
  const asked = parts.map((one) => send({ type: "get_origin", part: one }).catch(() => null));
  const sites = new Set();
  for (const answer of await Promise.all(asked)) {
    if (answer?.type !== "origin") return;
    const { attributes, inputs } = answer.origin;
    for (const one of [...attributes, ...inputs]) if (one.site) sites.add(one.site);
  }
  if (selected.peek() === link) shaping.value = { link, sites };
}

/** What the pointed-at property shapes, as soon as it is known. @type {Signal<Effects | null>} */
export const effects = signal(null);

/** @type {Signal<string | null>} */
export const pointedSite = signal(null);
/** The run before which it was pointed at. @type {Signal<unknown>} */
const pointedRun = signal(null);
/** Answers that are true of the run `knownOf`. @type {Map<string, Effects>} */
const known = new Map();
let knownOf = built.peek();
/** @type {ReturnType<typeof setTimeout> | undefined} */
let asking;

/** What is said of something pointed at that is no property of its own. */
export const pointedWords = signal("");

/**
 * Tell what a property shapes: its parts light up in 3D, and who reads it in the source.
 *
 * @param {string | null} id of the property under the pointer or with the focus; null: none any more
 * @param {string} [words] what to say where there is no property
 */
export function hoverSite(id, words = "") {
  batch(() => {
    pointedWords.value = words;
    pointedSite.value = id;
    pointedRun.value = built.peek();
  });
}

/** What lights up in 3D: nothing any more once an edit shows by itself what it does. */
export const lights = computed(() => (built.value === pointedRun.value ? effects.value : null));

effect(() => {
  const id = pointedSite.value;
  if (knownOf !== built.value) known.clear();
  knownOf = built.value;
  clearTimeout(asking);
  const shown = untracked(() => effects.value);
  const answer = id === null ? null : known.get(id);
  const again = id !== null && shown?.site === id;
  if (answer || !again) effects.value = answer ?? null;
  if (id !== null && !answer)
    asking = setTimeout(() => askEffects(id), again ? SETTLE_MS : REST_MS);
});

/** @param {string} id */
async function askEffects(id) {
  const run = built.peek();
  const answer = await send({ type: "get_effects", site: id }).catch(() => null);
  if (answer?.type !== "effects") return;
  if (run === built.peek()) {
    if (known.size >= KEPT) known.clear();
    known.set(id, answer);
  }
  if (pointedSite.peek() === id) effects.value = answer;
}

effect(() => {
  const id = pointedSite.value;
  const place = id === null ? null : site(id)?.peek();
  const readers = effects.value?.site === id ? effects.value.readers : [];
  litPlaces.value = place ? [{ file: place.file, line: place.line }, ...readers] : [];
});

/** @typedef {{element: string, attributes: OriginAttribute[]}} ElementGroup */

/** @param {readonly OriginAttribute[]} attributes @returns {ElementGroup[]} runs of one element */
export function byElement(attributes) {
  /** @type {ElementGroup[]} */
  const groups = [];
  for (const one of attributes) {
    const last = groups.at(-1);
    if (last?.element === one.element) last.attributes.push(one);
    else groups.push({ element: one.element, attributes: [one] });
  }
  return groups;
}

/**
 * @param {string} value one number, or several with blanks between
 * @param {string} unit of the file
 * @param {boolean} degrees angles are shown so
 * @returns {string} shortened to what one can take in, with its unit; other texts as they are
 */
export function valueText(value, unit, degrees) {
  const words = value.trim().split(/\s+/);
  const numbers = words.map(parseNumber);
  if (value.trim() === "" || numbers.some((one) => one === null)) return value;
  const turns = unit === "rad" && degrees;
  const shown = numbers.map((one) => shownNumber(turns ? toDegrees(Number(one)) : Number(one)));
  return `${shown.join("  ")} ${turns ? "°" : unit}`.trim();
}

/** @param {string} text @returns {boolean} something in it was computed or looked up */
export const isComputed = (text) => text.includes("$");

/** By element and attribute: the kind of part that the attribute names. @type {Record<string, string>} */
const REFERENCES = { "parent@link": "link", "child@link": "link", "mimic@joint": "joint" };

/** @param {OriginAttribute} attribute @returns {string | null} key of another part that it names */
export function referredPart({ element, attribute, value }) {
  const kind = REFERENCES[`${element}@${attribute}`];
  return kind ? `${kind}:${value}` : null;
}

/** Aspects in the order in which they are told. */
const ASPECTS = /** @type {const} */ ([
  "size",
  "shape",
  "color",
  "pose",
  "motion",
  "inertia",
  "collision",
  "presence",
  "name",
  "other",
]);

/** @param {Readonly<Record<string, number>>} counts parts by aspect @returns {{aspect: Aspect, count: number}[]} */
export function countedAspects(counts) {
  return ASPECTS.flatMap((aspect) => {
    const count = counts[aspect] ?? 0;
    return count > 0 ? [{ aspect, count }] : [];
  });
}
