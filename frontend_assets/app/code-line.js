/** A command, or several, to be copied into a terminal. */

import { html } from "vendor/preact.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
import { notify } from "../model/view.js";

/** @param {{code: string}} props */
export function CodeLine({ code }) {
  const copy = async () => {
    const done = await copyText(code);
    notify(done ? t("copied") : t("copy.failed"), { bad: !done });
  };
  return html`<div class="code-line"><code>${code}</code><${IconButton} icon="copy" label=${t("copy.command")} size=${14} onClick=${copy} /></div>`;
}
