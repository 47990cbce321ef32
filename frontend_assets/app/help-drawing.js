/** Drawing texts in the markup of the help. */

/** @import { Block, Part } from "../lib/help-text.js" */

import { html } from "vendor/preact.js";
import { onMac, shortcutText } from "../lib/commands.js";
import { Icon } from "../lib/ui.js";

/** @typedef {(page: string, about: readonly string[]) => void} Choose */

/**
 * @param {Block} block
 * @param {Choose} onChoose what a click on a link does
 * @param {(name: string) => string} [pictureOf] address of a picture
 */
export function drawnBlock(block, onChoose, pictureOf = (name) => name) {
  const drawn = (/** @type {readonly Part[]} */ parts) =>
    parts.map((part) => drawnPart(part, onChoose));
  switch (block.kind) {
    case "picture":
      return html`<img src=${pictureOf(block.name)} alt=${block.alt} />`;
    case "heading":
      return html`<h3>${drawn(block.parts)}</h3>`;
    case "list":
      return html`<ul>${block.entries.map((entry) => html`<li>${drawn(entry)}</li>`)}</ul>`;
    default:
      return html`<p>${drawn(block.parts)}</p>`;
  }
}

/** @param {Part} part @param {Choose} onChoose */
function drawnPart(part, onChoose) {
  switch (part.kind) {
    case "strong":
      return html`<strong>${part.text}</strong>`;
    case "code":
      return html`<code>${part.text}</code>`;
    case "key":
      return html`<kbd>${shortcutText(part.text, onMac)}</kbd>`;
    case "icon":
      return html`<${Icon} name=${part.text} size=${15} />`;
    case "mark":
      return html`<span class=${`help-mark ${part.text}`} aria-hidden="true"></span>`;
    case "link":
      return html`<button type="button" class="text-button" onClick=${() => onChoose(part.page, part.about)}>${part.text}</button>`;
    default:
      return part.text;
  }
}
