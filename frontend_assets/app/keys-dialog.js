/** The list of keys, by where they count. */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { shortcutText } from "../lib/keys.js";
import { Dialog } from "../lib/ui.js";
import { commandLabel, commands, onMac } from "./commands.js";

/** @typedef {readonly [string, readonly string[]]} Row words, and keys that are pressed one after the other */

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
  ["keys.back", ["Alt+←"]],
  ["source.find", ["Mod+F"]],
  ["editor.Go_to_line", ["Ctrl+G"]],
];

/** @param {{onClose: () => void}} props */
export function KeysDialog({ onClose }) {
  return html`<${Dialog} title=${t("command.keys")} closeLabel=${t("close")} class="keys" onClose=${onClose}>
    <div class="keys-list">
      <${Keys} title=${t("keys.page")} rows=${named()} />
      <${Keys} title=${t("keys.in_source")} rows=${said(IN_SOURCE)} />
      <${Keys} title=${t("keys.everywhere")} rows=${said(IN_LISTS)} />
    </div>
  <//>`;
}

/** @returns {Row[]} the page's commands that have a key */
function named() {
  return commands.value.flatMap((command) => {
    const [key] = command.keys ?? [];
    return key ? [/** @type {Row} */ ([commandLabel(command), [key]])] : [];
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
