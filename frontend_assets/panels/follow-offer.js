/** Offers to follow the robot once the view is fixed to a frame in which it drives away. */

import { html, useSignal } from "vendor/preact.js";
import { targetFrame } from "../app/following.js";
import { robot } from "../app/state/document.js";
import { fixedFrame, frameTrouble } from "../app/state/live.js";
import { t } from "../lib/i18n.js";
import { Icon, IconButton } from "../lib/ui.js";

export function FollowOffer() {
  const declinedFor = useSignal("");
  const fixed = fixedFrame.value;
  const root = robot.value?.root ?? "";
  const isOfRobot = robot.value?.links.some(({ name }) => name === fixed) ?? false;
  const isFollowing = targetFrame.value !== "";
  if (!fixed || !root || isOfRobot || isFollowing || frameTrouble.value) return null;
  if (declinedFor.value === fixed) return null;
  const follow = () => {
    targetFrame.value = root;
  };
  const decline = () => {
    declinedFor.value = fixed;
  };
  return html`<div class="scene-hint" role="status"><${Icon} name="info" size=${15} />
    <span>${t("follow.offer", { frame: fixed })}</span>
    <button type="button" class="text-button" onClick=${follow}>${t("follow.do", { frame: root })}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${decline} /></div>`;
}
