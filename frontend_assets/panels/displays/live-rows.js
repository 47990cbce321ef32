/** Displays of what others publish, as rows of the tree: by group, with their state and their settings. */

/** @import { Drop } from "../../lib/live-displays.js" */
/** @import { DisplayState, DisplayView } from "../../types/wire.d.ts" */
/** @import { Row } from "./tree.js" */

import { html, signal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { dropOn, firstTrouble, inGroups, rateWords } from "../../lib/live-displays.js";
import { Icon } from "../../lib/ui.js";
import { documentId, mayEdit } from "../../model/connection.js";
import {
  addDisplay,
  displayStates,
  groupsOff,
  kinds,
  liveDisplays,
  mendDisplay,
  needKinds,
  placeDisplays,
  switchDisplay,
  switchGroup,
} from "../../model/live-displays.js";
import { dialog } from "../../model/view.js";
import { endDrag, takesDrop, dragged as topic } from "../topic-drag.js";
import { displayKeys, groupKeys, NameBox, RowMenu, renaming } from "./live-menu.js";
import { settingsOf } from "./live-settings.js";

/** Id of the row that is dragged; empty: none. */
const dragged = signal("");
/** Where it would be dropped now. @type {import("vendor/preact.js").Signal<{row: string, where: Drop["where"]} | null>} */
const goal = signal(null);

/** @param {string} row @returns {string} a class that marks where it would come to stand */
function dropMark(row) {
  if (dragged.value === row) return "dragged";
  return goal.value?.row === row ? `drop-${goal.value.where}` : "";
}

/** @param {string} row its id; it can be dragged, and be dropped on @returns {Record<string, unknown>} attributes of its element */
const draggable = (row) => ({
  draggable: true,
  onDragStart: (/** @type {DragEvent} */ event) => {
    dragged.value = row;
    event.dataTransfer?.setData("text/plain", "");
    if (event.dataTransfer) event.dataTransfer.effectAllowed = "move";
  },
  onDragEnd: end,
  ...droppable(row),
});

/** @param {string} row @returns {Record<string, unknown>} */
const droppable = (row) => ({
  onDragOver: (/** @type {DragEvent} */ event) => {
    const drop = dropAt(event, row);
    const where = drop?.where ?? null;
    if (goal.peek()?.row !== row || goal.peek()?.where !== where)
      goal.value = where && { row, where };
    if (drop) event.preventDefault();
  },
  onDragLeave: () => {
    if (goal.peek()?.row === row) goal.value = null;
  },
  onDrop: (/** @type {DragEvent} */ event) => {
    const drop = dropAt(event, row);
    if (!drop) return;
    event.preventDefault();
    event.stopPropagation();
    end();
    placeDisplays(drop.moves);
  },
});

/** A topic of which there is a display may be dropped on the panel. @param {DragEvent} event */
export function takeTopic(event) {
  if (topic.peek()?.kind && mayEdit.peek()) takesDrop(event);
}

/** @param {DragEvent} event the display that shows the topic listens as the topic is published */
export function dropTopic(event) {
  const what = topic.peek();
  if (!what?.kind || !mayEdit.peek()) return;
  event.preventDefault();
  endDrag();
  addDisplay(what.kind, what.topic);
}

function end() {
  dragged.value = "";
  goal.value = null;
}

/** @param {DragEvent} event @param {string} row @returns {Drop | null} null: nothing of ours is dragged, or it cannot go there */
function dropAt(event, row) {
  if (dragged.peek() === "") return null;
  const { top, height } = /** @type {HTMLElement} */ (event.currentTarget).getBoundingClientRect();
  return dropOn(liveDisplays.peek(), dragged.peek(), row, (event.clientY - top) / height);
}

/** What is said of all displays at once is said below the first one only. */
const SAID_ONCE = new Set(["not_connected", "connection_lost"]);
/** Rows of displays and of their settings that are unfolded: at first none is. @type {import("vendor/preact.js").Signal<ReadonlySet<string>>} */
const unfolded = signal(new Set());
const isOpen = (/** @type {string} */ id) => unfolded.value.has(id);

/** @param {string} id of a row @param {boolean} open @returns {boolean} it was one of ours */
export function setLiveOpen(id, open) {
  if (!/^(display|setting):/.test(id)) return false;
  const now = new Set(unfolded.value);
  if (open) now.add(id);
  else now.delete(id);
  unfolded.value = now;
  if (open) needKinds();
  return true;
}

export function AddDisplayButton() {
  if (documentId.value === "") return null;
  const add = () => {
    dialog.value = { kind: "add_display" };
  };
  const hint = mayEdit.value ? t("live.add.hint") : t("display.shared");
  return html`<button type="button" class="button small add-display" title=${hint} disabled=${!mayEdit.value}
    onClick=${add}><${Icon} name="plus" size=${15} />${t("live.add")}</button>`;
}

/** @param {string} filter @param {ReadonlySet<string>} closed groups that are folded @returns {Row[]} */
export function liveRows(filter, closed) {
  const words = filter.trim().toLowerCase();
  return oncePerPanel(rowsOf(words, closed));
}

/** @param {readonly Row[]} rows @returns {Row[]} without the remarks that repeat what concerns all */
function oncePerPanel(rows) {
  const said = new Set();
  return rows.filter(({ id }) => {
    const remark = id.startsWith("remark:") ? remarkOf(id.slice("remark:".length)) : null;
    if (!remark || !SAID_ONCE.has(remark.reason)) return true;
    const isNew = !said.has(remark.reason);
    said.add(remark.reason);
    return isNew;
  });
}

/** @param {string} id of a display */
const remarkOf = (id) => firstTrouble(displayStates.value.get(id));

/** @param {string} words @param {ReadonlySet<string>} closed @returns {Row[]} */
function rowsOf(words, closed) {
  return inGroups(liveDisplays.value).flatMap((entry) => {
    if ("display" in entry) return displayRows(entry.display, 1, words);
    const hits = entry.group.toLowerCase().includes(words) ? "" : words;
    const below = entry.members.flatMap((one) => displayRows(one, 2, hits));
    if (below.length === 0) return [];
    const open = words !== "" || !closed.has(`group:${entry.group}`);
    return [groupRow(entry.group, entry.members.length, open), ...(open ? below : [])];
  });
}

/** @param {string} group @param {number} count @param {boolean} open @returns {Row} */
function groupRow(group, count, open) {
  const on = !groupsOff.value.includes(group);
  const id = `group:${group}`;
  return {
    id,
    level: 1,
    label: group,
    icon: open ? "folderOpen" : "folder",
    expandable: true,
    expanded: open,
    faded: !on,
    meta: open ? "" : String(count),
    ...renamable(id, group),
    kind: dropMark(id),
    ...(mayEdit.value && {
      attributes: renaming.value === id ? {} : draggable(id),
      keys: groupKeys(group),
      controls: () => html`<${RowMenu} row=${id} name=${group} />`,
    }),
    eye: {
      on,
      label: t("display.show", { name: group }),
      set: (shown) => void switchGroup(group, shown),
      shared: true,
    },
  };
}

/** @param {string} id @param {string} text @returns {Pick<Row, "name">} */
const renamable = (id, text) =>
  renaming.value === id ? { name: () => html`<${NameBox} row=${id} text=${text} />` } : {};

/** @param {DisplayView} display @param {number} level @param {string} words @returns {Row[]} */
function displayRows(display, level, words) {
  const { id, name, kind, topic } = display;
  if (![name, kind, topic].some((text) => text.toLowerCase().includes(words))) return [];
  const state = displayStates.value.get(id);
  const open = isOpen(`display:${id}`);
  const below = [
    ...remarkRows(display, level + 1, state),
    ...(open ? settingsOf(display, level + 1, isOpen) : []),
  ];
  return [displayRow(display, level, state, open), ...below.map(takingDrops)];
}

/** @param {Row} row @returns {Row} on which another display can be dropped */
function takingDrops(row) {
  const kind = `${row.kind ?? ""} ${dropMark(row.id)}`;
  return { ...row, kind, ...(mayEdit.value && { attributes: droppable(row.id) }) };
}

/** @param {DisplayView} display @param {number} level @param {DisplayState | undefined} state @param {boolean} open @returns {Row} */
function displayRow(display, level, state, open) {
  const { id, name, kind, icon, enabled, group } = display;
  const row = `display:${id}`;
  return {
    id: row,
    kind: `display ${dropMark(row)}`,
    level,
    label: name,
    hint: `${name}\n${kinds.value.get(kind)?.doc ?? kind}`,
    icon,
    expandable: true,
    expanded: open,
    faded: !enabled || groupsOff.value.includes(group),
    ...metaOf(display, state),
    ...renamable(row, name),
    ...(mayEdit.value && {
      attributes: renaming.value === row ? {} : draggable(row),
      keys: displayKeys(id),
      controls: () => html`<${RowMenu} row=${row} name=${name} />`,
    }),
    eye: {
      on: enabled,
      label: t("display.show", { name }),
      set: (on) => void switchDisplay(id, on),
      shared: true,
    },
  };
}

/** @param {DisplayView} display @param {DisplayState | undefined} state @returns {Pick<Row, "meta" | "tone">} */
function metaOf({ topic, enabled }, state) {
  const trouble = enabled ? firstTrouble(state) : null;
  if (trouble?.level === "error" || trouble?.level === "warn")
    return { meta: reasonWords(trouble.reason, trouble.level), tone: trouble.level };
  const rate = enabled ? rateWords(state?.rate_hz ?? 0) : "";
  return { meta: [topic, rate].filter(Boolean).join(" · ") };
}

/** @param {string} reason @param {"warn" | "error"} level @returns {string} in a word or two */
function reasonWords(reason, level) {
  const key = `live.reason.${reason}`;
  const words = t(key);
  return words === key ? t(`live.${level}`) : words;
}

/** @param {DisplayView} display @param {number} level @param {DisplayState | undefined} state @returns {Row[]} the first thing that is in the way */
function remarkRows({ id, enabled }, level, state) {
  const remark = enabled ? firstTrouble(state) : null;
  if (!remark) return [];
  const { mend, sentence } = remark;
  const name = () => html`<span class="live-remark">
    <span>${sentence}</span>
    ${mend && mayEdit.value && html`<button type="button" class="button small" onClick=${() => mendDisplay(remark)}>${mend.label}</button>`}
  </span>`;
  const icon = remark.level === "error" ? "error" : "alert";
  return [
    { id: `remark:${id}`, level, label: sentence, icon, kind: `tree-note ${remark.level}`, name },
  ];
}
