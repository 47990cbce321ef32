/** In which frame everything is drawn: a box among the tools of the 3D view. */

import { html } from "vendor/preact.js";
import { inFrameOrder } from "../lib/frame-tree.js";
import { t } from "../lib/i18n.js";
import { PickBox } from "../lib/pick-box.js";
import { Icon, IconButton } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { robot } from "../model/document.js";
import { fixedFrame, framesNow, frameTrouble, setFixedFrame } from "../model/live-displays.js";

export function FixedFrame() {
  if (!robot.value) return null;
  const trouble = frameTrouble.value;
  const choices = async () => [
    { label: t("live.fixed_frame.robot"), value: "" },
    ...inFrameOrder((await framesNow()).map(({ name }) => name)),
  ];
  return html`<span class="divider"></span>
    ${trouble && html`<${Trouble} trouble=${trouble} />`}
    <span class="fixed-frame-label" aria-hidden="true">${t("live.fixed_frame.label")}</span>
    <${PickBox} class="fixed-frame" label=${t("live.fixed_frame")} text=${fixedFrame.value} placeholder=${t("live.fixed_frame.placeholder")}
      disabled=${!mayEdit.value} choices=${choices} onWrite=${(/** @type {string} */ frame) => void setFixedFrame(frame)} />`;
}

/** Why nothing can be drawn there; one click goes back. @param {{trouble: string}} props */
function Trouble({ trouble }) {
  if (!mayEdit.value)
    return html`<span class="frame-trouble" role="img" aria-label=${trouble} title=${trouble}><${Icon} name="alert" size=${15} /></span>`;
  return html`<${IconButton} class="frame-trouble" icon="alert" size=${15} label=${`${trouble} ${t("live.fixed_frame.mend")}`}
    onClick=${() => void setFixedFrame("")} />`;
}
