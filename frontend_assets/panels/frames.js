/** The pose of a frame in another one, in every form in which people write it; live while joints move. */

/** @import { Step } from "../lib/frame-pose.js" */

import { html, useEffect, useRef } from "vendor/preact.js";
import { Refusal } from "../app/refusal.js";
import { robot } from "../app/state/document.js";
import {
  BY_FRAMES,
  comparing,
  reference,
  referenceFromTarget,
  setReference,
  setTarget,
  swapFrames,
  target,
} from "../app/state/frame-pair.js";
import { askFrames, followFrames, framesRefused } from "../app/state/frames.js";
import { part, selectPart } from "../app/state/selection.js";
import { wayBetween } from "../lib/frame-pose.js";
import { t } from "../lib/i18n.js";
import { LinkPicker } from "../lib/link-picker.js";
import { useSeen } from "../lib/seen.js";
import { EmptyState, Icon, IconButton } from "../lib/ui.js";
import { PoseForms } from "./frames-forms.js";

export function FramesPanel() {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(followFrames, []);
  useSeen(panel, (seen) => {
    comparing.value = seen;
  });
  const names = robot.value?.links.map(({ name }) => name) ?? [];
  return html`<section ref=${panel} class="panel-body frames" aria-label=${t("panel.frames")}>
    ${names.length === 0 ? html`<${EmptyState} icon="frames" title=${t("urdf.none")} />` : html`<${Content} names=${names} />`}
  </section>`;
}

/** @param {{names: readonly string[]}} props */
function Content({ names }) {
  const way = wayOf();
  return html`<div class="panel-bar frames-head">
      <span class="muted">${t("frames.of")}</span>
      <${LinkPicker} label=${t("frames.target")} value=${target.value} links=${names} placeholder=${t("frames.choose")} onPick=${setTarget} />
      <span class="muted">${t("frames.in")}</span>
      <${LinkPicker} label=${t("frames.reference")} value=${reference.value} links=${names} onPick=${setReference} />
      <${IconButton} icon="compare" label=${t("frames.swap")} disabled=${target.value === null} onClick=${swapFrames} />
    </div>
    <div class="scroll">
      ${target.value === null && html`<${EmptyState} icon="frames" title=${t("frames.none")} />`}
      ${target.value !== null && !way && html`<p class="note padded"><${Icon} name="info" size=${13} />${t("frames.apart")}</p>`}
      ${target.value !== null && html`<${Values} />`}
      ${way && html`<${Way} way=${way} />`}
    </div>`;
}

/** @returns {Step[] | null} the joints between the two frames */
function wayOf() {
  const [from, to] = [reference.value, target.value];
  return from === null || to === null ? null : wayBetween(robot.value?.joints ?? [], from, to);
}

/** Drawn anew with every joint frame, and nothing else of the panel. */
function Values() {
  const pose = referenceFromTarget.value;
  if (pose) return html`<${PoseForms} pose=${pose} />`;
  return framesRefused.value
    ? html`<${Refusal} sentence=${framesRefused.value} again=${askFrames} />`
    : html`<p class="note padded">${t("loading")}</p>`;
}

/** @param {{way: readonly Step[]}} props the links and joints from the one frame to the other */
function Way({ way }) {
  const first = reference.value ?? "";
  return html`<ol class="frames-way" aria-label=${t("frames.way")}>
    <li><${PartButton} part=${`link:${first}`} name=${first} icon="box" /></li>
    ${way.map(
      ({ joint, up }) => html`<li key=${joint.name}>
        <span class="frames-arrow" title=${t(up ? "frames.up" : "frames.down")} aria-label=${t(up ? "frames.up" : "frames.down")}>${up ? "↑" : "↓"}</span>
        <${PartButton} part=${`joint:${joint.name}`} name=${joint.name} icon="joints" still=${joint.type === "fixed"} />
        <${PartButton} part=${`link:${up ? joint.parent : joint.child}`} name=${up ? joint.parent : joint.child} icon="box" />
      </li>`,
    )}
  </ol>`;
}

/** @param {{part: string, name: string, icon: string, still?: boolean}} props */
function PartButton({ part: key, name, icon, still = false }) {
  return html`<button type="button" class=${`segment ${still ? "still" : ""}`} aria-pressed=${part.value === key} title=${name}
    onClick=${() => selectPart(key, "", "", BY_FRAMES)}><${Icon} name=${icon} size=${12} /><span>${name}</span></button>`;
}
