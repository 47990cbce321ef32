/** How much this browser draws in 3D: as the person chose, or as fast as it proved to be. */

/** @import { Graphics } from "../../model/viewport.js" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { remembered } from "../../lib/remembered.js";

export const GRAPHICS = /** @type {const} */ (["automatic", "full", "light"]);

/** @typedef {typeof GRAPHICS[number]} GraphicsChoice */

/** The script in the frame reads this and the next one, too, before the canvas is made. @type {Signal<GraphicsChoice>} */
export const graphicsChoice = remembered(
  "graphics",
  /** @type {GraphicsChoice} */ ("automatic"),
  (value) => GRAPHICS.includes(/** @type {GraphicsChoice} */ (value)),
);
/** Whether pictures came too slowly here once. */
export const provedSlow = remembered("graphics.slow", false);
/** Whether the person knows that this browser draws lightly. */
export const graphicsSaid = remembered("graphics.said", false);

/** What the frame draws with now; null until it stands. @type {Signal<Graphics | null>} */
export const graphics = signal(null);
/** Pictures a second when that was found too slow. @type {Signal<number | null>} */
export const slowHz = signal(null);

/** One in so many points of clouds is drawn here; 1: all are. @type {Signal<number>} */
export const pointsOneIn = signal(1);

/** @param {GraphicsChoice} choice @param {Graphics} now @returns {boolean} whether it means to draw lightly */
export const meansLight = (choice, now) =>
  choice === "light" || (choice === "automatic" && now.software);
