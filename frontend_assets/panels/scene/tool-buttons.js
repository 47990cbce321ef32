/** The tools in the toolbar of the 3D view: a button each, or one menu where there is no room. */

/** @import { ToolView } from "../../types/wire.d.ts" */
/** @import { MenuItem } from "../../lib/ui.js" */

import { html } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { robot } from "../../model/document.js";
import { mayTake, takeTool, toolInHand, tools } from "../../model/tools.js";
import { viewport } from "../../model/viewport.js";

/** More than RViz's first set, and a few, are in the menu only. */
const BUTTONS_MOST = 10;
const FIRST_SET = 8;

export function ToolButtons() {
  const off = viewport.value === null || robot.value === null;
  const inHand = toolInHand.value;
  if (!inHand) return html`<${Waiting} />`;
  return html`<div class="tool-buttons" role="group" aria-label=${t("tools.title")}>
      ${tools.value.slice(0, BUTTONS_MOST).map(
        (
          tool,
        ) => html`<${IconButton} key=${tool.id} icon=${tool.icon} label=${tool.name} hint=${hintOf(tool)}
          pressed=${tool.id === inHand.id} disabled=${off || !mayTake(tool)} onClick=${() => takeTool(tool.id)} />`,
      )}
    </div>
    <${MenuButton} class="icon-button tool-menu" label=${t("tools.title")} value=${inHand.name} hint=${t("tools.title")}
      disabled=${off} items=${items}>
      <span class="tool-now"><${Icon} name=${inHand.icon} /></span><${Icon} name="chevronDown" size=${12} />
    <//>`;
}

/** As wide as RViz's first set, so that nothing moves once the tools are known. */
const Waiting = () =>
  html`<div class="tool-buttons waiting" aria-hidden="true">${Array(FIRST_SET)
    .fill(0)
    .map(() => html`<span class="icon-button"></span>`)}</div>
    <span class="icon-button tool-menu waiting" aria-hidden="true"></span>`;

/** Of several of a kind the first has the key. @param {ToolView} tool */
const keyOf = (tool) =>
  tools.value.find(({ kind }) => kind === tool.kind) === tool ? tool.key : "";

/** @param {ToolView} tool */
function hintOf(tool) {
  if (!mayTake(tool)) return `${tool.name}: ${t("tools.control")}`;
  const key = keyOf(tool);
  return key ? `${tool.name} (${key})` : tool.name;
}

/** @returns {MenuItem[]} */
function items() {
  const all = tools.value.map((tool) => ({
    label: tool.name,
    hint: keyOf(tool),
    checked: tool.id === toolInHand.value?.id,
    disabled: !mayTake(tool),
    run: () => takeTool(tool.id),
  }));
  const properties = {
    label: t("panel.tools"),
    icon: "properties",
    run: () => commandById("panel.tools")?.run(),
  };
  return [...all, properties];
}
