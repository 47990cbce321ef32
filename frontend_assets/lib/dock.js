/** The dock: panels in tabs and splits. The one place that knows dockview, so that it can be replaced. */

/** @import { DockviewApi, IDockviewPanel } from "vendor/dockview.js" */
/** @import { Arrangement } from "./arrangement.js" */
/** @import { ActionOptions } from "./dock-actions.js" */
/** @import { Place } from "./dock-places.js" */

import { createDockview } from "vendor/dockview.js";
import { fromDockview, toDockview } from "./arrangement.js";
import { headerActions } from "./dock-actions.js";
import { movePanel, placesFor } from "./dock-places.js";
import { keepInPlace } from "./frame-place.js";
import { keepTabOrder } from "./frame-tabs.js";
import { keepScrolled } from "./scrolled.js";
import { keepTabsWhole } from "./tight-tabs.js";

/**
 * @typedef {object} Panel
 * @property {() => string} title
 * @property {boolean} [keepsFrame] holds an iframe, which must never leave the document
 * @property {(element: HTMLElement) => () => void} mount draws into the element; returns the end of it
 * @property {(element: HTMLElement) => () => void} mountTab the same for its tab
 */

/**
 * @typedef {object} Dock
 * @property {(id: string) => void} show bring a panel to the front, opened where it is missing
 * @property {(id: string, other: string) => void} showBeside the same, with another one kept in sight
 * @property {() => void} nameAll panels by their titles, in another language or with their words
 * @property {(id: string) => boolean} isOpen
 * @property {() => string | null} active
 * @property {(step: 1 | -1) => void} focusNext
 * @property {() => void} toggleMaximized the active panel over all others, and back
 * @property {(id: string) => void} close it, which `show` opens anew
 * @property {(id: string) => Place[]} places where else it can stand
 * @property {(id: string, place: Place) => void} move
 * @property {(id: string) => HTMLElement | null} tab
 * @property {(target: EventTarget | null) => string | null} panelOfTab whose tab it lies in
 * @property {(arrangement: Arrangement) => void} arrange
 * @property {() => Arrangement} arrangement as it is now
 * @property {(single: boolean) => void} setSingle one panel at a time, without tabs
 * @property {() => void} relabel titles are said anew
 */

/** A tab of the dock; a panel may have tabs of its own inside. */
const TAB = '.dv-tabs-container [role="tab"]';
const THEME = { name: "studio", className: "dockview-theme-studio", gap: 6 };

/**
 * @param {HTMLElement} element
 * @param {Record<string, Panel>} panels
 * @param {ActionOptions & {onChange: () => void, onActive: (id: string | null) => void}} options
 * @returns {Dock}
 */
