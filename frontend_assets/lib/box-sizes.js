/** How large the box around a name is, and what of the name stands in it. */

/** @import { Box } from "./node-graph.js" */

const LETTER_PX = 6.7;
const AROUND_PX = 22;
export const BOX_HEIGHT_PX = 26;
const LETTERS_MAX = 34;

/** @param {string} name @returns {string} names differ at their ends: of a long one the beginning goes */
export function boxWords(name) {
  const letters = [...name];
  return letters.length <= LETTERS_MAX ? name : `…${letters.slice(1 - LETTERS_MAX).join("")}`;
}

/** @param {Box} box @returns {string} of a namespace also how many nodes are in it */
export const boxLabel = ({ kind, name, count }) =>
  kind === "space" ? `${boxWords(name)} ${count}` : boxWords(name);

/** @param {Box} box @returns {number} px */
export const boxWidth = (box) => Math.round([...boxLabel(box)].length * LETTER_PX + AROUND_PX);
