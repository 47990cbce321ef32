/** Copies of a shared robot: one's own, and all of them for those who lead the class. */

/** @import { CopyView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { allSettled } from "../lib/latest.js";
import { documentId, ownerOf, person, role } from "./connection.js";
import { ask, goTo } from "./requests.js";
import { notify } from "./view.js";
import { subscribe } from "./wire.js";

/** @type {Signal<readonly CopyView[]>} */
export const myCopies = signal([]);
/** Empty for who does not lead. @type {Signal<readonly CopyView[]>} */
export const allCopies = signal([]);

/** The copy that this page shows; null: a shared document. */
export const shownCopy = computed(() => {
  const id = documentId.value;
  return [...allCopies.value, ...myCopies.value].find((one) => one.document === id) ?? null;
});
/** This page shows somebody's copy, of which it may not know more than that. */
export const isCopy = computed(() => ownerOf(documentId.value) !== "");
export const isOwnCopy = computed(() => isCopy.value && ownerOf(documentId.value) === person.value);
/** One may have a copy of what this page shows. */
export const canCopy = computed(
  () =>
    !isCopy.value &&
    documentId.value !== "" &&
    (role.value === "student" || role.value === "helper"),
);

/** @param {string} who @returns {CopyView | undefined} their copy of what is shown, or else any */
export function copyOf(who) {
  const theirs = allCopies.value.filter((one) => one.person === who);
  return theirs.find((one) => one.of === documentId.value.split("~")[0]) ?? theirs[0];
}

/** @param {CopyView} copy @returns {boolean} it was handed in, and not sent back since */
export const isHandedIn = ({ handed_s: handed, remarked_s: remarked }) =>
  typeof handed === "number" && (typeof remarked !== "number" || handed > remarked);

subscribe("my_copies", (event) => {
  const before = new Map(myCopies.value.map((one) => [one.document, one]));
  myCopies.value = event.copies;
  for (const one of event.copies) {
    const known = before.get(one.document);
    if (known && known.remarked_s !== one.remarked_s) notify(t("copy.came_back"));
    if (known && one.shown && !known.shown) notify(t("copy.is_shown"));
  }
});

subscribe("copies", (event) => {
  const before = new Set(allCopies.value.filter(isHandedIn).map((one) => one.document));
  const isFirst = allCopies.value.length === 0;
  allCopies.value = event.copies;
  const handed = event.copies.find((one) => isHandedIn(one) && !before.has(one.document));
  if (handed && !isFirst) notify(t("copy.was_handed_in", { name: handed.name }));
});

/** Make a copy of what is shown, or go on with the one that there is. */
export async function openCopy() {
  const answer = await ask({ type: "open_copy" });
  if (answer?.type === "opened") goTo(answer.document);
}

export async function handIn() {
  await allSettled();
  if (await ask({ type: "hand_in" })) notify(t("copy.handed_in"));
}

/** @param {string} document */
export async function discardCopy(document) {
  if (await ask({ type: "discard_copy", document })) goTo(document.split("~")[0] ?? "");
}

/** @param {string} document @param {string} remark */
export const sendBack = (document, remark) => ask({ type: "send_back", document, remark });

/** @param {string} document @param {boolean} shown to all of the class */
export const showCopy = (document, shown) => ask({ type: "show_copy", document, shown });
