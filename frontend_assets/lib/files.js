/** Files that the browser saves for the person. */

/** @param {string} name proposed; signs that a folder cannot hold are left out @param {string | Blob} text @param {string} [type] */
export function saveAsFile(name, text, type = "application/json") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name.replace(/[\\/:*?"<>|\p{Cc}]/gu, "_");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
