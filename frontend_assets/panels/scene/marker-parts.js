/** What the 3D view shows of interactive markers beside the handles themselves: hints and menus. */

/** @import { MenuItem } from "../../lib/ui.js" */
/** @import { MenuItemView } from "../../types/wire.d.ts" */

import { html, useEffect, useRef } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { Icon, openMenu } from "../../lib/ui.js";
import {
  askedMenu,
  markerWithMenu,
  pointedMarker,
  selectEntry,
} from "../../model/interactive-markers.js";

/** What the mouse is over, and what it does there. */
export function MarkerHint() {
  const pointed = pointedMarker.value;
  if (!pointed) return null;
  const { marker, mode, description } = pointed;
  const does = [
    mode > 0 && mode < 10 && t(`markers.mode.${mode}`),
    marker.menu.length > 0 && mode !== 1 && t("markers.menu"),
  ].filter(Boolean);
  return html`<div class="scene-hint marker-hint" role="status"><${Icon} name="hand" size=${15} />
    <span><strong>${description || marker.description || marker.name}</strong> ${does.join(" · ")}</span></div>`;
}

function focusView() {
  const frame = document.querySelector(".scene iframe");
  if (frame instanceof HTMLElement) frame.focus();
}

/** Opens the menu of a marker where it was asked for. */
export function MarkerMenu() {
  const anchor = useRef(/** @type {HTMLButtonElement | null} */ (null));
  const asked = askedMenu.value;
  useEffect(() => {
    const button = anchor.current;
    const marker = asked && markerWithMenu(asked);
    if (!button || !asked || !marker) return undefined;
    button.style.left = `${asked.x}px`;
    button.style.top = `${asked.y}px`;
    const run = (/** @type {number} */ entry) => selectEntry(asked, entry);
    const menu = openMenu(button, marker.description || marker.name, itemsOf(marker.menu, 0, run));
    return () => menu.close();
  }, [asked]);
  // Nothing is to be done with it: who closes the menu is back in the 3D view.
  return html`<button type="button" class="menu-anchor" tabindex=${-1} aria-label=${t("markers.menu_of")} ref=${anchor}
    onFocus=${focusView}></button>`;
}

/** @param {readonly MenuItemView[]} entries @param {number} parent @param {(entry: number) => void} run @returns {MenuItem[]} */
export function itemsOf(entries, parent, run) {
  return entries
    .filter((one) => one.parent === parent)
    .map(({ id, title, checked }) => {
      const isMenu = entries.some((one) => one.parent === id);
      return {
        label: title,
        ...(checked !== null && { box: checked }),
        ...(isMenu ? { hint: "▸", more: () => itemsOf(entries, id, run) } : { run: () => run(id) }),
      };
    });
}
