/**
 * The row of tabs of a dock: tabs that never end in the middle of a word, a menu of those that do
 * not fit, and the buttons at its right end.
 */

/** @import { DockviewApi, DockviewGroupPanel } from "vendor/dockview.js" */

import { openMenu } from "./ui.js";

/** A tab of the dock; a panel may have tabs of its own inside. */
export const TAB = '.dv-tabs-container [role="tab"]';

/** @param {DockviewApi} api @param {string} id @returns {HTMLElement | null} the tab of a panel */
export function tabOfPanel(api, id) {
  const group = api.getPanel(id)?.group;
  const at = group?.panels.findIndex((panel) => panel.id === id) ?? -1;
  const tabs = group?.element.querySelectorAll(TAB);
  return /** @type {HTMLElement | null} */ (tabs?.[at] ?? null);
}

/**
 * @typedef {object} ActionOptions
 * @property {() => string} moreLabel
 * @property {(id: string) => string} title of a panel
 * @property {() => string} maximizeLabel
 * @property {() => string} restoreLabel
 * @property {(id: string) => string} helpLabel
 * @property {(id: string) => string} floatLabel
 * @property {(id: string) => string} dockLabel
 * @property {(id: string) => string} closeLabel
 * @property {(id: string) => string} menuLabel
 * @property {() => string} alonePanel the one that can be shown alone, and has a button for it
 * @property {() => string} aloneLabel
 * @property {() => void} onAlone
 * @property {(id: string) => void} onFloat
 * @property {(id: string) => void} onClose
 * @property {(id: string, button: HTMLElement) => void} onMenu what else can be done with it
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
      const [windows, relabelWindows] = windowButtons(group, options);
      element.append(moreButton(group, options), help, ...windows.slice(0, 2), maximize);
      element.append(...windows.slice(2));
      listening = [
        group.api.onDidActivePanelChange(relabelHelp),
        group.api.onDidActivePanelChange(relabelWindows),
        group.api.onDidLocationChange(relabelWindows),
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

/**
 * The menu of the panel in front, which narrow rows have instead of the others; into a window over
 * the others or back, or alone on the screen; and away.
 *
 * @param {DockviewGroupPanel} group
 * @param {ActionOptions} options
 * @returns {[HTMLElement[], () => void]} the buttons, and what names them anew
 */
function windowButtons(group, options) {
  const { icon, alonePanel, onAlone, onFloat, onClose, onMenu } = options;
  const inFront = () => group.activePanel?.id ?? "";
  const isAlone = () => inFront() === alonePanel();
  const menu = iconButton("panel-menu");
  const float = iconButton("float wide-action");
  const close = iconButton("close-panel wide-action");
  menu.append(icon("dots"));
  close.append(icon("close"));
  menu.setAttribute("aria-haspopup", "menu");
  menu.addEventListener("click", () => onMenu(inFront(), menu));
  float.addEventListener("click", () => (isAlone() ? onAlone() : onFloat(inFront())));
  close.addEventListener("click", () => onClose(inFront()));
  const isFloating = () => group.api.location.type === "floating";
  const rename = () => {
    const id = inFront();
    const ofWindow = isFloating() ? options.dockLabel : options.floatLabel;
    name(float, isAlone() ? options.aloneLabel() : ofWindow(id));
    name(close, options.closeLabel(id));
    name(menu, options.menuLabel(id));
  };
  const redraw = () => {
    group.element.classList.toggle("floating", isFloating());
    float.replaceChildren(icon(isAlone() ? "fullscreen" : isFloating() ? "dock" : "float"));
    rename();
  };
  // The language may have changed since.
  for (const one of [menu, float, close])
    for (const event of ["pointerenter", "focus"]) one.addEventListener(event, rename);
  redraw();
  return [[menu, float, close], redraw];
}

const HEADERS = ".dv-tabs-and-actions-container";
const TABS = ".dv-tabs-container";
/** A word says more than its icon: tabs come closer together first, then lose their icons. */
const STEPS = [[], ["close-tabs"], ["close-tabs", "bare-tabs"]];

/**
 * Tabs that never end in the middle of a word: what does not fit is reached by a menu at their
 * end.
 *
 * @param {HTMLElement} dock
 * @returns {() => void} to be called when tabs came, went, or moved
 */
export function keepTabsWhole(dock) {
  let asked = 0;
  const fitAll = () => {
    for (const header of dock.querySelectorAll(HEADERS)) fit(header);
  };
  // Not in the observer itself: what it changes would call it again within the same picture.
  const later = () => {
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(fitAll);
  };
  const observer = new ResizeObserver(later);
  // It is scrolled to a tab that is brought to the front; scrolling does not bubble.
  const scrolled = (/** @type {Event} */ { target }) => {
    if (target instanceof Element && target.matches(TABS)) hideCut(target);
  };
  dock.addEventListener("scroll", scrolled, { capture: true, passive: true });
  return () => {
    observer.disconnect();
    for (const one of dock.querySelectorAll(`${HEADERS}, ${HEADERS} .tab`)) observer.observe(one);
    fitAll(); // before they are first seen
    later();
  };
}

/** @param {Element} header */
function fit(header) {
  const tabs = header.querySelector(TABS);
  if (!tabs) return;
  for (const names of STEPS) {
    header.classList.remove(...STEPS.flat(), "has-more-tabs");
    header.classList.add(...names);
    if (tabs.scrollWidth <= tabs.clientWidth) break;
  }
  header.classList.toggle("has-more-tabs", tabs.scrollWidth > tabs.clientWidth);
  showActive(tabs);
  hideCut(tabs);
}

/** The tab of the panel that is seen stays in view when the row becomes narrower. @param {Element} tabs */
function showActive(tabs) {
  const active = tabs.querySelector(":scope > .dv-active-tab");
  if (!active) return;
  const [room, { left, right }] = [tabs.getBoundingClientRect(), active.getBoundingClientRect()];
  if (right > room.right) tabs.scrollLeft += Math.ceil(right - room.right);
  else if (left < room.left) tabs.scrollLeft -= Math.ceil(room.left - left);
  else return;
  // The dock scrolls back to where it last heard of, in this very picture if it is not told.
  tabs.dispatchEvent(new Event("scroll"));
}

/** A tab of which only a part is in view is not shown, but for the one in front: the menu has it. @param {Element} tabs */
function hideCut(tabs) {
  const room = tabs.getBoundingClientRect();
  for (const tab of tabs.children) {
    const { left, right } = tab.getBoundingClientRect();
    const isCut = left < room.left - 1 || right > room.right + 1;
    tab.classList.toggle("cut-tab", isCut && !tab.matches(".dv-active-tab"));
  }
}
