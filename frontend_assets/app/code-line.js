/** A command of a terminal, with a button that copies it. */

import { html } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
import { notify } from "../model/view.js";

/** @param {{code: string, label?: string}} props `label`: of the button */
export function CodeLine({ code, label = t("copy.command") }) {
  const copy = async () => {
    const done = await copyText(code);
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  // A line ends between words: of `--allow-run` broken behind its hyphens nothing is left.
  const words = code.split(" ").flatMap((word, at) => [at > 0 && " ", html`<span>${word}</span>`]);
  return html`<div class="code-line"><code>${words}</code><${IconButton} icon="copy" label=${label} size=${14} onClick=${copy} /></div>`;
}
