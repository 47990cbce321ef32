/** The buttons at the right end of a row of tabs: those that do not fit, help on the panel in front, and enlarging it. */

/** @import { DockviewApi, DockviewGroupPanel } from "vendor/dockview.js" */

import { openMenu } from "./ui.js";

/**
 * @typedef {object} ActionOptions
 * @property {() => string} moreLabel
 * @property {(id: string) => string} title of a panel
 * @property {() => string} maximizeLabel
 * @property {() => string} restoreLabel
 * @property {(id: string) => string} helpLabel
 * @property {(id: string, button: HTMLElement) => void} onHelp
 * @property {(name: string) => Element} icon
 */

/** @param {DockviewGroupPanel} group @param {ActionOptions} options */
export function headerActions(group, options) {
  const element = document.createElement("div");
  element.className = "dock-actions";
  /** @type {{dispose: () => void}[]} */
  let listening = [];
  return {
    element,
    /** @param {{containerApi: DockviewApi}} parameters */
    init({ containerApi }) {
      const [help, relabelHelp] = helpButton(group, options);
      const [maximize, relabelMaximize] = maximizeButton(group, options);
      element.append(moreButton(group, options), help, maximize);
      listening = [
        group.api.onDidActivePanelChange(relabelHelp),
        containerApi.onDidMaximizedGroupChange(relabelMaximize),
      ];
    },
    dispose() {
      for (const one of listening) one.dispose();
    },
  };
}

/** @param {string} names @returns {HTMLButtonElement} */
function iconButton(names) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = `icon-button dock-action ${names}`;
  return button;
}

/** @param {HTMLElement} button @param {string} label */
function name(button, label) {
  button.title = label;
  button.setAttribute("aria-label", label);
}

/** Opens a menu of the tabs that do not fit; seen where there are some. @param {DockviewGroupPanel} group @param {ActionOptions} options @returns {HTMLElement} */
function moreButton(group, { moreLabel, title, icon }) {
  const button = iconButton("more-tabs");
  const relabel = () => name(button, moreLabel());
  button.append(icon("chevronDown"));
  button.setAttribute("aria-haspopup", "menu");
  button.addEventListener("click", () => {
    const tabs = group.element.querySelectorAll('[role="tab"]');
    const hidden = group.panels.filter((_, at) => tabs[at]?.classList.contains("cut-tab"));
    const items = hidden.map((panel) => ({
      label: title(panel.id),
      run: () => panel.api.setActive(),
    }));
    openMenu(button, moreLabel(), items);
  });
  button.addEventListener("pointerenter", relabel);
  button.addEventListener("focus", relabel);
  relabel();
  return button;
}

/** @param {DockviewGroupPanel} group @param {ActionOptions} options @returns {[HTMLElement, () => void]} the button, and what names it anew */
function helpButton(group, { helpLabel, onHelp, icon }) {
  const button = iconButton("panel-help");
  const inFront = () => group.activePanel?.id;
  const relabel = () => name(button, helpLabel(inFront() ?? ""));
  button.append(icon("help"));
  button.addEventListener("click", () => {
    const id = inFront();
    if (id) onHelp(id, button);
  });
  // The language may have changed since.
  button.addEventListener("pointerenter", relabel);
  button.addEventListener("focus", relabel);
  relabel();
  return [button, relabel];
}

/** @param {DockviewGroupPanel} group @param {ActionOptions} options @returns {[HTMLElement, () => void]} the button, and what names it anew */
function maximizeButton(group, { maximizeLabel, restoreLabel, icon }) {
  const button = iconButton("maximize");
  const relabel = () => {
    const big = group.api.isMaximized();
    button.replaceChildren(icon(big ? "minimize" : "maximize"));
    name(button, big ? restoreLabel() : maximizeLabel());
  };
  button.addEventListener("click", () => {
    if (group.api.isMaximized()) group.api.exitMaximized();
    else group.api.maximize();
  });
  relabel();
  return [button, relabel];
}
