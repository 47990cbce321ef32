/** Where a panel of the dock can stand, and how it gets there without a pointer. */

/** @import { DockviewApi } from "vendor/dockview.js" */

/**
 * @typedef {{kind: "beside", group: string, names: string[]}
 *   | {kind: "edge", edge: "left" | "right" | "top" | "bottom"}
 *   | {kind: "split", edge: "right" | "bottom"}} Place `beside`: as a tab with those of that name;
 *   `edge`: along a side of the whole dock; `split`: in a half of the room that its group has
 */

const EDGES = /** @type {const} */ (["left", "right", "top", "bottom"]);
/** Where dockview looks for each of them. */
const DIRECTIONS = /** @type {const} */ ({
  left: "left",
  right: "right",
  top: "above",
  bottom: "below",
});

/** @param {DockviewApi} api @param {string} id of a panel @returns {Place[]} all but where it is */
export function placesFor(api, id) {
  const own = api.getPanel(id)?.group;
  if (!own) return [];
  const others = api.groups.filter((group) => group !== own && group.panels.length > 0);
  const alone = own.panels.length === 1;
  return [
    ...others.map((group) => ({
      kind: /** @type {const} */ ("beside"),
      group: group.id,
      names: group.panels.map((panel) => panel.id),
    })),
    ...(alone ? [] : [split("right"), split("bottom")]),
    ...(alone && others.length === 0
      ? []
      : EDGES.map((edge) => ({ kind: /** @type {const} */ ("edge"), edge }))),
  ];
}

/** @param {"right" | "bottom"} edge @returns {Place} */
const split = (edge) => ({ kind: "split", edge });

/** @param {DockviewApi} api @param {string} id @param {Place} place one of `placesFor` */
export function movePanel(api, id, place) {
  const panel = api.getPanel(id);
  if (!panel) return;
  if (api.hasMaximizedGroup()) api.exitMaximizedGroup();
  if (place.kind === "edge") {
    const group = api.addGroup({ direction: DIRECTIONS[place.edge] });
    panel.api.moveTo({ group, position: "center" });
  } else if (place.kind === "split") panel.api.moveTo({ group: panel.group, position: place.edge });
  else {
    const group = api.groups.find((one) => one.id === place.group);
    if (group) panel.api.moveTo({ group, position: "center" });
  }
  api.getPanel(id)?.api.setActive();
}
