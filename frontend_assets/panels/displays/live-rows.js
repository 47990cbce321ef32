/** Displays of what others publish, as rows of the tree: by group, with their state and their settings. */

/** @import { Entry } from "../../lib/display-groups.js" */
/** @import { Level, Status } from "../../lib/live-displays.js" */
/** @import { DisplayState, DisplayView, Remark } from "../../types/wire.d.ts" */
/** @import { Row } from "./tree.js" */

import { html, signal } from "vendor/preact.js";
import { displaysIn, groupName, groupsTo, inGroups } from "../../lib/display-groups.js";
import { t } from "../../lib/i18n.js";
import { firstTrouble, rateWords, statusesOf, worstOf } from "../../lib/live-displays.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { documentId, mayEdit } from "../../model/connection.js";
import {
  addDisplay,
  displayStates,
  groupsOff,
  kinds,
  liveDisplays,
  mendDisplay,
  needKinds,
  switchAll,
  switchDisplay,
  switchGroup,
} from "../../model/live-displays.js";
import { dialog } from "../../model/view.js";
import { endDrag, takesDrop, dragged as topic } from "../topic-drag.js";
import { draggable, dropMark, droppable } from "./live-drag.js";
import { displayKeys, groupKeys, NameBox, RowMenu, renaming, startRenaming } from "./live-menu.js";
import { settingsOf } from "./live-settings.js";

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

/** What is said of all displays at once is said below the first one only. */
const SAID_ONCE = new Set(["not_connected", "connection_lost"]);
/** Rows of displays and of their settings that are unfolded: at first none is. @type {import("vendor/preact.js").Signal<ReadonlySet<string>>} */
const unfolded = signal(new Set());
const isOpen = (/** @type {string} */ id) => unfolded.value.has(id);

/** @param {string} id of a row @param {boolean} open @returns {boolean} it was one of ours */
export function setLiveOpen(id, open) {
  if (!/^(display|setting|status):/.test(id)) return false;
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
  return html`<button type="button" class="button small add-display" title=${hint} aria-label=${t("live.add")} disabled=${!mayEdit.value}
    onClick=${add}><${Icon} name="plus" size=${15} /><span class="label">${t("live.add")}</span></button>`;
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
  return inGroups(liveDisplays.value).flatMap((entry) => entryRows(entry, 1, words, closed));
}

/** @param {Entry} entry @param {number} level @param {string} words @param {ReadonlySet<string>} closed @returns {Row[]} */
function entryRows(entry, level, words, closed) {
  if ("display" in entry) return displayRows(entry.display, level, words);
  const { group, entries } = entry;
  const hits = groupName(group).toLowerCase().includes(words) ? "" : words;
  const below = entries.flatMap((one) => entryRows(one, level + 1, hits, closed));
  if (below.length === 0) return [];
  const open = words !== "" || !closed.has(`group:${group}`);
  return [groupRow(entry, level, open), ...(open ? below : [])];
}

/** @param {string} group @returns {boolean} it, or one that it stands in, is hidden */
const isOff = (group) => groupsTo(group).some((one) => groupsOff.value.includes(one));

/** @param {Extract<Entry, {group: string}>} entry @param {number} level @param {boolean} open @returns {Row} */
function groupRow(entry, level, open) {
  const { group } = entry;
  const [id, name] = [`group:${group}`, groupName(group)];
  const members = displaysIn(entry);
  const worst = worstOf(members.map(levelOf));
  return {
    id,
    level,
    label: name,
    icon: open ? "folderOpen" : "folder",
    expandable: true,
    expanded: open,
    faded: isOff(group),
    meta: open ? "" : String(members.length),
    ...(!open && worst !== "ok" && { tone: worst }),
    ...renamable(id, name),
    kind: `group ${dropMark(id)}`,
    ...(mayEdit.value && {
      attributes: renaming.value === id ? {} : draggable(id),
      keys: groupKeys(group),
      controls: () => html`<${RowMenu} row=${id} name=${name} />`,
    }),
    eye: {
      on: !groupsOff.value.includes(group),
      label: t("display.show", { name }),
      set: (shown) => void switchGroup(group, shown),
      shared: true,
    },
  };
}

/** @param {DisplayView} display @returns {Level} the worst of its statuses; of one that is hidden none counts */
function levelOf({ id, enabled, group }) {
  if (!enabled || isOff(group)) return "ok";
  return worstOf((displayStates.value.get(id)?.remarks ?? []).map(({ level }) => level));
}

