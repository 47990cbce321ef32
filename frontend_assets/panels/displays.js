/** What is shown: the grid, the robot's layers (shared by all), and its links (each person's own view). */

/** @import { LinkRow } from "../lib/tree.js" */
/** @import { Row } from "./display-tree.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { addedDisplay } from "../lib/live-displays.js";
import { shownNumber } from "../lib/numbers.js";
import { whenPlaced } from "../lib/seen.js";
import { ancestorsOf, linkRows, withoutInertia } from "../lib/tree.js";
import { EmptyState, SearchBox } from "../lib/ui.js";
import { displays, links, problems, robot } from "../model/document.js";
import { liveDisplays } from "../model/live-displays.js";
import { setDisplay } from "../model/requests.js";
import { hiddenLinks, selected, selection, showLink } from "../model/selection.js";
import { rowId, Tree } from "./display-tree.js";
import { LinkDetails } from "./link-details.js";
import { dropTopic, takeTopic } from "./live-drag.js";
import { AddDisplayButton, liveRows, setLiveOpen } from "./live-rows.js";

/** Settings from 0 to 1. */
const SHARES = new Set(["opacity"]);

export function DisplaysPanel() {
  const filter = useSignal("");
  const closed = useSignal(/** @type {ReadonlySet<string>} */ (new Set(["grid", "layers"])));
  const active = useSignal("robot");
  const rows = treeRows(filter.value, closed.value);
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  useRevealSelection(closed, panel);
  useRevealAdded(filter, closed, active, panel);
  /** @param {string} id @param {boolean} open */
  const setOpen = (id, open) => {
    if (setLiveOpen(id, open)) return;
    const now = new Set(closed.value);
    if (open) now.delete(id);
    else now.add(id);
    closed.value = now;
  };
  return html`<section ref=${panel} class="panel-body" aria-label=${t("panel.displays")} onDragOver=${takeTopic} onDrop=${dropTopic}>
    <div class="panel-bar">
      <${SearchBox} label=${t("displays.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
      <${AddDisplayButton} />
    </div>
    ${rows.length === 0 && filter.value === "" && html`<${EmptyState} icon="robot" title=${t("urdf.none")} />`}
    ${rows.length > 0 && html`<${Tree} rows=${rows} active=${active} setOpen=${setOpen} />`}
    ${rows.length === 0 && filter.value !== "" && html`<p class="nothing">${t("filter.nothing", { words: filter.value })}</p>`}
    <${LinkDetails} />
  </section>`;
}

/** A link selected elsewhere is unfolded and scrolled to; one selected here stays in view above its details. @param {{value: ReadonlySet<string>}} closed @param {{current: HTMLElement | null}} panel */
function useRevealSelection(closed, panel) {
  const link = selected.value;
  useEffect(() => {
    if (!link || !robot.value) return undefined;
    const reveal = () =>
      requestAnimationFrame(() => {
        document.getElementById(rowId(`link:${link}`))?.scrollIntoView({ block: "nearest" });
      });
    if (selection.value?.by === "displays") {
      const asked = reveal();
      return () => cancelAnimationFrame(asked);
    }
    const way = ["robot", "links", ...ancestorsOf(robot.value, link).map((name) => `link:${name}`)];
    closed.value = new Set([...closed.value].filter((id) => !way.includes(id)));
    return whenPlaced(panel.current, reveal);
  }, [link]);
}

/**
 * A display that is added, here or from another panel, is in sight: its group is unfolded, a filter that hides it is emptied.
 * @param {{value: string}} filter @param {{value: ReadonlySet<string>}} closed @param {{value: string}} active @param {{current: HTMLElement | null}} panel
 */
