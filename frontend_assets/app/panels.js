/**
 * The panels by name: their icons, and the file that draws each, loaded when first shown. The words, the
 * styles and the help of a panel are in its folder.
 */

/** @import { Panel } from "../lib/dock.js" */

import { html, render, useEffect, useRef, useState } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { until, untilIdle, untilViewFetched } from "../lib/loading.js";
import { Icon, ProgressBar } from "../lib/ui.js";
import { changedCount, problems, robot } from "../model/document.js";
import { heldBack } from "../model/source.js";

/** What a panel is for, in the order in which menus list them. */
export const PANEL_GROUPS = /** @type {const} */ (["robot", "files", "watch", "act", "learn"]);

/** @typedef {typeof PANEL_GROUPS[number]} PanelGroup */

/**
 * @typedef {{icon: string, group: PanelGroup, keepsFrame?: boolean, heavy?: boolean, badge?: () => {text: string, tone: string, label: string} | null,
 *   load: () => Promise<() => import("vendor/preact.js").VNode>}} PanelEntry
 */

/** @type {Record<string, PanelEntry>} */
export const PANELS = {
  scene: {
    group: "robot",
    icon: "scene",
    keepsFrame: true,
    load: async () => (await import("../panels/scene/scene.js")).ScenePanel,
  },
  displays: {
    group: "robot",
    icon: "list",
    load: async () => (await import("../panels/displays/displays.js")).DisplaysPanel,
  },
  properties: {
    group: "robot",
    icon: "properties",
    badge: changedBadge,
    load: async () => (await import("../panels/properties/properties.js")).PropertiesPanel,
  },
  joints: {
    group: "robot",
    icon: "joints",
    load: async () => (await import("../panels/joints/joints.js")).JointsPanel,
  },
  variants: {
    group: "robot",
    icon: "variants",
    load: async () => (await import("../panels/variants/variants.js")).VariantsPanel,
  },
  source: {
    group: "files",
    icon: "source",
    heavy: true,
    load: async () => (await import("../panels/source/source.js")).SourcePanel,
  },
  outline: {
    group: "files",
    icon: "includes",
    load: async () => (await import("../panels/outline/outline.js")).OutlinePanel,
  },
  problems: {
    group: "files",
    icon: "problems",
    badge: problemsBadge,
    load: async () => (await import("../panels/problems/problems.js")).ProblemsPanel,
  },
  origin: {
    group: "robot",
    icon: "origin",
    load: async () => (await import("../panels/origin/origin.js")).OriginPanel,
  },
  masses: {
    group: "robot",
    icon: "masses",
    load: async () => (await import("../panels/masses/masses.js")).MassesPanel,
  },
  plot: {
    group: "watch",
    icon: "plot",
    load: async () => (await import("../panels/plot/plot.js")).PlotPanel,
  },
  image: {
    group: "watch",
    icon: "camera",
    load: async () => (await import("../panels/image/image.js")).ImagePanel,
  },
  topics: {
    group: "watch",
    icon: "topics",
    load: async () => (await import("../panels/topics/topics.js")).TopicsPanel,
  },
  frames: {
    group: "robot",
    icon: "frames",
    load: async () => (await import("../panels/frames/frames.js")).FramesPanel,
  },
  graph: {
    group: "watch",
    icon: "graph",
    load: async () => (await import("../panels/graph/graph.js")).GraphPanel,
  },
  interfaces: {
    group: "watch",
    icon: "interfaces",
    load: async () => (await import("../panels/interfaces/interfaces.js")).InterfacesPanel,
  },
  lessons: {
    group: "learn",
    icon: "lessons",
    load: async () => (await import("../panels/lessons/lessons.js")).LessonsPanel,
  },
  lifecycle: {
    group: "act",
    icon: "lifecycle",
    load: async () => (await import("../panels/lifecycle/lifecycle.js")).LifecyclePanel,
  },
  diagnostics: {
    group: "watch",
    icon: "diagnostics",
    load: async () => (await import("../panels/diagnostics/diagnostics.js")).DiagnosticsPanel,
  },
  log: {
    group: "watch",
    icon: "log",
    load: async () => (await import("../panels/log/log.js")).LogPanel,
  },
  services: {
    group: "act",
    icon: "services",
    load: async () => (await import("../panels/services/services.js")).ServicesPanel,
  },
  actions: {
    group: "act",
    icon: "goal",
    load: async () => (await import("../panels/actions/actions.js")).ActionsPanel,
  },
  parameters: {
    group: "act",
    icon: "parameters",
    load: async () => (await import("../panels/parameters/parameters.js")).ParametersPanel,
  },
  publish: {
    group: "act",
    icon: "send",
    load: async () => (await import("../panels/publish/publish.js")).PublishPanel,
  },
  teleop: {
    group: "act",
    icon: "compass",
    load: async () => (await import("../panels/teleop/teleop.js")).TeleopPanel,
  },
  turtlesim: {
    group: "learn",
    icon: "route",
    load: async () => (await import("../panels/turtlesim/turtlesim.js")).TurtlesimPanel,
  },
  jerry: {
    group: "learn",
    icon: "grid",
    load: async () => (await import("../panels/jerry/jerry.js")).JerryPanel,
  },
  urdf: {
    group: "files",
    icon: "urdf",
    load: async () => (await import("../panels/urdf/urdf.js")).UrdfPanel,
  },
};

