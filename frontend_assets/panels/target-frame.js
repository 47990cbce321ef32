/** With which frame the camera goes, in this browser: a menu among the tools of the 3D view. */

import { html, useEffect, useRef } from "vendor/preact.js";
import { inFrameOrder } from "../lib/frame-tree.js";
import { t } from "../lib/i18n.js";
import { Icon, openMenu } from "../lib/ui.js";
import { robot } from "../model/document.js";
import { framesNow } from "../model/live-displays.js";
import { keepTargetFrame, targetFrame, targetTrouble } from "../model/viewport.js";

export function TargetFrame() {
  const menu = useRef(/** @type {import("../lib/ui.js").MenuHandle | null} */ (null));
  useEffect(() => () => menu.current?.close(), []);
  useEffect(keepTargetFrame, []);
  if (!robot.value) return null;
  const [frame, trouble] = [targetFrame.value, targetTrouble.value];
  const label = frame ? t("live.target_frame.with", { frame }) : t("live.target_frame");
  /** @param {{currentTarget: EventTarget | null}} event */
  const open = async ({ currentTarget }) => {
    const button = /** @type {HTMLElement} */ (currentTarget);
    if (button.getAttribute("aria-expanded") === "true") return menu.current?.close();
    const items = itemsOf(inFrameOrder((await framesNow()).map(({ name }) => name)));
    if (button.isConnected) menu.current = openMenu(button, label, items);
    return undefined;
  };
  return html`<button type="button" class=${`icon-button target-frame ${frame ? "on" : ""}`} aria-label=${label} title=${trouble || label}
    aria-haspopup="menu" aria-expanded="false" onClick=${open}>
    <${Icon} name=${trouble ? "alert" : "target"} />${frame && html`<span>${frame}</span>`}<${Icon} name="chevronDown" size=${12} />
  </button>`;
}

/** @param {readonly string[]} frames */
function itemsOf(frames) {
  const now = targetFrame.value;
  const names = now === "" || frames.includes(now) ? frames : [now, ...frames];
  const choices = [{ label: t("live.target_frame.none"), value: "" }].concat(
    names.map((name) => ({ label: name, value: name })),
  );
  return choices.map(({ label, value }) => ({
    label,
    checked: value === now,
    run: () => {
      targetFrame.value = value;
    },
  }));
}
