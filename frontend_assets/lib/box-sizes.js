/** How large the box around a name is, and what of the name stands in it. */

const LETTER_PX = 6.7;
const AROUND_PX = 22;
export const BOX_HEIGHT_PX = 26;
const LETTERS_MAX = 34;

/** @param {string} name @returns {string} names differ at their ends: of a long one the beginning goes */
export function boxWords(name) {
  const letters = [...name];
  return letters.length <= LETTERS_MAX ? name : `…${letters.slice(1 - LETTERS_MAX).join("")}`;
}

/** @param {string} name @returns {number} px */
export const boxWidth = (name) => Math.round([...boxWords(name)].length * LETTER_PX + AROUND_PX);
