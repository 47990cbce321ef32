/** Bags among the files that come to the page: whether there is one, and where it is to be shown. */

/** @import { DroppedFile } from "../lib/files.js" */

import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { sizeWords } from "../lib/timeline.js";
import { documentId, mayEdit } from "../model/connection.js";
import { documentState } from "../model/document.js";
import { dialog, notify } from "../model/view.js";

const OF_BAG = /\.(mcap|db3)(\.zstd)?$/i;
const OF_ROBOT = /(\.(urdf|xacro)|(^|\/)package\.xml)$/i;
/** The list of what a zip holds is at its end; that of a bag is shorter than this. */
const LIST_BYTES = 1 << 16;
/** As many as the studio takes at once. */
const SENT_MAX_BYTES = 1 << 30;

/** @param {readonly DroppedFile[]} files @returns {Promise<boolean>} a bag is among them, and no robot */
export async function holdsBag(files) {
  const [only] = files;
  const isZip = files.length === 1 && only !== undefined && /\.zip$/i.test(only.path);
  const paths = isZip ? await listedIn(only.file) : files.map(({ path }) => path);
  return paths.some((one) => OF_BAG.test(one)) && !paths.some((one) => OF_ROBOT.test(one));
}

/** @param {Blob} zip @returns {Promise<string[]>} paths of the files in it, of a large one only the last */
async function listedIn(zip) {
  const end = new DataView(await zip.slice(-LIST_BYTES).arrayBuffer());
  const found = [];
  for (let at = 0; at + ENTRY_BYTES <= end.byteLength; at += 1) {
    if (end.getUint32(at, true) !== ENTRY) continue;
    const length = Math.min(end.getUint16(at + 28, true), end.byteLength - at - ENTRY_BYTES);
    const name = new Uint8Array(end.buffer, at + ENTRY_BYTES, length);
    found.push(new TextDecoder().decode(name));
  }
  return found;
}

/** What an entry of the list begins with, and how long it is before the name. */
const ENTRY = 0x02014b50;
const ENTRY_BYTES = 46;

/**
 * Have a bag sent to where it is to be shown: beside an open robot the person is asked.
 *
 * @param {readonly DroppedFile[]} files
 * @param {(beside: string) => void} upload `beside`: the document that shows it; empty: its own
 */
export function takeBag(files, upload) {
  const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
  const name = baseName(files[0]?.path.split("/")[0] ?? "");
  if (bytes > SENT_MAX_BYTES) {
    const sizes = { size: sizeWords(bytes), most: sizeWords(SENT_MAX_BYTES) };
    notify(t("bags.too_large", { name, ...sizes }), { bad: true, long: true });
    return;
  }
  const beside = documentId.peek();
  const robot = documentState.peek()?.title ?? "";
  if (beside === "" || robot === "" || !mayEdit.peek()) {
    upload("");
    return;
  }
  dialog.value = {
    kind: "confirm",
    title: t("bags.where", { name }),
    text: t("bags.where.text", { robot }),
    action: t("bags.own"),
    run: () => upload(""),
    other: { action: t("bags.beside", { robot }), run: () => upload(beside) },
  };
}
