/** Cells of tables that a spreadsheet opens. */

/** @param {string | number} value @returns {string} a text never begins a formula */
const harmless = (value) =>
  typeof value === "string" && /^[=+\-@\t\r]/.test(value) ? `'${value}` : String(value);

/** @param {string | number} value @returns {string} of a line parted by commas */
export function csvCell(value) {
  const text = harmless(value);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** @param {string | number} value @returns {string} of a line parted by tabs */
export const tsvCell = (value) => harmless(value).replace(/[\t\n\r]+/g, " ");