export function createDock(element, panels, options) {
  /** @type {Restores} */
  const restores = new Set();
  const api = createDockview(element, {
    theme: THEME,
    disableFloatingGroups: true,
    disableTabsOverflowList: true,
    noPanelsOverlay: "watermark",
    createComponent: ({ name }) => contentOf(panels[name], restores),
    createTabComponent: ({ name }) => tabOf(panels[name]),
    createRightHeaderActionComponent: (group) => headerActions(group, options),
  });
  // The panel in it is a landmark of the same name.
  api.onDidAddGroup((group) => group.element.setAttribute("role", "group"));
  element.addEventListener("keydown", (event) => onTabKey(api, event));
  keepTabOrder(element, () => layered(api, panels));
  const tabsChanged = keepTabsWhole(element);
  let quiet = false;
  let single = false;
  api.onDidLayoutChange(() => {
    tabsChanged();
    if (!quiet && !single) options.onChange();
  });

  api.onDidActivePanelChange(({ panel }) => {
    tabsChanged();
    options.onActive(panel?.id ?? null);
  });

  /** @param {Arrangement} arrangement */
  function arrange(arrangement) {
    quiet = true;
    const room = { width: element.clientWidth || 1200, height: element.clientHeight || 800 };
    const layout = toDockview(arrangement, room, (id) => described(id, panels));
    api.fromJSON(layout, { reuseExistingPanels: true });
    for (const restore of restores) restore();
    // dockview tells of changes in a later task; they are not the person's.
    setTimeout(() => {
      quiet = false;
    }, 200);
    applySingle();
  }

  function applySingle() {
    for (const group of api.groups) group.model.header.hidden = single;
    api.updateOptions({ disableDnd: single });
  }

  return {
    show: (id) => show(api, panels, id),
    showBeside: (id, other) => {
      show(api, panels, id);
      if (!single) uncover(api, panels, id, other);
    },
    nameAll() {
      for (const { id, api: one } of api.panels) one.setTitle(titleOf(id, panels));
    },
    isOpen: (id) => api.getPanel(id) !== undefined,
    active: () => api.activePanel?.id ?? null,
    focusNext: (step) => focusNext(api, step),
    toggleMaximized: () => toggleMaximized(api),
    close: (id) => api.getPanel(id)?.api.close(),
    places: (id) => placesFor(api, id),
    move: (id, place) => {
      movePanel(api, id, place);
      tabOfPanel(api, id)?.focus();
    },
    tab: (id) => tabOfPanel(api, id),
    panelOfTab: (target) => panelOfTab(api, target),
    arrange,
    arrangement: () => fromDockview(api.toJSON()),
    setSingle(on) {
      single = on;
      applySingle();
    },
    relabel() {
      for (const panel of api.panels) panel.setTitle(panels[panel.id]?.title() ?? panel.id);
    },
  };
}

/** What scrolls the panels to where they were, once they are back in the page. @typedef {Set<() => void>} Restores */

/** @param {Panel | undefined} panel @param {Restores} restores */
function contentOf(panel, restores) {
  const element = document.createElement("div");
  element.className = "panel";
  const restore = keepScrolled(element);
  restores.add(restore);
  let end = () => {};
  return {
    element,
    /** @param {{api: IDockviewPanel["api"]}} parameters */
    init({ api }) {
      /** @type {(() => void) | undefined} */
      let unmount;
      // What nobody looks at need not be drawn, nor its file be loaded.
      const mount = () => {
        unmount ??= panel?.mount(element);
      };
      const shown = api.onDidVisibilityChange(({ isVisible }) => {
        if (!isVisible) return;
        mount();
        restore();
      });
      queueMicrotask(() => (api.isVisible || panel?.keepsFrame) && mount());
      const letGo = panel?.keepsFrame ? keepInPlace(element, api) : () => {};
      end = () => {
        letGo();
        restores.delete(restore);
        shown.dispose();
        unmount?.();
      };
    },
    dispose: () => end(),
  };
}

/** @param {Panel | undefined} panel */
function tabOf(panel) {
  const element = document.createElement("div");
  element.className = "tab";
  let end = () => {};
  return {
    element,
    init() {
      end = panel?.mountTab(element) ?? end;
    },
    dispose: () => end(),
  };
}

/** @param {DockviewApi} api @param {Record<string, Panel>} panels @param {string} id */
function show(api, panels, id) {
  const open = api.getPanel(id);
  if (open) {
    open.api.setActive();
    return;
  }
  const panel = panels[id];
  if (!panel) return;
  const group = api.groups.find(
    (one) => !one.panels.some(({ id: other }) => panels[other]?.keepsFrame),
  );
  api.addPanel({
    id,
    component: id,
    tabComponent: id,
    title: panel.title(),
    renderer: panel.keepsFrame ? "always" : "onlyWhenVisible",
    ...(group ? { position: { referenceGroup: group } } : {}),
  });
}

/**
 * Move a panel that was just shown out of the group of another one, which it would cover.
 *
 * @param {DockviewApi} api @param {Record<string, Panel>} panels @param {string} id @param {string} other
 */