/** @param {string} id @param {string} text @returns {Pick<Row, "name" | "rename">} */
const renamable = (id, text) =>
  renaming.value === id
    ? { name: () => html`<${NameBox} row=${id} text=${text} />` }
    : mayEdit.value
      ? { rename: () => startRenaming(id) }
      : {};

/** @param {DisplayView} display @param {number} level @param {string} words @returns {Row[]} */
function displayRows(display, level, words) {
  const { id, name, kind, topic } = display;
  if (![name, kind, topic].some((text) => text.toLowerCase().includes(words))) return [];
  const state = displayStates.value.get(id);
  const open = isOpen(`display:${id}`);
  const below = open
    ? [...statusRows(display, level + 1, state), ...settingsOf(display, level + 1, isOpen)]
    : remarkRows(display, level + 1, state);
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
  const doc = kinds.value.get(kind)?.doc ?? "";
  return {
    id: row,
    kind: `display level-${levelOf(display)} ${dropMark(row)}`,
    level,
    label: name,
    hint: `${name}\n${doc || kind}`,
    help: { title: kind, text: doc },
    icon,
    expandable: true,
    expanded: open,
    faded: !enabled || isOff(group),
    ...metaOf(display, state),
    ...renamable(row, name),
    ...(mayEdit.value && {
      attributes: renaming.value === row ? {} : draggable(row),
      keys: displayKeys(id, name),
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
  return [remarkRow(`remark:${id}`, level, remark)];
}

/** @param {string} id @param {number} level @param {Remark} remark @param {string} [status] its name, said before it @returns {Row} */
function remarkRow(id, level, remark, status = "") {
  const { mend, sentence } = remark;
  const name = () => html`<span class="live-remark">
    <span>${status && html`<strong>${status}:</strong> `}${sentence}</span>
    ${mend && mayEdit.value && html`<button type="button" class="button small" onClick=${() => mendDisplay(remark)}>${mend.label}</button>`}
  </span>`;
  const label = status ? `${status}: ${sentence}` : sentence;
  return {
    id,
    level,
    label,
    icon: levelIcon(remark.level),
    kind: `tree-note ${remark.level}`,
    name,
  };
}

/** @param {Level} level */
export const levelIcon = (level) => ({ ok: "check", warn: "alert", error: "error" })[level];

/** @param {Level} level @returns {string} */
export const levelWords = (level) => t(`live.level.${level}`);

/** @param {DisplayView} display @param {number} level @param {DisplayState | undefined} state @returns {Row[]} its statuses below one row that takes the worst of them */
function statusRows({ id, kind, enabled }, level, state) {
  const listens = (kinds.value.get(kind)?.types.length ?? 0) > 0;
  const statuses = enabled ? statusesOf(state, listens) : [];
  if (statuses.length === 0) return [];
  const worst = worstOf(statuses.map((one) => one.level));
  // What is in the way is seen without a click; for what is well there is one.
  const row = worst === "ok" ? `status:${id}:well` : `status:${id}`;
  const open = worst === "ok" ? isOpen(row) : !isOpen(row);
  /** @type {Row} */
  const head = {
    id: row,
    level,
    label: t("live.status", { level: levelWords(worst) }),
    icon: levelIcon(worst),
    kind: `status level-${worst}`,
    help: { title: t("live.status.title"), text: t("live.status.help") },
    expandable: true,
    expanded: open,
    setOpen: (wanted) => setLiveOpen(row, worst === "ok" ? wanted : !wanted),
  };
  if (!open) return [head];
  const below = statuses.map((one, n) => statusRow(`status:${id}:${n}`, level + 1, one, state));
  return [head, ...below];
}

/** @param {string} id @param {number} level @param {Status} status @param {DisplayState | undefined} state @returns {Row} */
function statusRow(id, level, { name, remark }, state) {
  const title = t(`live.status.${name}`);
  if (remark) return remarkRow(id, level, remark, title);
  const text =
    name === "topic"
      ? t("live.status.received", { count: state?.received ?? 0 })
      : t("live.status.well");
  return { id, level, label: title, icon: "check", kind: "status level-ok", meta: text };
}

/** Shows or hides every display; says which of the two it would do. */
export function AllDisplaysButton() {
  const displays = liveDisplays.value;
  if (displays.length === 0) return null;
  const anyShown = displays.some(({ enabled, group }) => enabled && !isOff(group));
  const label = t(anyShown ? "live.hide_all" : "live.show_all");
  return html`<${IconButton} icon=${anyShown ? "eye" : "eyeOff"} label=${label} hint=${mayEdit.value ? label : t("display.shared")}
    disabled=${!mayEdit.value} onClick=${() => void switchAll(!anyShown)} />`;
}
