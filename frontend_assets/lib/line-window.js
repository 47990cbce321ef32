/** Which rows of a long list of equal heights are near the view: only these are drawn. */

/** Rows beyond the view, so that a turn of the wheel finds them drawn. */
const BEYOND = 12;

/**
 * @param {{count: number, row_px: number, top_px: number, view_px: number}} list how far it is scrolled, and how high its view is
 * @returns {{from: number, to: number}} rows, the last one not among them
 */
export function rowsNear({ count, row_px, top_px, view_px }) {
  if (row_px <= 0) return { from: 0, to: 0 };
  const first = Math.floor(top_px / row_px) - BEYOND;
  const last = Math.ceil((top_px + view_px) / row_px) + BEYOND;
  const from = Math.max(0, Math.min(first, count));
  return { from, to: Math.max(from, Math.min(last, count)) };
}
