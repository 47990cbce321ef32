/** The dock: panels in tabs and splits. The one place that knows dockview, so that it can be replaced. */

/** @import { DockviewApi, IDockviewPanel } from "vendor/dockview.js" */
/** @import { Arrangement } from "./arrangement.js" */
/** @import { Group } from "./dock-floating.js" */
/** @import { ActionOptions } from "./dock-tabs.js" */

import { createDockview } from "vendor/dockview.js";
import { fromDockview, toDockview } from "./arrangement.js";
import {
  aloneIn,
  dockPanel,
  floatPanel,
  isFloating,
  isInGrid,
  moveFloatingByKey,
} from "./dock-floating.js";
import { headerActions, keepTabsWhole, TAB, tabOfPanel } from "./dock-tabs.js";

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
 * @property {(id: string) => void} add a panel behind the others, where it is missing
 * @property {() => void} nameAll panels by their titles, in another language or with their words
 * @property {(id: string) => boolean} isOpen
 * @property {() => string | null} active
 * @property {(step: 1 | -1) => void} focusNext
 * @property {() => void} toggleMaximized the active panel over all others, and back
 * @property {(id: string) => void} close it, which `show` opens anew
 * @property {(id: string) => boolean} isFloating it is in a window over the others
 * @property {(id: string) => void} toggleFloating into such a window, and back to where it stood
 * @property {(id: string | null) => void} showAlone one panel, without any other and without its tab; null: all again
 * @property {(id: string) => Place[]} places where else it can stand
 * @property {(id: string, place: Place) => void} move
 * @property {(id: string) => HTMLElement | null} tab
 * @property {(target: EventTarget | null) => string | null} panelOfTab whose tab it lies in
 * @property {(arrangement: Arrangement) => void} arrange
 * @property {() => Arrangement} arrangement as it is now
 * @property {(single: boolean) => void} setSingle one panel at a time, without tabs
 * @property {() => void} relabel titles are said anew
 */

const THEME = { name: "studio", className: "dockview-theme-studio", gap: 6 };

/**
 * @param {HTMLElement} element
 * @param {Record<string, Panel>} panels
 * @param {ActionOptions & {onChange: () => void, onActive: (id: string | null) => void, onKey: (event: KeyboardEvent) => void}} options
 *   `onKey` is given strokes at tabs with Ctrl, Alt or Command held, which come no further
 * @returns {Dock}
 */
