/**
 * Files that come into the page, dropped or chosen in a file window, with their paths, folders
 * gone through; and files that it saves for the person.
 */

/** @typedef {{path: string, file: File}} DroppedFile */

const FILES_AT_MOST = 10_000;
const LEFT_OUT = new Set(["node_modules", "__pycache__"]);

/** @param {string} name @returns {boolean} hidden, or made by a tool: of no use for a robot */
const isLeftOut = (name) => name.startsWith(".") || LEFT_OUT.has(name);

/** @param {DataTransfer | null} transfer @returns {boolean} it holds files, not a text or a tab of ours */
export function holdsFiles(transfer) {
  return transfer?.types.includes("Files") ?? false;
}

/**
 * To be called while the drop is handled: what it holds is gone a moment later.
 *
 * @param {DataTransfer} transfer
 * @returns {Promise<DroppedFile[]>}
 */
export async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  const plain = [...transfer.files];
  if (entries.every((entry) => entry === null)) return chosenFiles(plain);
  /** @type {DroppedFile[]} */
  const found = [];
  for (const entry of entries) if (entry) await collect(entry, "", found);
  return found;
}

/** @param {Iterable<File>} files of an `<input type="file">` @returns {DroppedFile[]} */
export function chosenFiles(files) {
  return [...files]
    .map((file) => ({ path: file.webkitRelativePath || file.name, file }))
    .filter(({ path }) => !path.split("/").some(isLeftOut));
}

/** @param {FileSystemEntry} entry @param {string} folder with its slash @param {DroppedFile[]} found */
async function collect(entry, folder, found) {
  if (found.length > FILES_AT_MOST || (isLeftOut(entry.name) && folder !== "")) return;
  const path = folder + entry.name;
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => {
      /** @type {FileSystemFileEntry} */ (entry).file(resolve, reject);
    });
    found.push({ path, file });
    return;
  }
  for (const inner of await insideOf(/** @type {FileSystemDirectoryEntry} */ (entry))) {
    await collect(inner, `${path}/`, found);
  }
}

/** @param {FileSystemDirectoryEntry} folder @returns {Promise<FileSystemEntry[]>} */
async function insideOf(folder) {
  const reader = folder.createReader();
  /** @type {FileSystemEntry[]} */
  const all = [];
  for (;;) {
    // A browser tells them a hundred at a time, and an empty list at the end.
    /** @type {FileSystemEntry[]} */
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...some);
  }
}

/**
 * Files that the browser saves for the person.
 *
 * @param {string} name proposed; signs that a folder cannot hold are left out
 * @param {string | Blob} text
 * @param {string} [type]
 */
export function saveAsFile(name, text, type = "application/json") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name.replace(/[\\/:*?"<>|\p{Cc}]/gu, "_");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
