/** The list of keys, by where they count. */

import { html, useSignal } from "vendor/preact.js";
import { commandLabel, commands, onMac, shortcutText } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { Dialog, SearchBox } from "../lib/ui.js";

/** @typedef {readonly [string, readonly string[]]} Row words, and keys that are pressed one after the other */
/** @typedef {{title: string, rows: readonly Row[]}} Group */

/** Commands that have to do with where panels stand. */
const OF_PANELS = /^(next_panel|previous_panel|maximize|move_panel|float_panel|layout\.\d+)$/;
/** Commands of the timeline. */
const OF_TIME = /^time\./;
/** Commands of the 3D view. */
const OF_SCENE =
  /^(look_at|fit|zero_view|orthographic|fullscreen|leave_fullscreen|measure.*|tool.*|end_measuring|deselect)$/;

/** @type {readonly Row[]} */
const AT_TABS = [
  ["keys.tabs", ["←", "→"]],
  ["keys.tab_menu", ["Shift+F10"]],
  ["keys.floating", ["Alt+→"]],
  ["keys.floating_size", ["Alt+Shift+→"]],
];

/** As RViz's panel of that name has them, beside those of lists. @type {readonly Row[]} */
const IN_DISPLAYS = [
  ["keys.live_rename", ["F2"]],
  ["keys.live_duplicate", ["Ctrl+D"]],
  ["keys.live_remove", ["Delete"]],
  ["keys.live_move", ["Alt+↑"]],
  ["keys.live_group", ["Alt+→", "Alt+←"]],
  ["keys.live_reset", ["Mod+R"]],
];

/** @type {readonly Row[]} */
const IN_SCENE = [["keys.turn", ["←", "↑", "→", "↓"]]];

/** @type {readonly Row[]} */
const AT_TIMELINE = [
  ["keys.time", ["←", "→"]],
  ["keys.time.ends", ["Home", "End"]],
  ["keys.time.loop", ["I", "O"]],
  ["command.time.bookmark", ["B"]],
  ["keys.time.zoom", ["+", "-", "0"]],
];

/** @type {readonly Row[]} */
const IN_PALETTE = [
  ["palette.sign.command", [">"]],
  ["palette.sign.link", ["@"]],
  ["palette.sign.property", ["#"]],
  ["palette.sign.file", ["/"]],
  ["palette.sign.problem", ["!"]],
  ["keys.line", [":120"]],
];

/** @type {readonly Row[]} */
const IN_LISTS = [
  ["keys.step", ["↑", "↓"]],
  ["keys.coarse", ["Shift+↑"]],
  ["keys.fine", ["Alt+↑"]],
  ["keys.write", ["Enter"]],
  ["keys.tree", ["←", "→"]],
  ["keys.eye", ["Space"]],
];

/** @type {readonly Row[]} */
const IN_SOURCE = [
  ["keys.leave", ["Escape", "Tab"]],
  ["language.completions", ["Ctrl+Space"]],
  ["command.definition", ["F12"]],
  ["command.references", ["Shift+F12"]],
  ["command.meaning", ["Alt+F12"]],
  ["command.rename", ["F2"]],
  ["editor.Replace", ["Ctrl+H"]],
  ["keys.back", ["Alt+←"]],
  ["source.find", ["Mod+F"]],
  ["editor.Go_to_line", ["Ctrl+G"]],
];

/** @param {{onClose: () => void}} props */
export function KeysDialog({ onClose }) {
  const words = useSignal("");
  const groups = groupsOf(words.value);
  return html`<${Dialog} title=${t("command.keys")} closeLabel=${t("close")} class="keys" onClose=${onClose}>
    <div class="keys-bar"><${SearchBox} label=${t("keys.filter")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} /></div>
    <div class="keys-list" tabindex="0" role="region" aria-label=${t("command.keys")}>
      ${groups.map((group) => html`<${Keys} key=${group.title} ...${group} />`)}
      ${groups.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: words.value })}</p>`}
    </div>
  <//>`;
}

/** @param {string} text of the search @returns {Group[]} those in which something fits, with what does */
function groupsOf(text) {
  const words = text.trim().toLowerCase();
  return allGroups()
    .map(({ title, rows }) => ({ title, rows: rows.filter((row) => heapOf(row).includes(words)) }))
    .filter(({ rows }) => rows.length > 0);
}

/** @param {Row} row @returns {string} its words, and its keys as they are written here and on keyboards */
function heapOf([words, keys]) {
  const written = keys.map((key) => `${key} ${shortcutText(key, onMac)}`).join(" ");
  return `${words} ${written}`.toLowerCase();
}

/** @returns {Group[]} */
function allGroups() {
  const ofPage = (/** @type {string} */ id) =>
    !OF_PANELS.test(id) && !OF_SCENE.test(id) && !OF_TIME.test(id);
  return [
    { title: t("keys.page"), rows: named(ofPage) },
    { title: t("panels.menu"), rows: [...named((id) => OF_PANELS.test(id)), ...said(AT_TABS)] },
    { title: t("panel.scene"), rows: [...named((id) => OF_SCENE.test(id)), ...said(IN_SCENE)] },
    { title: t("timeline"), rows: [...named((id) => OF_TIME.test(id)), ...said(AT_TIMELINE)] },
    { title: t("panel.displays"), rows: said(IN_DISPLAYS) },
    { title: t("keys.in_source"), rows: said(IN_SOURCE) },
    { title: t("keys.everywhere"), rows: said(IN_LISTS) },
    { title: t("keys.in_palette"), rows: said(IN_PALETTE) },
  ];
}

/** @param {(id: string) => boolean} isMeant @returns {Row[]} the page's commands that have a key */
function named(isMeant) {
  return commands.value.flatMap((command) => {
    const [key] = command.keys ?? [];
    return key && isMeant(command.id) ? [/** @type {Row} */ ([commandLabel(command), [key]])] : [];
  });
}

/** @param {readonly Row[]} rows @returns {Row[]} in the words of the language */
const said = (rows) => rows.map(([key, strokes]) => [t(key), strokes]);

/** @param {{title: string, rows: readonly Row[]}} props */
function Keys({ title, rows }) {
  return html`<section><h3>${title}</h3><dl>
    ${rows.map(
      ([words, keys]) => html`<dt>${words}</dt>
      <dd>${keys.map((one) => html`<kbd>${shortcutText(one, onMac)}</kbd>`)}</dd>`,
    )}
  </dl></section>`;
}
