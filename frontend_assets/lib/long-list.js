/** A list of which only what is near the view is drawn: a robot may have ten thousand links. */

/** @import { ComponentChildren } from "vendor/preact.js" */

import { html, useEffect, useLayoutEffect, useRef, useState } from "vendor/preact.js";

const SCROLLS = ".scroll, .tree";
const NEAR_PX = 500;
/** Lists up to here are drawn whole, so that the browser's own search finds all of them. */
const SHORT = 96;

/**
 * @typedef {object} LongListProps
 * @property {readonly any[]} items
 * @property {(item: any) => string} keyOf
 * @property {(item: any, index: number) => ComponentChildren} draw
 * @property {(item: any) => boolean} isKept stays drawn wherever the view is: what has the focus or is chosen
 * @property {string | ((piece: any[]) => string)} row how tall a row, or a piece, that was never drawn is taken to be, as CSS writes it
 * @property {number} [short] lists up to this length are drawn whole
 * @property {boolean} [inTable] the pieces are bodies of a table then
 */

/** @param {LongListProps} props */
export function LongList({ items, keyOf, draw, isKept, row, short = SHORT, inTable = false }) {
  let first = 0;
  return inPieces(items).map((piece) => {
    const from = first;
    first += piece.length;
    const kept = items.length <= short || piece.some(isKept);
    return html`<${Piece} key=${keyOf(piece[0])} count=${piece.length} kept=${kept} room=${typeof row === "string" ? `calc(${piece.length} * ${row})` : row(piece)} inTable=${inTable}
      draw=${() => piece.map((item, n) => draw(item, from + n))} />`;
  });
}

/** @param {{count: number, kept: boolean, room: string, inTable: boolean, draw: () => ComponentChildren}} props */
function Piece({ count, kept, room, inTable, draw }) {
  const element = useRef(/** @type {HTMLElement | null} */ (null));
  const [near, setNear] = useState(false);
  const drawnCount = useRef(0);
  const measured = useRef({ count: 0, height: "" });
  // What is in view at first is drawn before the first picture, so that nothing moves after it.
  useLayoutEffect(() => {
    const piece = element.current;
    if (piece && isInView(piece)) setNear(true);
  }, []);
  useEffect(() => {
    const piece = element.current;
    if (!piece) return undefined;
    return watch(piece, (seen) => {
      // In a panel behind another one it has no place: it is left as it was.
      if (piece.getClientRects().length === 0) return;
      if (!seen && drawnCount.current > 0)
        measured.current = { count: drawnCount.current, height: `${piece.offsetHeight}px` };
      setNear(seen || piece.contains(document.activeElement));
    });
  }, []);
  const drawn = near || kept;
  drawnCount.current = drawn ? count : 0;
  const known = measured.current.count === count;
  const height = known ? measured.current.height : room;
  if (inTable) {
    // One cell is enough, and spans no column that a narrow panel hides: that would take room.
    const empty = html`<tr aria-hidden="true"><td style=${`padding:0;border:0;height:${height}`}></td></tr>`;
    return html`<tbody ref=${element}>${drawn ? draw() : empty}</tbody>`;
  }
  return html`<div role="none" ref=${element} style=${drawn ? "" : `height:${height}`}>${drawn && draw()}</div>`;
}

/** @param {HTMLElement} piece */
function isInView(piece) {
  const view = piece.closest(SCROLLS)?.getBoundingClientRect();
  const { top, bottom } = piece.getBoundingClientRect();
  return view !== undefined && top < view.bottom && bottom > view.top;
}

/** @type {WeakMap<Element, IntersectionObserver>} one for each list that scrolls */
const watchers = new WeakMap();
/** @type {WeakMap<Element, (seen: boolean) => void>} by piece */
const tellers = new WeakMap();

/** @param {HTMLElement} piece @param {(seen: boolean) => void} tell near the view or not any more @returns {() => void} the end of it */
function watch(piece, tell) {
  const list = piece.closest(SCROLLS) ?? document.body;
  const watcher = watchers.get(list) ?? newWatcher(list);
  watchers.set(list, watcher);
  tellers.set(piece, tell);
  watcher.observe(piece);
  return () => watcher.unobserve(piece);
}

/** @param {Element} root */
function newWatcher(root) {
  return new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) tellers.get(target)?.(isIntersecting);
    },
    { root, rootMargin: `${NEAR_PX}px 0px` },
  );
}

const PIECE = 24;

/** @template T @param {readonly T[]} items @returns {T[][]} pieces that are drawn when they come into view */
export function inPieces(items) {
  return Array.from({ length: Math.ceil(items.length / PIECE) }, (_, n) =>
    items.slice(n * PIECE, (n + 1) * PIECE),
  );
}

/**
 * What a screen reader counts by itself only while every row of a tree is in the page.
 *
 * @param {readonly number[]} levels of the rows of a tree, as they are shown
 * @returns {{at: number, of: number}[]} each one's place among its siblings, from 1
 */
export function siblingPlaces(levels) {
  /** @type {number[]} */
  const sizes = [];
  /** @type {number[]} */
  let familyAt = [];
  const placed = levels.map((level) => {
    familyAt = familyAt.length > level + 1 ? familyAt.slice(0, level + 1) : familyAt;
    familyAt[level] ??= sizes.push(0) - 1;
    const family = familyAt[level] ?? 0;
    sizes[family] = (sizes[family] ?? 0) + 1;
    return { family, at: sizes[family] ?? 0 };
  });
  return placed.map(({ family, at }) => ({ at, of: sizes[family] ?? at }));
}
