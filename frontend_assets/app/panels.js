/**
 * The panels by name, as the server found them in their folders: what `panel.json` says of each, and
 * its component, which is loaded when it is first shown.
 */

/** @import { Panel } from "../lib/dock.js" */
/** @import { Shapes } from "../lib/ui.js" */
/** @import { Places } from "./layouts.js" */

import { html, render, useEffect, useRef, useState } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { courtesyMs, until, untilIdle, untilViewFetched } from "../lib/loading.js";
import { addIcons, badgeTone, Icon, ProgressBar } from "../lib/ui.js";
import { asking } from "../model/class.js";
import { role } from "../model/connection.js";
import { changedCount, problems, robot } from "../model/document.js";
import { heldBack } from "../model/source.js";
import { viewportConnected } from "../model/viewport.js";
import { ScenePanel } from "../panels/scene/scene.js";

/** What a panel is for, in the order in which menus list them. */
export const PANEL_GROUPS = /** @type {const} */ (["robot", "files", "watch", "act", "learn"]);

/** @typedef {typeof PANEL_GROUPS[number]} PanelGroup */

/**
 * @typedef {object} PanelFile what `panels/<id>/panel.json` says, besides the panel's words
 * @property {PanelGroup} group
 * @property {string | Shapes} icon name of one that several use, or the shapes of its own, which is then named by its id
 * @property {number} [order] in menus and in the help; without it comes last
 * @property {Places} [places] in the first layouts
 * @property {boolean} [runs] in the first layouts of a robot it stands only where something may be run
 * @property {keyof typeof BADGES} [badge] what is counted on its tab
 * @property {boolean} [keepsFrame] its element is never moved: a frame in it would load anew
 * @property {boolean} [heavy] takes long, so it is loaded once the rest of the page stands
 */

/** @typedef {() => import("vendor/preact.js").VNode} Component */
/** @typedef {Omit<PanelFile, "icon" | "badge"> & {icon: string, badge: () => Badge | null, load: () => Promise<Component>}} PanelEntry */
/** @typedef {{text: string, tone: string, label: string}} Badge */

const BADGES = { asking: askingBadge, changed: changedBadge, problems: problemsBadge };
const noBadge = () => null;
const LAST = Number.MAX_VALUE;
/** These come with the page. @type {Record<string, Component>} */
const FIRST = { scene: ScenePanel };

/** @type {Record<string, PanelEntry>} */
export const PANELS = readPanels(
  JSON.parse(globalThis.document?.getElementById("panels")?.textContent ?? "{}"),
);

/** @param {Record<string, PanelFile>} found by the names of their folders @returns {Record<string, PanelEntry>} in the order of menus */
export function readPanels(found) {
  const files = Object.entries(found);
  files.sort(([, { order: one = LAST }], [, { order: other = LAST }]) => one - other);
  return Object.fromEntries(files.map(([id, file]) => [id, panelEntry(id, file)]));
}

/** @param {string} id @param {PanelFile} file @returns {PanelEntry} */
function panelEntry(id, { icon, badge, ...file }) {
  if (typeof icon !== "string") addIcons({ [id]: icon });
  return {
    ...file,
    icon: typeof icon === "string" ? icon : id,
    badge: badge ? BADGES[badge] : noBadge,
    load: async () => FIRST[id] ?? componentOf(id),
  };
}

/** @param {string} id @returns {Promise<Component>} its `<Id>Panel` */
async function componentOf(id) {
  const module = await import(`../panels/${id}/${id}.js`);
  return module[`${id.charAt(0).toUpperCase()}${id.slice(1)}Panel`];
}

/** @param {string} id */
export const panelTitle = (id) => t(`panel.${id}`);

function askingBadge() {
  const count = asking.value.length;
  return count > 0
    ? { text: String(count), tone: "amber", label: t("class.asking", { count }) }
    : null;
}

function changedBadge() {
  const count = changedCount.value;
  return count > 0
    ? { text: String(count), tone: "amber", label: t("unsaved.count", { count }) }
    : null;
}

function problemsBadge() {
  const count = problems.value.length;
  if (count === 0) return null;
  const tone = badgeTone(problems.value);
  return {
    text: String(count),
    tone: tone === "red" && heldBack.value ? "amber" : tone,
    label: t("problems.count", { count }),
  };
}

/** @param {{id: string}} props */
function Tab({ id }) {
  const entry = PANELS[id];
  const badge = entry?.badge();
  const face = useRef(/** @type {HTMLElement | null} */ (null));
  const name = [panelTitle(id), badge?.label].filter(Boolean).join(", ");
  // The dock names its tab after the panel, without the count that stands in it.
  useEffect(() => face.current?.closest('[role="tab"]')?.setAttribute("aria-label", name), [name]);
  return html`<span class="tab-face" ref=${face} title=${panelTitle(id)}><${Icon} name=${entry?.icon ?? "box"} /><span class="tab-label">${panelTitle(id)}</span>${" "}
    ${badge && html`<span class=${`badge ${badge.tone}`} title=${badge.label} aria-label=${badge.label}>${badge.text}</span>`}</span>`;
}

/** A robot that takes longer than this is not waited for. */
const PATIENCE_MS = 3000;
/** Settles when the panels that were asked for so far are here. @type {Promise<unknown>} */
let others = Promise.resolve();

/** @returns {boolean} the 3D view has begun and is not connected yet: what is loaded now would keep its robot waiting */
function viewComes() {
  const frame = /** @type {HTMLIFrameElement | null} */ (document.querySelector(".scene iframe"));
  const hasBegun = "studio3d" in (frame?.contentWindow ?? {});
  return hasBegun && !viewportConnected.value;
}

/** @param {string} id what takes long comes once the rest of the page stands */
async function fetched(id) {
  const entry = PANELS[id];
  if (entry?.heavy) {
    const begun = performance.now();
    await others;
    await untilViewFetched();
    await until(() => robot.value !== null && !viewComes(), PATIENCE_MS);
    const courtesy = role.value === "presenter" ? 0 : courtesyMs(performance.now() - begun);
    if (courtesy > 0) await new Promise((resolve) => setTimeout(resolve, courtesy));
    await untilIdle();
    return entry.load();
  }
  const panel = entry?.load();
  others = Promise.allSettled([others, panel]);
  return panel;
}

/** @param {{id: string}} props draws the panel as soon as its file is here */
function Loaded({ id }) {
  const [drawn, setDrawn] = useState(/** @type {{panel: Component} | null} */ (null));
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