export function createDock(element, panels, options) {
  /** @type {Restores} */
  const restores = new Set();
  const api = createDockview(element, {
    theme: THEME,
    floatingGroupBounds: "boundedWithinViewport",
    disableTabsOverflowList: true,
    noPanelsOverlay: "watermark",
    createComponent: ({ name }) => contentOf(panels[name], restores),
    createTabComponent: ({ name }) => tabOf(panels[name]),
    createRightHeaderActionComponent: (group) => headerActions(group, options),
  });
  // The panel in it is a landmark of the same name.
  api.onDidAddGroup((group) => group.element.setAttribute("role", "group"));
  element.addEventListener("keydown", (event) => onTabKey(api, event));
  // The dock takes Enter and arrows at its tabs for its own, whatever is held with them.
  element.addEventListener(
    "keydown",
    (event) => {
      if (!isHeldAtTab(event)) return;
      event.stopPropagation();
      if (!moveFloatingByKey(api, event)) options.onKey(event);
    },
    { capture: true },
  );
  /** Where floating panels came from, by id: a panel that stood beside it. */
  const homes = new Map();
  const alone = aloneIn(api, element, arrangeNow);
  keepTabOrder(element, () => layered(api, panels));
  const tabsChanged = keepTabsWhole(element);
  let quiet = false;
  let single = false;
  api.onDidLayoutChange(() => {
    tabsChanged();
    if (!quiet && !single && !alone.before()) options.onChange();
  });

  api.onDidActivePanelChange(({ panel }) => {
    tabsChanged();
    options.onActive(panel?.id ?? null);
  });

  /** @param {Arrangement} arrangement shown once no panel is alone */
  function arrange(arrangement) {
    if (!alone.keep(arrangement)) arrangeNow(arrangement);
  }

  /** @param {Arrangement} arrangement */
  function arrangeNow(arrangement) {
    quiet = true;
    for (const { tabs, home } of arrangement.floating ?? [])
      if (tabs[0] && home) homes.set(tabs[0], home);
    const [width, height] = [element.clientWidth || 1200, element.clientHeight || 800];
    const room = { width, height, gap: THEME.gap };
    const layout = toDockview(arrangement, room, (id) => described(id, panels));
    api.fromJSON(layout, { reuseExistingPanels: true });
    for (const restore of restores) restore();
    // dockview tells of changes in a later task; they are not the person's.
    setTimeout(() => {
      quiet = false;
    }, 200);
    applySingle();
  }

  /** @returns {Arrangement} as it is now, or as it was before one panel was shown alone */
  function arrangement() {
    const before = alone.before();
    if (before) return before;
    const { floating, ...rest } = fromDockview(api.toJSON());
    if (!floating) return rest;
    const known = floating.map((one) => ({ ...one, home: homes.get(one.tabs[0]) }));
    return { ...rest, floating: known.map(({ home, ...one }) => (home ? { ...one, home } : one)) };
  }

  function applySingle() {
    for (const group of api.groups) group.model.header.hidden = single;
    api.updateOptions({ disableDnd: single, disableFloatingGroups: single });
  }

  return {
    show: (id) => show(api, panels, id),
    showBeside: (id, other) => {
      show(api, panels, id);
      if (!single) uncover(api, panels, id, other);
    },
    add(id) {
      const addNow = () => {
        if (!api.getPanel(id)) add(api, panels, id, true);
      };
      const addLater = () => {
        addNow();
        options.onChange(); // it comes while the dock is still quiet
      };
      if (!alone.later(addLater)) addNow();
    },
    nameAll() {
      for (const { id, api: one } of api.panels) one.setTitle(titleOf(id, panels));
    },
    isOpen: (id) => api.getPanel(id) !== undefined,
    active: () => api.activePanel?.id ?? null,
    focusNext: (step) => focusNext(api, step),
    toggleMaximized: () => toggleMaximized(api),
    isFloating: (id) => isFloating(api.getPanel(id)),
    toggleFloating: (id) => {
      if (single) return;
      if (isFloating(api.getPanel(id)))
        dockPanel(api, id, homes.get(id), (group) => !keepsFrame(group, panels));
      else if (!panels[id]?.keepsFrame) {
        show(api, panels, id);
        floatPanel(api, id, homes, element);
      }
      tabOfPanel(api, id)?.focus();
    },
    showAlone: (id) => {
      if (id === null) return alone.end(single);
      show(api, panels, id);
      const panel = api.getPanel(id);
      if (panel) alone.begin(panel, arrangement);
    },
    close: (id) => api.getPanel(id)?.api.close(),
    places: (id) => placesFor(api, id),
    move: (id, place) => {
      movePanel(api, id, place);
      tabOfPanel(api, id)?.focus();
    },
    tab: (id) => tabOfPanel(api, id),
    panelOfTab: (target) => panelOfTab(api, target),
    arrange,
    arrangement,
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
  if (open) open.api.setActive();
  else add(api, panels, id);
}

/** @param {DockviewApi} api @param {Record<string, Panel>} panels @param {string} id @param {boolean} [inactive] behind the others */
function add(api, panels, id, inactive = false) {
  const panel = panels[id];
  if (!panel) return;
  const group = api.groups.find((one) => isInGrid(one) && !keepsFrame(one, panels));
  api.addPanel({
    id,
    component: id,
    tabComponent: id,
    title: panel.title(),
    inactive,
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
    .filter((group) => group !== kept.group && isInGrid(group) && !keepsFrame(group, panels))
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

/** @param {KeyboardEvent} event @returns {boolean} a tab has the focus, and more than Shift is held */
function isHeldAtTab({ target, ctrlKey, metaKey, altKey }) {
  return (
    (ctrlKey || metaKey || altKey) && target instanceof Element && target.closest(TAB) !== null
  );
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

/** @param {DockviewApi} api @param {Record<string, Panel>} panels @returns {Layered[]} those that are shown */
function layered(api, panels) {
  return api.panels.flatMap((panel) => {
    const header = panel.group.element.querySelector(".dv-tabs-and-actions-container");
    const isShown = panels[panel.id]?.keepsFrame && panel.api.isVisible;
    return isShown && header ? [{ header, content: panel.view.content.element }] : [];
  });
}

/** @param {DockviewApi} api a window over the others has its own size */
function toggleMaximized(api) {
  if (api.hasMaximizedGroup()) api.exitMaximizedGroup();
  else if (!isFloating(api.activePanel)) api.activePanel?.api.maximize();
}

/** @param {Group} group @param {Record<string, Panel>} panels */
const keepsFrame = (group, panels) => group.panels.some(({ id }) => panels[id]?.keepsFrame);

/** @param {string} id @param {Record<string, Panel>} panels */
const titleOf = (id, panels) => panels[id]?.title() ?? id;

/** @param {string} id @param {Record<string, Panel>} panels */
function described(id, panels) {
  const renderer = panels[id]?.keepsFrame ? "always" : "onlyWhenVisible";
  return { id, contentComponent: id, tabComponent: id, title: titleOf(id, panels), renderer };
}

/** @param {DockviewApi} api @param {EventTarget | null} target @returns {string | null} */
function panelOfTab(api, target) {
  const tab = target instanceof Element ? target.closest(TAB) : null;
  return (tab && api.panels.find(({ id }) => tabOfPanel(api, id) === tab)?.id) ?? null;
}

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
function placesFor(api, id) {
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
function movePanel(api, id, place) {
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

/**
 * Such a panel lies in a layer above the dock, for an iframe that leaves the document loads anew.
 * The dock measures its place when it arranges panels; what changes later, a style sheet that comes
 * late, say, it does not see.
 *
 * @param {HTMLElement} element the panel's content
 * @param {IDockviewPanel["api"]} api
 * @returns {() => void} the end of it
 */
function keepInPlace(element, api) {
  const watcher = new ResizeObserver(() => place(element, referenceOf(api)));
  const follow = () => {
    watcher.disconnect();
    const reference = referenceOf(api);
    if (reference) watcher.observe(reference);
  };
  follow();
  const moved = api.onDidGroupChange(follow);
  return () => {
    moved.dispose();
    watcher.disconnect();
  };
}

/** @param {IDockviewPanel["api"]} api @returns {HTMLElement | null} what the panel is to cover */
function referenceOf(api) {
  return api.group.element.querySelector(".dv-content-container");
}

/** @param {HTMLElement} element @param {HTMLElement | null} reference */
function place(element, reference) {
  const layer = element.parentElement;
  const around = layer?.parentElement?.getBoundingClientRect();
  const wanted = reference?.getBoundingClientRect();
  if (!layer || !around || !wanted || wanted.width === 0 || wanted.height === 0) return;
  layer.style.left = `${wanted.left - around.left}px`;
  layer.style.top = `${wanted.top - around.top}px`;
  layer.style.width = `${wanted.width}px`;
  layer.style.height = `${wanted.height}px`;
}

const STOPS =
  'a[href], button:not(:disabled), input:not(:disabled), select:not(:disabled), textarea:not(:disabled), [contenteditable="true"], [tabindex]';

/** @typedef {{header: Element, content: Element}} Layered a panel's row of tabs, and what lies in the layer */

/**
 * The Tab key along the page: a panel that lies in a layer above the dock comes last in the
 * document, and yet is reached right behind its own tab, and left for what stands there next.
 *
 * @param {HTMLElement} dock
 * @param {() => Layered[]} layered
 */
function keepTabOrder(dock, layered) {
  dock.addEventListener("keydown", (event) => {
    const { key, ctrlKey, altKey, metaKey, defaultPrevented } = event;
    if (key !== "Tab" || ctrlKey || altKey || metaKey || defaultPrevented) return;
    for (const part of layered()) {
      const next = nextStop(dock, part, event.shiftKey);
      if (!next) continue;
      event.preventDefault();
      next.focus();
      return;
    }
  });
}

/** @param {HTMLElement} dock @param {Layered} part @param {boolean} back @returns {HTMLElement | undefined} where the browser would go elsewhere */
function nextStop(dock, { header, content }, back) {
  const inside = stopsIn(content);
  const outside = stopsIn(dock).filter((one) => !content.contains(one));
  const at = outside.findLastIndex((one) => header.contains(one));
  const [before, after] = [outside[at], outside[at + 1]];
  const [first, last] = [inside[0], inside.at(-1)];
  const now = document.activeElement;
  if (!first || !before) return undefined;
  if (back) return now === first ? before : now === after ? last : undefined;
  return now === before ? first : now === last ? after : undefined;
}

/** @param {Element} element @returns {HTMLElement[]} where Tab stops in it; a frame has stops of its own */
function stopsIn(element) {
  const all = /** @type {NodeListOf<HTMLElement>} */ (element.querySelectorAll(STOPS));
  return [...all].filter((one) => one.tabIndex >= 0 && one.checkVisibility());
}

/**
 * Where things are scrolled to, kept while their panel is out of the page, for the browser
 * forgets it.
 *
 * @param {HTMLElement} element that leaves the document and comes back
 * @returns {() => void} to be called when it is back: all in it is scrolled as it was left
 */
function keepScrolled(element) {
  /** @type {Map<Element, {top: number, left: number}>} */
  const places = new Map();
  const note = (/** @type {Event} */ { target }) => {
    if (!(target instanceof Element) || !element.isConnected) return;
    places.set(target, { top: target.scrollTop, left: target.scrollLeft });
  };
  // Scrolling does not bubble, but it can be seen on its way down.
  element.addEventListener("scroll", note, { capture: true, passive: true });
  return () => {
    for (const [one, place] of places) {
      if (element.contains(one)) one.scrollTo({ ...place, behavior: "instant" });
      else places.delete(one);
    }
  };
}