function uncover(api, panels, id, other) {
  if (api.hasMaximizedGroup()) api.exitMaximizedGroup();
  const [panel, kept] = [api.getPanel(id), api.getPanel(other)];
  if (!panel || !kept || panel === kept || panel.group !== kept.group) return;
  const area = (/** @type {DockviewApi["groups"][number]} */ { element }) =>
    element.clientWidth * element.clientHeight;
  const [largest] = api.groups
    .filter(
      (group) => group !== kept.group && !group.panels.some((one) => panels[one.id]?.keepsFrame),
    )
    .sort((a, b) => area(b) - area(a));
  if (largest) movePanel(api, id, { kind: "beside", group: largest.id, names: [] });
  else movePanel(api, id, { kind: "split", edge: "right" });
  kept.api.setActive();
  api.getPanel(id)?.api.setActive();
}

/** @param {DockviewApi} api @param {1 | -1} step focus goes into the shown panel of the next group */
function focusNext(api, step) {
  const groups = api.groups.filter((group) => group.api.isVisible);
  const at = groups.findIndex((group) => group.element.contains(document.activeElement));
  const from = at < 0 ? groups.findIndex((group) => group.id === api.activeGroup?.id) : at;
  const group = groups[(from + step + groups.length) % groups.length];
  group?.activePanel?.api.setActive();
  /** @type {HTMLElement | null | undefined} */
  const tab =
    group?.element.querySelector(`${TAB}[aria-selected="true"]`) ??
    group?.element.querySelector(TAB);
  tab?.focus();
}

/** Arrow keys move along the tabs of a group, as people expect of tabs. @param {DockviewApi} api @param {KeyboardEvent} event */
function onTabKey(api, event) {
  const tab = event.target instanceof Element ? event.target.closest(TAB) : null;
  const group = api.groups.find((one) => tab && one.element.contains(tab));
  if (!tab || !group) return;
  const tabs = [...group.element.querySelectorAll(TAB)];
  const at = tabs.indexOf(tab);
  /** @type {Record<string, number>} */
  const targets = {
    ArrowRight: at + 1,
    ArrowLeft: at - 1 + tabs.length,
    Home: 0,
    End: tabs.length - 1,
    Enter: at,
    " ": at,
  };
  const target = targets[event.key];
  if (target === undefined) return;
  event.preventDefault();
  const next = target % tabs.length;
  group.panels[next]?.api.setActive();
  /** @type {HTMLElement | undefined} */ (tabs[next])?.focus();
}

/** @param {DockviewApi} api @param {Record<string, Panel>} panels @returns {import("./frame-tabs.js").Layered[]} those that are shown */
function layered(api, panels) {
  return api.panels.flatMap((panel) => {
    const header = panel.group.element.querySelector(".dv-tabs-and-actions-container");
    const isShown = panels[panel.id]?.keepsFrame && panel.api.isVisible;
    return isShown && header ? [{ header, content: panel.view.content.element }] : [];
  });
}

/** @param {DockviewApi} api */
function toggleMaximized(api) {
  if (api.hasMaximizedGroup()) api.exitMaximizedGroup();
  else api.activePanel?.api.maximize();
}

/** @param {string} id @param {Record<string, Panel>} panels */
const titleOf = (id, panels) => panels[id]?.title() ?? id;

/** @param {string} id @param {Record<string, Panel>} panels */
function described(id, panels) {
  const renderer = panels[id]?.keepsFrame ? "always" : "onlyWhenVisible";
  return { id, contentComponent: id, tabComponent: id, title: titleOf(id, panels), renderer };
}

/** @param {DockviewApi} api @param {string} id @returns {HTMLElement | null} the tab of a panel */
function tabOfPanel(api, id) {
  const group = api.getPanel(id)?.group;
  const at = group?.panels.findIndex((panel) => panel.id === id) ?? -1;
  const tabs = group?.element.querySelectorAll(TAB);
  return /** @type {HTMLElement | null} */ (tabs?.[at] ?? null);
}

/** @param {DockviewApi} api @param {EventTarget | null} target @returns {string | null} */
function panelOfTab(api, target) {
  const tab = target instanceof Element ? target.closest(TAB) : null;
  return (tab && api.panels.find(({ id }) => tabOfPanel(api, id) === tab)?.id) ?? null;
}
