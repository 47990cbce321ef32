/** Any text of an attribute, edited where it stands in its file, as an editor would. */

/** @import { Place } from "../types/wire.d.ts" */

import { html } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { niceStep, parseNumber } from "../lib/numbers.js";
import { TextBox } from "../lib/slider.js";
import { replacement } from "../lib/written-text.js";
import { mayEdit } from "../model/connection.js";
import { documentState } from "../model/document.js";
import { ask } from "../model/requests.js";
import { notify } from "../model/view.js";

let gestures = 0;

/** @param {{place: Place, text: string, label: string}} props `place` is where the text begins, inside its quotes */
export function WrittenText({ place, text, label }) {
  const readOnly = documentState.value?.read_only.includes(place.file);
  const number = parseNumber(text);
  const step = number === null ? undefined : niceStep(0, Math.abs(number) * 4 || 2);
  /** @param {string} typed */
  const onWrite = (typed) => {
    if (typed !== text) write(place, text, typed);
  };
  return html`<${TextBox} class=${number === null ? "wide" : "number"} label=${label} text=${text}
    number=${number} step=${step} disabled=${!mayEdit.value || readOnly} onWrite=${onWrite} />`;
}

/** @param {Place} place @param {string} old @param {string} text */
async function write(place, old, text) {
  const known = await ask({ type: "get_text", file: place.file });
  if (known?.type !== "text") return;
  const change = replacement(known.text, place, old, text);
  if (!change) return notify(t("origin.moved"), { bad: true });
  gestures += 1;
  const gesture = `written ${gestures}`;
  await ask({
    type: "edit_text",
    file: known.file,
    version: known.version,
    changes: [change],
    gesture,
  });
}
