/** Long lists in pieces small enough to draw, and where their rows stand in the whole. */

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