/** @param {string} id */
export const panelTitle = (id) => t(`panel.${id}`);

function changedBadge() {
  const count = changedCount.value;
  return count > 0
    ? { text: String(count), tone: "amber", label: t("unsaved.count", { count }) }
    : null;
}

function problemsBadge() {
  const count = problems.value.length;
  if (count === 0) return null;
  const weights = new Set(problems.value.map(({ severity }) => severity));
  const bad = !heldBack.value && weights.has("error");
  const onlyNotes = !weights.has("error") && !weights.has("warning");
  return {
    text: String(count),
    tone: bad ? "red" : onlyNotes ? "calm" : "amber",
    label: t("problems.count", { count }),
  };
}

/** @param {{id: string}} props */
function Tab({ id }) {
  const entry = PANELS[id];
  const badge = entry?.badge?.();
  const face = useRef(/** @type {HTMLElement | null} */ (null));
  const name = [panelTitle(id), badge?.label].filter(Boolean).join(", ");
  // The dock names its tab after the panel, without the count that stands in it.
  useEffect(() => face.current?.closest('[role="tab"]')?.setAttribute("aria-label", name), [name]);
  return html`<span class="tab-face" ref=${face} title=${panelTitle(id)}><${Icon} name=${entry?.icon ?? "box"} /><span class="tab-label">${panelTitle(id)}</span>${" "}
    ${badge && html`<span class=${`badge ${badge.tone}`} title=${badge.label} aria-label=${badge.label}>${badge.text}</span>`}</span>`;
}

/** A robot that takes longer than this is not waited for. */
const PATIENCE_MS = 1500;
/** Settles when the panels that were asked for so far are here. @type {Promise<unknown>} */
let others = Promise.resolve();

/** @param {string} id what takes long comes once the rest of the page stands */
async function fetched(id) {
  const entry = PANELS[id];
  if (entry?.heavy) {
    await others;
    await untilViewFetched();
    await until(() => robot.value !== null, PATIENCE_MS);
    await untilIdle();
    return entry.load();
  }
  const panel = entry?.load();
  others = Promise.allSettled([others, panel]);
  return panel;
}

/** @param {{id: string}} props draws the panel as soon as its file is here */
function Loaded({ id }) {
  const [drawn, setDrawn] = useState(
    /** @type {{panel: () => import("vendor/preact.js").VNode} | null} */ (null),
  );
  useEffect(() => {
    fetched(id).then((panel) => panel && setDrawn({ panel }));
  }, [id]);
  if (!drawn) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<${drawn.panel} />`;
}

/** @param {{id: string}} props its tab shows its name; whoever goes by headings hears it here */
function Titled({ id }) {
  return html`<h2 class="panel-title">${panelTitle(id)}</h2><${Loaded} id=${id} />`;
}

/** @param {string} id @returns {Panel} for the dock */
function dockPanel(id) {
  const { keepsFrame = false } = PANELS[id] ?? {};
  return {
    title: () => panelTitle(id),
    keepsFrame,
    mount: (element) => drawn(element, html`<${Titled} id=${id} />`),
    mountTab: (element) => drawn(element, html`<${Tab} id=${id} />`),
  };
}

/** @param {HTMLElement} element @param {import("vendor/preact.js").VNode} node @returns {() => void} */
function drawn(element, node) {
  render(node, element);
  return () => render(null, element);
}

/** @returns {Record<string, Panel>} */
export function dockPanels() {
  return Object.fromEntries(Object.keys(PANELS).map((id) => [id, dockPanel(id)]));
}
