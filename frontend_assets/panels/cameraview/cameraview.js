/** What a camera of the robot sees, with the scene drawn over it as through its lens. */

/** @import { DisplayView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { firstTrouble } from "../../lib/live-displays.js";
import { Icon, MenuButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import {
  displayStates,
  groupsOff,
  liveDisplays,
  setProperty,
  settingOf,
  switchDisplay,
} from "../../model/live-displays.js";
import { dialog } from "../../model/view.js";
import { viewport } from "../../model/viewport.js";
import { NothingThere } from "../parts.js";

const KIND = "Camera";
const RENDERING = "Image Rendering";
const ALPHA = "Overlay Alpha";
/** The largest edge of what is drawn, px. */
const LARGEST = 1600;
/** By RViz's names. @type {Readonly<Record<string, string>>} */
const RENDERINGS = {
  background: "cameraview.background",
  overlay: "cameraview.overlay",
  "background and overlay": "cameraview.both",
};

export function CameraviewPanel() {
  const chosen = useSignal("");
  const cameras = liveDisplays.value.filter(({ kind }) => kind === KIND);
  const camera = cameras.find(({ id }) => id === chosen.value) ?? cameras[0];
  return html`<section class="panel-body cameraview" aria-label=${t("panel.cameraview")}>
    ${camera ? html`<${Bar} camera=${camera} cameras=${cameras} chosen=${chosen} /><${Picture} key=${camera.id} camera=${camera} />` : html`<${None} />`}
  </section>`;
}

function None() {
  const add = () => {
    dialog.value = { kind: "add_display" };
  };
  return html`<${NothingThere} icon="camera" title=${t("cameraview.none")}><p>${t("cameraview.none.hint")}</p>
    <button type="button" class="button primary" disabled=${!mayEdit.value} onClick=${add}><${Icon} name="plus" />${t("cameraview.add")}</button><//>`;
}

/** @param {{camera: DisplayView, cameras: readonly DisplayView[], chosen: Signal<string>}} props */
function Bar({ camera, cameras, chosen }) {
  const items = () =>
    cameras.map(({ id, name }) => ({
      label: name,
      checked: id === camera.id,
      run: () => {
        chosen.value = id;
      },
    }));
  const rendering = String(settingOf(camera, RENDERING) ?? "background and overlay");
  const alpha = Number(settingOf(camera, ALPHA) ?? 0.5);
  const set = (/** @type {string} */ name, /** @type {string | number} */ value) =>
    void setProperty(camera.id, name, value);
  return html`<div class="panel-bar cameraview-bar">
    <${MenuButton} label=${t("cameraview.choose")} value=${camera.name} hint=${camera.topic} class="button topic-menu" items=${items}>
      <span class="topic-name">${camera.name}</span><${Icon} name="chevronDown" size=${12} /><//>
    <span class="push"></span>
    <select class="box" aria-label=${t("cameraview.rendering")} title=${t("cameraview.rendering")} disabled=${!mayEdit.value}
      value=${rendering} onChange=${(/** @type {any} */ event) => set(RENDERING, event.currentTarget.value)}>
      ${Object.entries(RENDERINGS).map(([name, words]) => html`<option key=${name} value=${name} selected=${name === rendering}>${t(words)}</option>`)}
    </select>
    <input type="range" class="slider short" min="0" max="1" step="0.01" value=${alpha} aria-label=${t("cameraview.alpha")} title=${t("cameraview.alpha")}
      disabled=${!mayEdit.value || rendering === "background"} style=${`--fill:${alpha * 100}%`}
      onInput=${(/** @type {any} */ event) => set(ALPHA, Number(event.currentTarget.value))} />
  </div>`;
}

/** @param {{camera: DisplayView}} props one of another id has another canvas */
function Picture({ camera }) {
  const place = useRef(/** @type {HTMLElement | null} */ (null));
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const seen = useSignal(/** @type {boolean | null} */ (null));
  const view = viewport.value;
  const isOn = camera.enabled && !groupsOff.value.includes(camera.group);
  useEffect(() => {
    const [frame, paper] = [place.current, canvas.current];
    if (!frame || !paper || !view || !isOn) return undefined;
    const shown = view.showCamera({
      display: camera.id,
      canvas: paper,
      told: (now) => {
        seen.value = now;
      },
    });
    const watcher = new ResizeObserver(([entry]) => {
      if (!entry) return;
      Object.assign(paper, sizeFor(entry.contentRect, devicePixelRatio));
      shown.renew();
    });
    watcher.observe(frame);
    return () => {
      watcher.disconnect();
      shown.leave();
    };
  }, [view, isOn]);
  const words = saidOf(camera, isOn, view !== null, seen.value);
  return html`<div ref=${place} class="cameraview-place">
      <canvas ref=${canvas} role="img" aria-label=${t("cameraview.of", { name: camera.name })} hidden=${!view || !isOn}></canvas>
    </div>
    ${words && html`<p class="cameraview-said" role="status">${words}${!isOn && html` <button type="button" class="text-button" disabled=${!mayEdit.value} onClick=${() => switchDisplay(camera.id, true)}>${t("cameraview.on")}</button>`}</p>`}`;
}

/** @param {DisplayView} camera @param {boolean} isOn @param {boolean} hasView @param {boolean | null} seen whether the scene is drawn; null: nothing was drawn yet @returns {string} why it is not */
function saidOf(camera, isOn, hasView, seen) {
  if (!isOn) return t("cameraview.off", { name: camera.name });
  if (!hasView) return t("cameraview.no_view");
  const trouble = firstTrouble(displayStates.value.get(camera.id));
  if (trouble) return trouble.sentence;
  return seen ? "" : t("cameraview.waiting");
}

/** How large a canvas is drawn. @param {{width: number, height: number}} place px of the page @param {number} ratio @returns {{width: number, height: number}} */
export function sizeFor({ width, height }, ratio) {
  const scale = Math.min(ratio, LARGEST / Math.max(width, height, 1));
  return {
    width: Math.max(1, Math.round(width * scale)),
    height: Math.max(1, Math.round(height * scale)),
  };
}