function useRevealAdded(filter, closed, active, panel) {
  const list = liveDisplays.value;
  const known = useRef(/** @type {ReadonlySet<string> | null} */ (null));
  useEffect(() => {
    const before = known.current;
    known.current = new Set(list.map(({ id }) => id));
    const added = addedDisplay(before, list);
    if (!added) return undefined;
    const row = `display:${added.id}`;
    closed.value = new Set([...closed.value].filter((id) => id !== `group:${added.group}`));
    if (!liveRows(filter.value, closed.value).some(({ id }) => id === row)) filter.value = "";
    active.value = row; // so that it is drawn, however far away it is
    return whenPlaced(panel.current, () =>
      requestAnimationFrame(() =>
        document.getElementById(rowId(row))?.scrollIntoView({ block: "nearest" }),
      ),
    );
  }, [list]);
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeRows(filter, closed) {
  return [...gridRows(filter, closed), ...robotRows(filter, closed), ...liveRows(filter, closed)];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function robotRows(filter, closed) {
  const settings = displays.value.robot;
  if (!settings && !robot.value) return [];
  const below = [...layerRows(filter, closed), ...treeOfLinks(filter, closed)];
  if (below.length === 0 && !hit(t("display.robot"), filter)) return [];
  const open = filter !== "" || !closed.has("robot");
  const count = robot.value?.links.length ?? 0;
  /** @type {Row} */
  const head = {
    id: "robot",
    level: 1,
    label: t("display.robot"),
    icon: "robot",
    expandable: true,
    expanded: open,
    meta: count > 0 ? t("links.count", { count }) : "",
    ...eyeOf("robot", settings && "visible" in settings ? "visible" : "visual"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} text @param {string} filter */
const hit = (text, filter) => text.toLowerCase().includes(filter.trim().toLowerCase());

/** @param {"grid" | "robot"} display @param {string} name @returns {Pick<Row, "eye">} its switch, when it has one */
function eyeOf(display, name) {
  const value = displays.value[display]?.[name];
  if (typeof value !== "boolean") return {};
  const label = t("display.show", { name: settingLabel(display, name) });
  const set = (/** @type {boolean} */ on) => void setDisplay(display, name, on);
  return { eye: { on: value, label, set, shared: true } };
}

/** @param {string} display @param {string} name @returns {string} words for a setting, known or not */
function settingLabel(display, name) {
  const key = `display.${display}.${name}`;
  const words = t(key);
  return words === key ? name.replaceAll("_", " ") : words;
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function gridRows(filter, closed) {
  const settings = displays.value.grid;
  if (!settings) return [];
  const below = settingRows("grid", 2, filter);
  if (below.length === 0 && !hit(t("display.grid"), filter)) return [];
  const open = filter !== "" || !closed.has("grid");
  const cell = settings.cell_m;
  /** @type {Row} */
  const head = {
    id: "grid",
    level: 1,
    label: t("display.grid"),
    icon: "grid",
    expandable: below.length > 0,
    expanded: open,
    meta: typeof cell === "number" ? `${shownNumber(cell)} m` : "",
    ...eyeOf("grid", "visible"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function layerRows(filter, closed) {
  const below = settingRows("robot", 3, filter);
  if (below.length === 0) return [];
  const open = filter !== "" || !closed.has("layers");
  const on = below.filter(({ eye }) => eye?.on).map(({ label }) => label);
  /** @type {Row} */
  const head = {
    id: "layers",
    level: 2,
    label: t("display.layers"),
    icon: "layout",
    expandable: true,
    expanded: open,
    meta: open ? "" : on.join(", "),
  };
  return [head, ...(open ? below : [])];
}

/** @param {"grid" | "robot"} display @param {number} level @param {string} filter @returns {Row[]} */
function settingRows(display, level, filter) {
  return Object.entries(displays.value[display] ?? {})
    .filter(([name]) => name !== "visible" && hit(settingLabel(display, name), filter))
    .map(([name, value]) => settingRow(display, name, value, level));
}

/** @param {"grid" | "robot"} display @param {string} name @param {boolean | number | string} value @param {number} level @returns {Row} */
function settingRow(display, name, value, level) {
  const label = settingLabel(display, name);
  const row = { id: `${display}.${name}`, level, label, icon: "" };
  if (typeof value === "boolean") return { ...row, ...eyeOf(display, name) };
  if (typeof value === "string") return { ...row, meta: value };
  const set = (/** @type {number} */ one) => void setDisplay(display, name, one);
  if (SHARES.has(name)) return { ...row, slider: { value, label, set } };
  return { ...row, number: { value, label, set, unit: name.endsWith("_m") ? "m" : "" } };
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeOfLinks(filter, closed) {
  const folded = new Set(
    [...closed].filter((id) => id.startsWith("link:")).map((id) => id.slice(5)),
  );
  return linkRows(links.value, folded, filter, 2).map(linkRow);
}

/** @param {LinkRow} row @returns {Row} */
function linkRow({ node, level, expandable, expanded }) {
  const { name } = node.link;
  const visible = !hiddenLinks.value.has(name);
  const massless = withoutInertia(problems.value).has(name);
  return {
    id: `link:${name}`,
    level,
    label: name,
    icon: "box",
    expandable,
    expanded,
    link: name,
    meta: massless ? t("link.no_inertia") : "",
    warn: massless,
    eye: {
      on: visible,
      label: t("display.show", { name }),
      set: (on) => showLink(name, on),
      shared: false,
    },
  };
}
