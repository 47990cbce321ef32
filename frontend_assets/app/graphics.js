/**
 * How much this browser draws in 3D: as the person chose, or as fast as it proved to be; and the
 * notice that says so.
 */

/** @import { MenuItem } from "../lib/ui.js" */
/** @import { Command } from "../lib/commands.js" */
/** @import { Graphics } from "../model/viewport.js" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, html, signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { remembered } from "../lib/remembered.js";
import { Dialog, Icon, IconButton } from "../lib/ui.js";
import { dialog } from "../model/view.js";
import { viewport } from "../model/viewport.js";

/** Ask the 3D view what it draws with, and hear when it proves slow, and what it leaves out. */
export function followGraphics() {
  effect(() => {
    const view = viewport.value;
    graphics.value = view?.graphics() ?? null;
    pointsOneIn.value = 1;
    if (!view) return undefined;
    const hear = (/** @type {Event} */ event) =>
      takeSlow(/** @type {CustomEvent<{hz: number}>} */ (event).detail.hz);
    const hearDetail = (/** @type {Event} */ event) => {
      pointsOneIn.value = /** @type {CustomEvent<{oneIn: number}>} */ (event).detail.oneIn;
    };
    view.events.addEventListener("slow", hear);
    view.events.addEventListener("detail", hearDetail);
    return () => {
      view.events.removeEventListener("slow", hear);
      view.events.removeEventListener("detail", hearDetail);
    };
  });
}

/** @param {number} hz pictures a second */
function takeSlow(hz) {
  const view = viewport.peek();
  slowHz.value = hz;
  if (!view || graphicsChoice.peek() !== "automatic" || graphics.peek()?.light) return;
  provedSlow.value = true;
  view.lighten();
  graphics.value = view.graphics();
}

/** @param {GraphicsChoice} choice the view is made anew where its canvas has to be another */
function chooseGraphics(choice) {
  graphicsChoice.value = choice;
  graphicsSaid.value = true;
  // Chosen anew, it is measured anew.
  provedSlow.value = false;
  const now = graphics.peek();
  if (now && now.light !== meansLight(choice, now)) viewport.peek()?.reload();
}

/** @returns {Command[]} */
export function graphicsCommands() {
  const choices = GRAPHICS.map((choice) => ({
    id: `graphics.${choice}`,
    icon: "system",
    enabled: () => graphicsChoice.value !== choice,
    run: () => chooseGraphics(choice),
  }));
  return [...choices, { id: "graphics_details", icon: "info", run: showDetails }];
}

function showDetails() {
  dialog.value = { kind: "graphics" };
}

/** @returns {MenuItem[]} */
export function graphicsItems() {
  const choices = GRAPHICS.map((choice) => ({
    label: t(`graphics.${choice}`),
    checked: graphicsChoice.value === choice,
    run: () => chooseGraphics(choice),
  }));
  return [...choices, { label: `${t("graphics.details")}…`, icon: "info", run: showDetails }];
}

/** Over the 3D view: what of clouds is left out, as long as it is; else that it is drawn lightly. */
export function GraphicsNotice() {
  if (pointsOneIn.value > 1)
    return html`<div class="scene-hint" role="status"><${Icon} name="system" size=${15} />
      <span>${t("graphics.points", { count: pointsOneIn.value })}</span></div>`;
  return html`<${LightNotice} />`;
}

/** Once: that the 3D view is drawn lightly, and the way back. */
function LightNotice() {
  if (graphicsSaid.value || graphicsChoice.value !== "automatic" || !graphics.value?.light)
    return null;
  return html`<div class="scene-hint" role="status"><${Icon} name="system" size=${15} />
    <span>${t("graphics.notice")}</span>
    <button type="button" class="text-button" onClick=${showDetails}>${t("graphics.details")}</button>
    <button type="button" class="text-button" onClick=${() => chooseGraphics("full")}>${t("graphics.draw_fully")}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${() => {
      graphicsSaid.value = true;
    }} /></div>`;
}

/** @param {{onClose: () => void}} props what was found, what it changes, and the choice */
export function GraphicsDialog({ onClose }) {
  const now = graphics.value;
  /** @param {GraphicsChoice} choice */
  const choose = (choice) => {
    onClose();
    chooseGraphics(choice);
  };
  return html`<${Dialog} title=${t("graphics")} closeLabel=${t("close")} class="graphics-dialog" onClose=${onClose}>
    <p class="dialog-text">${reason()}</p>
    <p class="dialog-text">${t("graphics.what")}</p>
    ${now?.renderer && html`<p class="dialog-text">${t("graphics.renderer", { name: now.renderer })}</p>`}
    ${now?.software && html`<p class="dialog-text">${t("graphics.mend")}</p>`}
    <div class="graphics-choices" role="radiogroup" aria-label=${t("graphics")}>
      ${GRAPHICS.map(
        (
          choice,
        ) => html`<button key=${choice} type="button" role="radio" class="button" aria-checked=${graphicsChoice.value === choice}
        data-first=${graphicsChoice.value === choice ? true : null} onClick=${() => choose(choice)}>
        ${graphicsChoice.value === choice && html`<${Icon} name="check" size=${14} />`}${t(`graphics.${choice}`)}</button>`,
      )}
    </div>
  <//>`;
}

/** @returns {string} */
function reason() {
  const now = graphics.value;
  if (now?.software) return t("graphics.software");
  if (slowHz.value !== null) return t("graphics.slow", { hz: Math.round(slowHz.value) });
  return provedSlow.value ? t("graphics.was_slow") : t("graphics.fine");
}

const GRAPHICS = /** @type {const} */ (["automatic", "full", "light"]);

/** @typedef {typeof GRAPHICS[number]} GraphicsChoice */

/** The script in the frame reads this and the next one, too, before the canvas is made. @type {Signal<GraphicsChoice>} */
export const graphicsChoice = remembered(
  "graphics",
  /** @type {GraphicsChoice} */ ("automatic"),
  (value) => GRAPHICS.includes(/** @type {GraphicsChoice} */ (value)),
);
/** Whether pictures came too slowly here once. */
const provedSlow = remembered("graphics.slow", false);
/** Whether the person knows that this browser draws lightly. */
export const graphicsSaid = remembered("graphics.said", false);

/** What the frame draws with now; null until it stands. @type {Signal<Graphics | null>} */
export const graphics = signal(null);
/** Pictures a second when that was found too slow. @type {Signal<number | null>} */
const slowHz = signal(null);

/** One in so many points of clouds is drawn here; 1: all are. @type {Signal<number>} */
const pointsOneIn = signal(1);

/** @param {GraphicsChoice} choice @param {Graphics} now @returns {boolean} whether it means to draw lightly */
const meansLight = (choice, now) => choice === "light" || (choice === "automatic" && now.software);
